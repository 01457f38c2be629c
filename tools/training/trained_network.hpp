// SPDX-License-Identifier: MIT
// A trained network, its type erased: what judging and exporting ask of it.
#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "airframe/names.hpp"
#include "pinnquad/data/csv.hpp"
#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/deploy/export_model.hpp"
#include "pinnquad/exported/certificate.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/training/trained_model.hpp"
#include "training/derivatives.hpp"
#include "training/model_predictions.hpp"

namespace programs {

/// Certificate of a trained model's structure; none of a model without.
template <class Model>
std::optional<pinnquad::Certificate> certificate_of_structure(const Model& model) {
  if constexpr (pinnquad::has_certificate<Model>) return pinnquad::certificate_of_trained(model);
  return {};
}

/// Is a model shown the altitude? By the validation rows; errors are NaN where those were not asked.
struct AltitudeChoice {
  bool applies = false;  ///< false: the kind has no such choice
  bool taken = false;
  double error_with = pinnquad::not_a_number, error_without = pinnquad::not_a_number;  ///< mean absolute
};

class TrainedNetwork {
 public:
  virtual ~TrainedNetwork() = default;
  virtual Predictions predictions(const pinnquad::RowSet& rows) const = 0;
  /// The same, NaN where the guard of its export declines: for a row outside the training envelope.
  virtual Predictions guarded_predictions(const pinnquad::RowSet& rows) const { return predictions(rows); }
  /// See derivative_figures().
  virtual DerivativeFigures derivatives(const pinnquad::RowSet& rows) const = 0;
  /// Certificate of its structure; none of a model without.
  virtual std::optional<pinnquad::Certificate> certificate() const { return {}; }
  virtual AltitudeChoice altitude() const { return {}; }
  /// Whether export_to() can write limits of trust.
  virtual bool has_trust() const { return false; }
  /// Writes `struct <name>` and its block. Throws std::logic_error of a model that is to be compared with alone.
  virtual pinnquad::Exported export_to(const pinnquad::Exported::Files& /*files*/, const std::string& /*name*/,
                                       const pinnquad::RowSplit& /*split*/,
                                       const pinnquad::Provenance& /*provenance*/) const {
    throw std::logic_error("a model to be compared with alone is not exported");
  }
  /// The block that export_to() would write, but for its provenance: opened as a BlockModel it flies.
  virtual std::vector<unsigned char> block(const pinnquad::RowSet& /*training*/) const {
    throw std::logic_error("a model to be compared with alone has no block");
  }
  /// Rows as the flight side is asked them, and what the network predicts: a line of counts, then a row of numbers per
  /// sample: v_dot (3), omega_dot (3), v (3), omega (3), attitude (w, x, y, z), the altitude if the feature set asks
  /// for it, predicted u (4), flown u (4). Of a feature set that asks for more "pinnquad-replay-features", and X in the
  /// place of the first 16.
  virtual void write_replay(const std::string& /*path*/, const pinnquad::RowSet& /*rows*/) const {}
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

/// A pinnquad::TrainedModel, to be judged: the numbers that its header would hold.
template <class Model>
class JudgedModel : public TrainedNetwork {
 public:
  explicit JudgedModel(const Model& model) : model_(model) {}

  Predictions predictions(const pinnquad::RowSet& rows) const override {
    return pinnquad::predicted_commands(model_, rows);
  }
  Predictions guarded_predictions(const pinnquad::RowSet& rows) const override {
    return pinnquad::predicted_commands(model_, rows, true);
  }
  DerivativeFigures derivatives(const pinnquad::RowSet& rows) const override {
    return derivative_figures_of(model_, rows);
  }
  std::optional<pinnquad::Certificate> certificate() const override { return certificate_of_structure(model_); }

