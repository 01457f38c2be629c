// SPDX-License-Identifier: MIT
#include <array>
#include <limits>

#include "../support/recorded_model.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"

using namespace pinnquad;
using test::Hashed;
using test::RecordedNumbers;

template <class Texts>
constexpr Texts with_first(Texts texts, const char* first) {
  texts[0] = first;
  return texts;
}
template <class Array>
constexpr Array with_last(Array values, float last) {
  values[values.size() - 1] = last;
  return values;
}
constexpr auto with_spread(float last) {
  auto scaler = RecordedNumbers::input;
  scaler.standard_deviation[15] = last;
  return scaler;
}
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

template <class Model>
Status flown() {
  const InverseDynamics<Model> inverse;
  Commands<float> commands{};
  return inverse.predict({}, commands);
}

/// The small model with one member changed, and one whose types say another thing than at its export: it states the
/// hashes of then.
#define CHANGED(...)                 \
  struct Changed : RecordedNumbers { \
    __VA_ARGS__;                     \
  };                                 \
  const auto status = flown<Hashed<Changed>>()
#define RETYPED(...)                     \
  struct Retyped : test::RecordedModel { \
    __VA_ARGS__;                         \
  };                                     \
  const auto status = flown<Retyped>()

// SOUND
struct Optional : RecordedNumbers {
  static constexpr std::array<float, 4> bias_time_constants_s = {0.2f, 0.5f, 0.5f, 0.0f};
  static constexpr bool worse_than_mean = false, beats_linear_regression = true;
  static constexpr double test_r_squared = 0.75, linear_regression_r_squared = 0.5;
};
const auto statuses = {flown<Hashed<Optional>>(), flown<test::RecordedModel>()};

// CASE NOT_A_MODEL: pinnquad: this type is not an exported model
struct Nothing {};
const auto status = flown<Nothing>();
// CASE NEWER_FORMAT: pinnquad: the model's header has the format .found., .*: train and export again
CHANGED(static constexpr int format_version = header_format_version + 1);
// CASE OLDER_FORMAT: pinnquad: the model's header has the format .found., .*: train and export again
CHANGED(static constexpr int format_version = header_format_version - 1);
// CASE UNDESCRIBED: pinnquad: the model lacks what its format demands
struct Undescribed : test::SmallNumbers {
  static constexpr int format_version = header_format_version;
};
const auto status = flown<Undescribed>();
// CASE UNHASHED: pinnquad: the model lacks what its format demands
const auto status = flown<RecordedNumbers>();
// CASE EDITED: pinnquad: the header, or the airframe that it was trained for, was edited since it was exported
RETYPED(static constexpr int training_rows = 6001);
// CASE OTHER_FEATURE: pinnquad: the model was trained for another shape than its types now have
struct Named : PaperFeatures {
  [[maybe_unused]] static constexpr auto names = with_first(PaperFeatures::names, "vdot_wx");
};
RETYPED(using Features = Named);
// CASE OTHER_BASE: pinnquad: .*window, columns or base of its types are
RETYPED(using Outputs = ResidualOutputs<LinearizedBase>);
// CASE SPREAD_ZERO: pinnquad: a scaler's standard deviation is not positive
CHANGED(static constexpr auto input = with_spread(0.0F));
// CASE WEIGHT_NOT_A_NUMBER: pinnquad: a weight of the model is NaN or infinite
CHANGED(static constexpr auto parameters = with_last(RecordedNumbers::parameters, not_a_number));
// CASE SPREAD_INFINITE: pinnquad: a scaler's number is NaN or infinite
CHANGED(static constexpr auto input = with_spread(infinity));
// CASE ENVELOPE_NOT_A_NUMBER: pinnquad: a border of the model's envelope is NaN or infinite
CHANGED(static constexpr auto envelope_lower = with_last(RecordedNumbers::envelope_lower, not_a_number));
// CASE GOLDEN_OUTSIDE: pinnquad: a golden vector lies outside the model's envelope
CHANGED(static constexpr std::array<float, 16> envelope_upper{});
// CASE TOO_FEW_PARAMETERS: pinnquad: the exported parameters do not have the network's length
CHANGED(static constexpr std::array<float, 171> parameters{});
// CASE ENVELOPE_LENGTH: pinnquad: the envelope does not have the length of the feature set
CHANGED(static constexpr std::array<float, 15> envelope_upper{});
// CASE SCALER_LENGTH: pinnquad: a scaler does not have the length of what it scales
CHANGED(static constexpr Scaler<float, 3> output{});
// CASE NO_GOLDEN_VECTORS: pinnquad: the model has no golden vectors
CHANGED(static constexpr std::array<std::array<float, 16>, 0> golden_features{};
        static constexpr std::array<std::array<float, 4>, 0> golden_commands{});
