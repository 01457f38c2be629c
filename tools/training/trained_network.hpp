// SPDX-License-Identifier: MIT
// A trained network, its type erased: what judging and exporting ask of it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/deploy/export_model.hpp"
#include "pinnquad/training/structured/measured_slope.hpp"
#include "pinnquad/training/trained_model.hpp"
#include "training/derivatives.hpp"

namespace programs {

/// Is a model shown the altitude? By the validation rows; errors are NaN where those were not asked.
struct AltitudeChoice {
  bool applies = false;  ///< false: the kind has no such choice
  bool taken = false;
  double error_with = pinnquad::not_a_number, error_without = pinnquad::not_a_number;  ///< mean absolute
};

/// Rows by what the guard of an export says of them (TrainingGuard).
struct GuardCounts {
  std::uint64_t rows = 0;
  std::uint64_t warming_up = 0;        ///< no whole window of instants
  std::uint64_t outside_envelope = 0;  ///< of the training rows
  std::uint64_t output_not_finite = 0;
  std::uint64_t beyond_limits = 0;  ///< answered, with a command below 0 or above 1
  /// Of those outside, by the feature that is furthest out, of a window whatever its instant.
  std::map<std::string, std::uint64_t> furthest;

  std::uint64_t answered() const { return rows - warming_up - outside_envelope - output_not_finite; }
  /// NaN of no rows.
  double share_of(std::uint64_t count) const {
    return rows > 0 ? static_cast<double>(count) / static_cast<double>(rows) : pinnquad::not_a_number;
  }
  double answered_share() const { return share_of(answered()); }
  GuardCounts& operator+=(const GuardCounts& other);
};

/// NaN for every row.
inline Predictions without_answer(const pinnquad::RowSet& rows) {
  constexpr double none = pinnquad::not_a_number;
  return Predictions(rows.size(), {none, none, none, none});
}

/// Of rows that a model was not trained on.
struct Answers {
  Predictions predictions;
  DerivativeFigures derivatives;  ///< see derivative_figures()
  GuardCounts guard;
};

class TrainedNetwork {
 public:
  virtual ~TrainedNetwork() = default;
  /// To be judged by. NaN for a row that it has no features of.
  virtual Predictions predictions(const pinnquad::RowSet& rows) const = 0;
  /// The same, NaN where the guard of its export declines: for a row outside the training envelope.
  virtual Predictions guarded_predictions(const pinnquad::RowSet& rows) const { return predictions(rows); }
  /// See derivative_figures().
  virtual DerivativeFigures derivatives(const pinnquad::RowSet& rows) const = 0;
  /// All of it; of a model to be compared with alone, which has no guard, the counts are by what it predicts.
  virtual Answers answers(const pinnquad::RowSet& rows) const;
  /// How far beyond a row's own time it reads, s: of a window that is centred.
  virtual double looks_ahead_s() const { return 0; }
  virtual AltitudeChoice altitude() const { return {}; }
  /// How well the training rows know its slopes; unknown of other kinds.
  virtual pinnquad::SlopesOfSums slopes() const { return {}; }
  /// Whether export_to() can write limits of trust.
  virtual bool has_trust() const { return false; }
  /// Writes `struct <name>` and its block. Throws std::logic_error of a model that is to be compared with alone.
  virtual pinnquad::Exported export_to(const pinnquad::Exported::Files& /*files*/, const std::string& /*name*/,
                                       const pinnquad::RowSplit& /*split*/,
                                       const pinnquad::Provenance& /*provenance*/) const {
    throw std::logic_error("a model to be compared with alone is not exported");
  }
  /// The block that export_to() writes, but for the struct's name and limits of trust. Throws as it does.
  virtual std::vector<unsigned char> block_with(const pinnquad::RowSplit& /*split*/,
                                                const pinnquad::Provenance& /*provenance*/) const {
    throw std::logic_error("a model to be compared with alone is not exported");
  }
  /// As a program that has never seen its types flies it; null: a model to be compared with alone.
  virtual const pinnquad::BlockModel* block() const { return nullptr; }
  /// Of it is proven that the commands turn the vehicle the way that is asked: pinnquad::BlockModel::proven_signs().
  bool is_proven() const;
  /// Of its structure; none of a model without.
  std::optional<pinnquad::Certificate> certificate() const;
};

/// A formula, which nobody trains: `predict(sample)` gives the commands.
template <class Predict>
class FormulaModel : public TrainedNetwork {
 public:
  FormulaModel(pinnquad::GivenAirframe airframe, Predict predict)
      : airframe_(std::move(airframe)), predict_(std::move(predict)) {}

