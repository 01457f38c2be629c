// SPDX-License-Identifier: MIT
// A model from a block that describes itself, on the ground: one motion in, commands out; rows of flights; derivatives;
// what is proven of it. Of any network, feature set, columns and outputs (exported/run_time_model.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/deploy/exact_derivatives.hpp"
#include "pinnquad/exported/run_time_certificate.hpp"
#include "pinnquad/exported/stated_certificate.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/io/text_file.hpp"

namespace pinnquad {

namespace detail {

/// Motions of a flight's rows as a run-time model asks for them. Throws std::invalid_argument for a flight without a
/// column that the model asks for.
template <class Scalar>
class RunTimeFlightInputs {
 public:
  using Inputs = RunTimeInputs<Scalar>;

  RunTimeFlightInputs(const RunTimeFeatures& features, const FlightRows& rows) : features_(&features), rows_(rows) {
    for (int i = 0; i < features.column_count(); ++i) {
      const auto [name, unit] = features.column(i);
      columns_.push_back(&column_values(*rows.flight, std::string(name), std::string(unit)));
    }
  }

  /// `taps`: as many as the window has, the present first. False where the rows do not hold them.
  bool read(std::size_t row, Inputs* taps) const {
    taps[0] = present(row);
    const RunTimeWindow& window = features_->window();
    const auto read_row = [this](std::size_t i, Inputs& inputs) {
      inputs = present(i);
      return true;
    };
    return window.taps == 1 || read_window<Scalar>(window, rows_, row, read_row, taps + 1);
  }

  /// Of a row alone.
  Inputs present(std::size_t row) const {
    Inputs inputs;
    static_cast<MotionInputsWithAltitude<Scalar>&>(inputs) =
        sample_inputs<MotionInputsWithAltitude<Scalar>>((*rows_.flight)[row]);
    for (std::size_t i = 0; i < columns_.size(); ++i) inputs.columns[i] = static_cast<Scalar>((*columns_[i])[row]);
    return inputs;
  }

 private:
  const RunTimeFeatures* features_;
  FlightRows rows_;
  std::vector<const std::vector<double>*> columns_;
};

/// No activation, no bound.
inline bool is_affine(const RunTimeNetwork& network) {
  for (int i = 0; i < network.part_count(); ++i) {
    const RunTimePart& part = network.part(i);
    if (part.bounded || part.path_bounded) return false;
    for (int layer = 0; layer < part.layer_count; ++layer) {
      if (part.layers[layer].outputs == 0) return false;
    }
  }
  return true;
}

}  // namespace detail

/// The answer of a model to a row.
struct AnsweredRow {
  Commands<double> commands{};    ///< in the model's own scalar
  AxisDerivatives derivatives{};  ///< in double; of a window by an acceleration that is held
  bool inside_envelope = true;
  std::vector<double> features{};  ///< in physical units, as the model's own scalar holds them
};

/// Why each signed sum of the commands rises with the angular acceleration about its axis, for all finite features.
enum class SignProof {
  structure,   ///< an affine base, and a residual that sees no angular acceleration
  path_bound,  ///< an affine base, and a network whose paths from it leave the slopes above 0
  affinity     ///< the model is affine: its derivatives are the same everywhere
};

/// s^2/rad: by the present angular acceleration alone, and by one that is held over the window.
struct ProvenSigns {
  SignProof by = SignProof::structure;
  AxisDerivatives slope{}, held_slope{};
};

/// A block of a file, ready to predict: in float or double, as it was written.
class BlockModel {
 public:
  /// Reads a file. Throws InputError, one line: not readable, no block that describes itself, one that contradicts
  /// itself, one whose weights do not give its golden commands.
  explicit BlockModel(const std::string& path) : BlockModel(path, file_text(path)) {}
  /// Of bytes; `path` is for messages.
  template <class Bytes>
  BlockModel(const std::string& path, const Bytes& bytes) : path_(path), length_(bytes.size()) {
    bytes_.resize((length_ + 7) / 8);
    if (length_ > 0) std::memcpy(bytes_.data(), bytes.data(), length_);
    const bool is_double = length_ >= ModelBlockHeader::size &&
                           detail::read_u32(data() + ModelBlockHeader::scalar_bytes) == sizeof(double);
    is_double ? open<double>() : open<float>();
  }