// CASE GOLDEN_LENGTH: pinnquad: a golden vector does not have the length
CHANGED(static constexpr std::array<std::array<float, 15>, 6> golden_features{});
// CASE INPUTS_DIFFER: pinnquad: the network's input count differs from the feature set's size
CHANGED(using Network = pinnquad::Network<float, InputSize<15>, Dense<4>>);
// CASE OUTPUTS_DIFFER: pinnquad: the network's output count differs from the output schema's size
CHANGED(using Network = pinnquad::Network<float, InputSize<16>, Dense<8>>);
// CASE FEATURES_MAY_THROW: pinnquad: a feature set's check.. and extract.. must be noexcept
struct ThrowingFeatures : PaperFeatures {
  template <class Scalar>
  static Status check(const Inputs<Scalar>& in) {
    return PaperFeatures::check<Scalar>(in);
  }
};
CHANGED(using Features = ThrowingFeatures);
// CASE OUTPUTS_MAY_THROW: pinnquad: an output schema's functions must be noexcept
struct ThrowingOutputs : EachRotor<ThrowingOutputs> {
  static constexpr auto names = CommandOutputs::names, units = CommandOutputs::units;
  template <class Scalar>
  static constexpr Scalar from_command(Scalar command, const Airframe<Scalar>&, std::size_t) noexcept {
    return command;
  }
  template <class Scalar>
  static constexpr Scalar command(Scalar output, const Airframe<Scalar>&, std::size_t) {
    return output;
  }
  template <class Scalar>
  static constexpr Scalar command_slope(Scalar, const Airframe<Scalar>&, std::size_t) noexcept {
    return Scalar(1);
  }
};
CHANGED(using Outputs = ThrowingOutputs);
// CASE OUTPUTS_OF_ANOTHER: pinnquad: this output schema derives from another one
struct HalvedOutputs : CommandOutputs {
  template <class Scalar>
  static constexpr Scalar command(Scalar output, const Airframe<Scalar>&, std::size_t) noexcept {
    return output / 2;
  }
};
CHANGED(using Outputs = HalvedOutputs);
// CASE SCALAR_DIFFERS: pinnquad: the model's Scalar is not that of its Network
CHANGED(using Scalar = double);
// CASE NO_COMMAND_RANGE: pinnquad: the range of the model's commands is none
CHANGED(static constexpr double command_lower = 1.5);
// CASE PERIOD_NEGATIVE: pinnquad: the model's sample period or removed lag is no time of 0 to 4 s
CHANGED(static constexpr double sample_period_s = -0.004);
// CASE OTHER_ALLOCATION: pinnquad: the model was trained for another allocation than its Vehicle now has
constexpr auto other_allocation() {
  auto changed = RecordedNumbers::allocation;
  changed[3][2] *= 1.001;
  return changed;
}
CHANGED(static constexpr auto allocation = other_allocation());
// CASE BIAS_LENGTH: pinnquad: the model's time constants of a bias are not four
CHANGED(static constexpr std::array<float, 3> bias_time_constants_s{});
// CASE BIAS_NEGATIVE: pinnquad: a time constant of the model's bias is no time of 0 to 60 s
CHANGED(static constexpr std::array<float, 4> bias_time_constants_s = {0.2f, 0.5f, -0.5f, 0.5f});
// CASE LAG_OF_NO_ROTOR: a lag 1 s at most
CHANGED(static constexpr double lag_removed_s = 3.5);
// CASE COMMANDS_TO_FIVE: pinnquad: the range of the model's commands is none, or beyond -1 to 1
CHANGED(static constexpr double command_upper = 5);
// CASE R_SQUARED_NEGATIVE: pinnquad: the model's verdict is not that of its R
CHANGED(static constexpr double test_r_squared = -3.5; static constexpr double linear_regression_r_squared = -4;
        static constexpr bool worse_than_mean = false; static constexpr bool beats_linear_regression = true);
// CASE R_SQUARED_ABOVE_1: pinnquad: an R.2 of the model is above 1 or no number
CHANGED(static constexpr double test_r_squared = 1.5; static constexpr double linear_regression_r_squared = 0.5;
        static constexpr bool worse_than_mean = false; static constexpr bool beats_linear_regression = true);