  Predictions predictions(const pinnquad::RowSet& rows) const override {
    Predictions result;
    for (std::size_t row = 0; row < rows.size(); ++row) result.push_back(predict_(rows[row]));
    return result;
  }
  DerivativeFigures derivatives(const pinnquad::RowSet& rows) const override {
    return derivative_figures(rows, FormulaDerivatives(airframe_, predict_));
  }

 private:
  pinnquad::GivenAirframe airframe_;
  Predict predict_;
};

template <class Predict>
std::shared_ptr<const TrainedNetwork> formula_model(const pinnquad::GivenAirframe& airframe, Predict predict) {
  return std::make_shared<FormulaModel<Predict>>(airframe, std::move(predict));
}

/// A model by its block: commands, derivatives, proof are those that any program would find in it.
class BlockNetwork : public TrainedNetwork {
 public:
  explicit BlockNetwork(const std::vector<unsigned char>& block);
  /// `training`: what it was trained on.
  BlockNetwork(const pinnquad::GroundModel<float>& model, const pinnquad::RowSet& training);

  Predictions predictions(const pinnquad::RowSet& rows) const override;
  Predictions guarded_predictions(const pinnquad::RowSet& rows) const override;
  DerivativeFigures derivatives(const pinnquad::RowSet& rows) const override { return answers(rows).derivatives; }
  Answers answers(const pinnquad::RowSet& rows) const override;
  double looks_ahead_s() const override { return block_.features().window().latest_s; }
  const pinnquad::BlockModel* block() const override { return &block_; }

 private:
  Predictions commands(const pinnquad::RowSet& rows, bool guarded) const;

  pinnquad::BlockModel block_;
};

/// A model that is exported. `with_trust`: with limits of trust, where they are asked for.
class ExportableNetwork : public BlockNetwork {
 public:
  ExportableNetwork(pinnquad::GroundModel<float> model, const pinnquad::RowSet& training, bool with_trust = false);

  bool has_trust() const override { return with_trust_; }
  pinnquad::Exported export_to(const pinnquad::Exported::Files& files, const std::string& name,
                               const pinnquad::RowSplit& split, const pinnquad::Provenance& provenance) const override;
  std::vector<unsigned char> block_with(const pinnquad::RowSplit& split,
                                        const pinnquad::Provenance& provenance) const override {
    return pinnquad::model_block(model_, pinnquad::golden_features(model_, split.train), provenance);
  }

 private:
  pinnquad::GroundModel<float> model_;
  bool with_trust_;
};

/// The model, whose airframe is one of those that the program knows by name: its header names the type.
pinnquad::GroundModel<float> of_library_airframe(pinnquad::GroundModel<float> model);

/// Rows as the flight side is asked them, and what the model predicts: a line of counts, then a row of numbers per
/// sample: v_dot (3), omega_dot (3), v (3), omega (3), attitude (w, x, y, z), the altitude if the model asks for it,
/// predicted u (4), flown u (4). Of a model that asks for more "pinnquad-replay-features", and X in the place of the
/// first 16.
void write_replay(const std::string& path, const pinnquad::BlockModel& model, const pinnquad::RowSet& rows);

}  // namespace programs