  const std::string& path() const noexcept { return path_; }
  const unsigned char* data() const noexcept { return reinterpret_cast<const unsigned char*>(bytes_.data()); }
  std::size_t size() const noexcept { return length_; }
  std::uint32_t checksum() const noexcept {
    return detail::read_u32(data() + detail::read_u32(data() + ModelBlockHeader::length) -
                            ModelBlockHeader::checksum_size);
  }
  /// Calls `use` with its RunTimeModel, of float or of double.
  template <class Use>
  decltype(auto) with(const Use& use) const {
    if (const auto* model = std::get_if<std::unique_ptr<const RunTimeModel<float>>>(&model_)) return use(**model);
    return use(*std::get<std::unique_ptr<const RunTimeModel<double>>>(model_));
  }
  bool is_double() const noexcept { return model_.index() == 1; }

  // words of the block, fit for a terminal
  std::string name() const { return provenance("name"); }
  std::string provenance(const char* word) const {
    return with([&](const auto& model) { return printable(model.provenance(word)); });
  }
  std::string answer() const {
    return with([](const auto& model) { return printable(model.records().answer); });
  }
  std::string schema() const {
    return with([](const auto& model) { return printable(model.schema()); });
  }
  const RunTimeNetwork& network() const {
    return with([](const auto& model) -> const RunTimeNetwork& { return model.network(); });
  }
  const RunTimeFeatures& features() const {
    return with([](const auto& model) -> const RunTimeFeatures& { return model.features(); });
  }
  std::string airframe_name() const {
    return with([](const auto& model) { return printable(model.records().vehicle_name); });
  }
  const Airframe<double>& airframe() const {
    return with([](const auto& model) -> const Airframe<double>& { return model.airframe(); });
  }
  std::uint64_t contents_hash() const {
    return with([](const auto& model) { return model.records().contents_hash; });
  }
  std::vector<std::string> feature_names() const {
    std::vector<std::string> names;
    for (int i = 0; i < features().size(); ++i) names.emplace_back(features()[i].name);
    return names;
  }
  /// Of a flight, beyond those that every flight has.
  std::vector<ColumnName> columns() const {
    std::vector<ColumnName> columns;
    for (int i = 0; i < features().column_count(); ++i) {
      const auto [column, unit] = features().column(i);
      columns.push_back({std::string(column), std::string(unit)});
    }
    return columns;
  }
  /// Features that show an angular acceleration.
  const std::vector<AccelerationPlace>& angular_accelerations() const noexcept { return derivatives_.places(); }
  /// True where each feature is one of the library's or a column that shows no angular acceleration.
  bool knows_its_features() const {
    return with([](const auto& model) {
      bool known = true;
      for (int i = 0; i < model.features().size(); ++i) {
        known = known && shown_acceleration(model, i) != ShownAcceleration::unknown;
      }
      return known;
    });
  }
  bool is_axis_commands() const {
    return with([](const auto& model) { return model.outputs().is_axis_commands(); });
  }
  /// The commands are an affine map of the network's outputs and of the features.
  bool has_affine_schema() const {
    bool curved = false;
    for (const auto& rotor : airframe().rotors) curved = curved || rotor.thrust_curve > 0;
    return with([&](const auto& model) { return model.outputs().is_affine(curved); });
  }
  std::vector<double> envelope_lower() const {
    return with([](const auto& m) { return in_double(m.scales().lower, m.features().size()); });
  }
  std::vector<double> envelope_upper() const {
    return with([](const auto& m) { return in_double(m.scales().upper, m.features().size()); });
  }
  int golden_count() const {
    return with([](const auto& model) { return model.golden_count(); });
  }
  std::vector<double> golden_features(int vector) const {
    return with([&](const auto& m) { return in_double(m.golden_features(vector), m.features().size()); });
  }
  /// The largest difference of a golden command from what its weights give.
  double golden_difference() const {
    return with([](const auto& model) {
      std::vector<ScalarOf<decltype(model)>> work(model.workspace());
      return static_cast<double>(model.golden_difference(work.data()));
    });
  }
  /// Of a model with a structure that can be proven.
  std::optional<Certificate> certificate() const {
    std::vector<double> work;
    for (int i = 0; i < network().part_count(); ++i) work.resize(work.size() + path_workspace(network().part(i)));
    Certificate certificate;
    const bool has_structure =
        with([&](const auto& model) { return run_time_certificate(model, work.data(), certificate); });
    return has_structure ? std::optional(certificate) : std::nullopt;
  }
  /// None: nothing is proven (which is no counterexample), or the model is asked no angular acceleration.
  std::optional<ProvenSigns> proven_signs() const {
    if (angular_accelerations().empty()) return {};
    ProvenSigns proof;
    if (const std::optional<Certificate> structure = certificate(); structure && structure->proven()) {
      if (network().part(network().part_count() - 1).path_bounded) proof.by = SignProof::path_bound;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        proof.slope[axis] = structure->slope[axis];
        proof.held_slope[axis] = structure->held_slope[axis];
      }
      return proof;
    }
    if (!has_affine_schema() || !detail::is_affine(network()) || !knows_its_features()) return {};
    proof.by = SignProof::affinity;
    const std::vector<double> anywhere = golden_features(0);
    proof.slope = derivatives(anywhere, false);
    proof.held_slope = derivatives(anywhere, true);
    const auto vehicle = detail::certified_vehicle<AxisCommandOutputs>(airframe());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double floor = std::max(vehicle.least_slope[axis], 0.0);
      if (!(proof.slope[axis] > floor && proof.held_slope[axis] > floor)) return {};
    }
    return proof;
  }

  /// Commands of features in physical units, in the model's own scalar.
  Commands<double> commands(const std::vector<double>& x) const {
    return with([&](const auto& model) {
      using Scalar = ScalarOf<decltype(model)>;
      const std::vector<Scalar> own(x.begin(), x.end());
      std::vector<Scalar> work(model.workspace());
      Commands<Scalar> u{};
      model.commands(own.data(), u.data(), work.data());
      return in_double_commands(u);
    });
  }

  /// Signed sums of commands about roll, pitch, yaw.
  std::array<double, 3> signed_sums(const Commands<double>& u) const { return derivatives_.signed_sums(u); }

  /// Exact, in double whatever the model's scalar is. `held`: of a window the angular acceleration of all taps is
  /// moved; else the present alone.
  AxisDerivatives derivatives(const std::vector<double>& x, bool held = true) const {
    return derivatives_(x.data(), held);
  }

  /// Calls `take(row, AnsweredRow)` for the rows that have features, `row` counted through the set. Throws
  /// std::invalid_argument for a flight without a column that the model asks for.
  template <class Take>
  void answer(const RowSet& rows, const Take& take, bool with_derivatives = true) const {
    with([&](const auto& model) {
      using Scalar = ScalarOf<decltype(model)>;
      const auto taps = std::size_t(model.features().window().taps), size = std::size_t(model.features().size());
      std::vector<RunTimeInputs<Scalar>> inputs(taps);
      std::vector<RunTimeInputs<double>> exact(taps);
      std::vector<Scalar> x(size), work(model.workspace());
      std::vector<double> exact_x(size);
      AnsweredRow answered;
      std::size_t first = 0;
      for (const FlightRows& piece : rows.pieces()) {
        const detail::RunTimeFlightInputs<Scalar> own(model.features(), piece);
        const detail::RunTimeFlightInputs<double> in_double(model.features(), piece);
        for (std::size_t row = piece.rows.begin; row < piece.rows.end; ++row) {
          if (!own.read(row, inputs.data())) continue;
          model.features().extract(static_cast<const RunTimeInputs<Scalar>*>(inputs.data()), x.data());
          Commands<Scalar> u{};
          model.commands(x.data(), u.data(), work.data());
          answered.features.assign(x.begin(), x.end());
          answered.commands = in_double_commands(u);
          answered.inside_envelope = model.inside_envelope(x.data());
          if (with_derivatives && in_double.read(row, exact.data())) {
            model.features().extract(static_cast<const RunTimeInputs<double>*>(exact.data()), exact_x.data());
            answered.derivatives = derivatives_(exact_x.data());
          }
          take(first + row - piece.rows.begin, static_cast<const AnsweredRow&>(answered));
        }
        first += piece.rows.size();
      }
    });
  }

 private:
  template <class Model>
  struct ScalarOfModel;
  template <class Scalar>
  struct ScalarOfModel<RunTimeModel<Scalar>> {
    using type = Scalar;
  };
  template <class Model>
  using ScalarOf = typename ScalarOfModel<std::decay_t<Model>>::type;

  template <class Scalar>
  void open() {
    auto model = std::make_unique<RunTimeModel<Scalar>>();
    BlockFault fault;
    if (RunTimeModel<Scalar>::open(data(), length_, *model, fault) != Status::ok) {
      refuse(fault.expected, *fault.found == 0 ? number_text(fault.number) : fault.found);
    }
    derivatives_ = ExactDerivatives(*model);
    const bool says_signs = model->records().slope_signs != nullptr;
    const unsigned char* stated = model->records().certificate;
    model_ = std::unique_ptr<const RunTimeModel<Scalar>>(std::move(model));
    require_words();
    if (!(golden_difference() <= golden_tolerance)) refuse("golden commands that its weights give", "others");
    if (!says_signs && stated == nullptr) return;
    const std::optional<Certificate> proof = certificate();
    if (proof && !proof->proven()) refuse("slopes and bounds of which its certificate is proven", "others");
    if (stated == nullptr) return;
    if (!proof || !detail::states_certificate(stated, *proof)) refuse(detail::StatedNumber::certificate, "others");
  }
  /// Words of the provenance that are numbers: whole ones, and R^2 that bear out the verdict.
  void require_words() const {
    using detail::StatedNumber;
    const auto require_whole = [this](const char* word, StatedNumber number) {
      const std::string text = provenance(word);
      const bool whole = std::all_of(text.begin(), text.end(), [](char c) { return '0' <= c && c <= '9'; });
      if (!whole || text.size() > 20) refuse(number, text);
    };
    require_whole("seed", StatedNumber::seed);
    require_whole("epochs", StatedNumber::epochs);
    double figures[2]{};
    bool stated = true;
    for (const char* word : {"test_r_squared", "linear_regression_r_squared"}) {
      const std::string text = provenance(word);
      double& figure = figures[word[0] == 't' ? 0 : 1];
      stated = stated && !text.empty();
      if (text.empty()) continue;
      if (!parse_number(text, figure) || !is_finite(figure) || !detail::in_range<StatedNumber::r_squared>(figure)) {
        refuse(StatedNumber::r_squared, text);
      }
    }
    const bool borne_out = with([&](const auto& model) {
      const auto& said = model.records();
      return !said.has_verdict ||
             detail::bears_out(said.worse_than_mean, said.beats_linear_regression, figures[0], figures[1]);
    });
    if (stated && !borne_out) refuse(StatedNumber::judged_figures, "another");
  }
  [[noreturn]] void refuse(detail::StatedNumber number, const std::string& found) const {
    refuse(detail::stated_ranges[static_cast<std::size_t>(number)].expected, found);
  }
  [[noreturn]] void refuse(const std::string& expected, const std::string& found) const {
    throw InputError(path_, 0, 0, expected, found);
  }

  template <class Scalar>
  static std::vector<double> in_double(const Scalar* numbers, int count) {
    return {numbers, numbers + count};
  }
  template <class Scalar>
  static Commands<double> in_double_commands(const Commands<Scalar>& own) {
    Commands<double> commands{};
    for (std::size_t i = 0; i < commands.size(); ++i) commands[i] = static_cast<double>(own[i]);
    return commands;
  }

  std::string path_;
  std::size_t length_ = 0;
  std::vector<std::uint64_t> bytes_;  ///< aligned as a block must be
  std::variant<std::unique_ptr<const RunTimeModel<float>>, std::unique_ptr<const RunTimeModel<double>>> model_;
  ExactDerivatives derivatives_;
};

}  // namespace pinnquad