 protected:
  Model model_;
};

/// How an export says which airframe it is for.
enum class ExportedAirframe {
  by_value,  ///< a struct before the model
  by_name    ///< the type, where it is one of those that the program knows by name
};

/// Of a model that was trained for an airframe as a value. `library_airframe`: one of those that the program knows by
/// name. `WithTrust`: its export has limits of trust, where they are asked for.
template <class Model, ExportedAirframe Exported = ExportedAirframe::by_name, bool WithTrust = false>
class NetworkOfModel : public JudgedModel<Model> {
 public:
  explicit NetworkOfModel(const Model& model, bool library_airframe = false)
      : JudgedModel<Model>(model), library_airframe_(library_airframe) {}

  bool has_trust() const override { return WithTrust; }
  pinnquad::Exported export_to(const pinnquad::Exported::Files& files, const std::string& name,
                               const pinnquad::RowSplit& split, const pinnquad::Provenance& provenance) const override {
    pinnquad::Exported exported;
    with_exported([&](const auto& model) {
      exported = pinnquad::export_model<WithTrust>(files, name, model, split, provenance);
    });
    return exported;
  }
  std::vector<unsigned char> block(const pinnquad::RowSet& training) const override {
    return pinnquad::model_block(this->model_, pinnquad::golden_features(this->model_, training), {});
  }
  void write_replay(const std::string& path, const pinnquad::RowSet& rows) const override {
    using Inputs = typename Model::Features::template Inputs<typename Model::Scalar>;
    constexpr bool with_altitude = std::is_same_v<Inputs, pinnquad::MotionInputsWithAltitude<typename Model::Scalar>>;
    constexpr bool asks_for_motion =
        with_altitude || std::is_same_v<Inputs, pinnquad::MotionInputs<typename Model::Scalar>>;
    std::size_t count = 0;
    std::string lines, line;
    const auto add = [&line](double value) { line += (line.empty() ? "" : " ") + pinnquad::number_text(value); };
    pinnquad::each_features<typename Model::Features, typename Model::Scalar>(
        rows, [&](const pinnquad::Flight& flight, std::size_t row, const typename Model::FeatureVector& x) {
          line.clear();
          if constexpr (asks_for_motion) {
            const Inputs in = pinnquad::sample_inputs<Inputs>(flight[row]);
            for (const auto* vector : {&in.linear_acceleration_m_s2, &in.angular_acceleration_rad_s2, &in.velocity_m_s,
                                       &in.body_rates_rad_s}) {
              for (int i = 0; i < 3; ++i) add(static_cast<double>((*vector)[i]));
            }
            for (const auto v : {in.attitude.w, in.attitude.x, in.attitude.y, in.attitude.z})
              add(static_cast<double>(v));
            if constexpr (with_altitude) add(static_cast<double>(in.altitude_m));
          } else {
            for (const auto v : x) add(static_cast<double>(v));
          }
          for (const auto u : this->model_.predict(x)) add(static_cast<double>(u));
          for (const double u : flight[row].commands) add(u);
          lines += line + '\n';
          ++count;
        });
    constexpr int asked = with_altitude ? 17 : asks_for_motion ? 16 : Model::Features::size;
    constexpr int numbers = asked + 2 * pinnquad::rotor_count;
    pinnquad::AtomicFile file(path);
    file.stream() << (asks_for_motion ? "pinnquad-replay 1 " : "pinnquad-replay-features 1 ") << count << ' ' << numbers
                  << '\n'
                  << lines;
    file.commit();
  }

 private:
  /// Calls `use` with the model of the airframe's own type, or of the value.
  template <class Use>
  void with_exported(const Use& use) const {
    if (!library_airframe_ || Exported == ExportedAirframe::by_value) return use(this->model_);
    if constexpr (Exported == ExportedAirframe::by_name) {
      with_airframe(this->model_.airframe_name(), [&](auto tag) {
        using Context = pinnquad::Context<typename Model::Features, typename decltype(tag)::type>;
        pinnquad::TrainedModel<typename Model::Network, Context> named;
        named.network = this->model_.network;
        named.input = this->model_.input;
        named.output = this->model_.output;
        named.envelope_lower = this->model_.envelope_lower;
        named.envelope_upper = this->model_.envelope_upper;
        use(named);
      });
    }
  }

  bool library_airframe_;
};

}  // namespace programs
