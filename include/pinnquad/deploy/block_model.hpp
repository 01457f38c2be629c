// SPDX-License-Identifier: MIT
// A model from a block that describes itself, on the ground: one motion in, commands out; rows of flights; derivatives;
// what is proven of it. Of any network, feature set, columns and outputs (exported/run_time_model.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/deploy/run_time_row.hpp"
#include "pinnquad/exported/run_time_certificate.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/io/text_file.hpp"
#include "pinnquad/loss/local_monotonicity.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/training/ground_features.hpp"

namespace pinnquad {

/// A block of a file, ready to predict: in float or double, as it was written.
class BlockModel {
 public:
  /// The answer of a model to a row.
  struct AnsweredRow {
    Commands<double> commands{};  ///< in the model's own scalar
    AxisSlopes derivatives{};     ///< in double; of a window by an acceleration that is held
    bool inside_envelope = true;
    std::vector<double> features{};  ///< in physical units, as the model's own scalar holds them
  };

  /// Each signed sum of the commands rises with the angular acceleration about its axis, for all finite features.
  struct ProvenSigns {
    /// s^2/rad: by the present angular acceleration alone, and by one that is held over the window.
    AxisSlopes slope{}, held_slope{};
    /// The proof's argument; none: the model is affine, its derivatives are the same everywhere.
    std::optional<Certificate> structure{};
  };

  /// Reads a file. Throws InputError, one line: not readable, no block that describes itself, one that contradicts
  /// itself, one whose weights do not give its golden commands.
  explicit BlockModel(const std::string& path) : BlockModel(path, file_text(path)) {}
  /// Opens a block's bytes; `path` is for messages.
  template <class Bytes>
  BlockModel(const std::string& path, const Bytes& bytes) : path_(path), length_(bytes.size()) {
    bytes_.resize((length_ + 7) / 8);
    if (length_ > 0) std::memcpy(bytes_.data(), bytes.data(), length_);
    open();
  }

  const std::string& path() const noexcept { return path_; }
  const unsigned char* data() const noexcept { return reinterpret_cast<const unsigned char*>(bytes_.data()); }
  std::size_t size() const noexcept { return length_; }
  std::uint32_t checksum() const noexcept;
  /// Calls `use` with its RunTimeModel, of float or of double.
  template <class Use>
  decltype(auto) with(const Use& use) const {
    if (const auto* model = std::get_if<std::unique_ptr<const RunTimeModel<float>>>(&model_)) return use(**model);
    return use(*std::get<std::unique_ptr<const RunTimeModel<double>>>(model_));
  }
  /// Calls `use` with its RunTimeRow: one motion in a third of the time.
  template <class Use>
  decltype(auto) with_row(const Use& use) const {
    if (const auto* row = std::get_if<RunTimeRow<float>>(&*row_)) return use(*row);
    return use(std::get<RunTimeRow<double>>(*row_));
  }
  bool is_double() const noexcept { return model_.index() == 1; }

  // words of the block, fit for a terminal
  std::string name() const { return provenance("name"); }
  std::string provenance(const char* word) const;
  std::string answer() const;
  std::string schema() const;
  const RunTimeNetwork& network() const;
  const RunTimeFeatures& features() const;
  std::string airframe_name() const;
  const Airframe<double>& airframe() const;
  std::uint64_t contents_hash() const;
  std::vector<std::string> feature_names() const;
  /// Columns that a flight needs beyond those that every flight has.
  std::vector<ColumnName> columns() const;
  /// A feature that shows the angular acceleration about an axis, at the present instant or at another tap of a window.
  struct AccelerationPlace {
    std::size_t feature = 0, axis = 0;
    bool is_present = true;
  };
  const std::vector<AccelerationPlace>& angular_accelerations() const noexcept { return places_; }
  /// True where each feature is one of the library's or a column that shows no angular acceleration.
  bool knows_its_features() const;
  bool is_axis_commands() const;
  /// The commands are an affine map of the network's outputs and of the features.
  bool has_affine_schema() const;
  std::vector<double> envelope_lower() const;
  std::vector<double> envelope_upper() const;
  int golden_count() const;
  std::vector<double> golden_features(int vector) const;
  /// The largest difference of a golden command from what its weights give.
  double golden_difference() const;
  /// The certificate of a model whose structure can be proven.
  std::optional<Certificate> certificate() const;
  /// None: nothing is proven (which is no counterexample), or the model is asked no angular acceleration.
  std::optional<ProvenSigns> proven_signs() const;

  /// Commands of features in physical units, in the model's own scalar.
  Commands<double> commands(const std::vector<double>& x) const;

  /// Signed sums of commands about roll, pitch, yaw.
  std::array<double, 3> signed_sums(const Commands<double>& u) const;

  /// Derivative of each of these sums by the angular acceleration about its axis, above 0 for any vehicle that turns as
  /// it is asked to. Exact, in double whatever the model's scalar is. `held`: of a window the angular acceleration of
  /// all taps is moved; else the present alone. At a ReLU's kink it is the derivative from below (nn/jacobian.hpp).
  AxisSlopes derivatives(const std::vector<double>& x, bool held = true) const;

  /// Calls `take(row, AnsweredRow)` for the rows that have features, `row` counted through the set. Throws
  /// std::invalid_argument for a flight without a column that the model asks for.
  void answer(const RowSet& rows, const std::function<void(std::size_t row, const AnsweredRow&)>& take,
              bool with_derivatives = true) const;

 private:
  template <class Model>
  struct ScalarOfModel;
  template <class Scalar>
  struct ScalarOfModel<RunTimeModel<Scalar>> {
    using type = Scalar;
  };
  template <class Model>
  using ScalarOf = typename ScalarOfModel<std::decay_t<Model>>::type;

  void open();
  template <class Scalar>
  void open_as();
  /// Takes what derivatives() needs.
  template <class Scalar>
  void take_derivatives(const RunTimeModel<Scalar>& model);
  /// Words of the provenance that are numbers: whole ones, and R^2 that bear out the verdict.
  void require_words() const;
  [[noreturn]] void refuse(detail::StatedNumber number, const std::string& found) const;
  [[noreturn]] void refuse(const std::string& expected, const std::string& found) const;

  template <class Scalar>
  static std::vector<double> numbers_in_double(const Scalar* numbers, int count) {
    return {numbers, numbers + count};
  }

  std::string path_;
  std::size_t length_ = 0;
  std::vector<std::uint64_t> bytes_;  ///< aligned as a block must be
  std::variant<std::unique_ptr<const RunTimeModel<float>>, std::unique_ptr<const RunTimeModel<double>>> model_;
  std::optional<std::variant<RunTimeRow<float>, RunTimeRow<double>>> row_;
  RunTimeOutputs<double> outputs_;  ///< for the derivatives
  std::vector<AccelerationPlace> places_;
  std::array<std::array<double, rotor_count>, 3> signs_{};
};

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/deploy/impl/block_model.hpp"
#endif
