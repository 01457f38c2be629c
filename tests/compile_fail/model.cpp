// SPDX-License-Identifier: MIT
// CASE NOT_A_MODEL: pinnquad: this type is not an exported model
// CASE MEMBER_MISSING: pinnquad: this type is not an exported model
// CASE NEWER_FORMAT: pinnquad: the model's header has the format .found., .*: train and export again
// CASE OLDER_FORMAT: pinnquad: the model's header has the format .found., .*: train and export again
// CASE UNDESCRIBED: pinnquad: the model lacks what its format demands
// CASE UNHASHED: pinnquad: the model lacks what its format demands
// CASE EDITED: pinnquad: the header, or the airframe that it was trained for, was edited since it was exported
// CASE OTHER_FEATURE: pinnquad: the model was trained for another shape than its types now have
// CASE OTHER_FEATURE_UNIT: pinnquad: the model was trained for another shape than its types now have
// CASE OTHER_OUTPUT: pinnquad: the model was trained for another shape than its types now have
// CASE OTHER_VEHICLE: pinnquad: the model was trained for another shape than its types now have
// CASE ROTOR_TURNS_THE_OTHER_WAY: pinnquad: the model was trained for another shape than its types now have
// CASE OTHER_LAYER: pinnquad: the model was trained for another shape than its types now have
// CASE OTHER_BASE: pinnquad: .*window, columns or base of its types are
// CASE SPREAD_ZERO: pinnquad: a scaler's standard deviation is not positive
// CASE WEIGHT_NOT_A_NUMBER: pinnquad: a weight of the model is NaN or infinite
// CASE WEIGHT_INFINITE: pinnquad: a weight of the model is NaN or infinite
// CASE SPREAD_INFINITE: pinnquad: a scaler's number is NaN or infinite
// CASE ENVELOPE_NOT_A_NUMBER: pinnquad: a border of the model's envelope is NaN or infinite
// CASE GOLDEN_OUTSIDE: pinnquad: a golden vector lies outside the model's envelope
// CASE TOO_FEW_PARAMETERS: pinnquad: the exported parameters do not have the network's length
// CASE ENVELOPE_LENGTH: pinnquad: the envelope does not have the length of the feature set
// CASE SCALER_LENGTH: pinnquad: a scaler does not have the length of what it scales
// CASE INPUT_SCALER_LENGTH: pinnquad: a scaler does not have the length of what it scales
// CASE NO_GOLDEN_VECTORS: pinnquad: the model has no golden vectors
// CASE GOLDEN_LENGTH: pinnquad: a golden vector does not have the length
// CASE INPUTS_DIFFER: pinnquad: the network's input count differs from the feature set's size
// CASE OUTPUTS_DIFFER: pinnquad: the network's output count differs from the output schema's size
// CASE FEATURES_MAY_THROW: pinnquad: a feature set's check.. and extract.. must be noexcept
// CASE OUTPUTS_MAY_THROW: pinnquad: an output schema's functions must be noexcept
// CASE SCALAR_DIFFERS: pinnquad: the model's Scalar is not that of its Network
// CASE NO_COMMAND_RANGE: pinnquad: the range of the model's commands is none
// CASE PERIOD_NEGATIVE: pinnquad: the model's sample period or removed lag is no time of 0 to 4 s
// CASE OTHER_ALLOCATION: pinnquad: the model was trained for another allocation than its Vehicle now has
// CASE BIAS_LENGTH: pinnquad: the model's time constants of a bias are not four
// CASE BIAS_NEGATIVE: pinnquad: a time constant of the model's bias is no time of 0 to 60 s
// CASE BIAS_TOO_FAST: pinnquad: a time constant of the model's bias is no time of 0 to 60 s that a bias can have
// CASE LAG_OF_NO_ROTOR: a lag 1 s at most
// CASE COMMANDS_TO_FIVE: pinnquad: the range of the model's commands is none, or beyond -1 to 1
// CASE R_SQUARED_NEGATIVE: pinnquad: the model's verdict is not that of its R
// CASE R_SQUARED_ABOVE_1: pinnquad: an R.2 of the model is above 1 or no number
#include <array>
#include <limits>

#include "../support/recorded_model.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"

namespace {

using pinnquad::test::Hashed;
using pinnquad::test::RecordedNumbers;

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
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

constexpr auto with_spread(pinnquad::Scaler<float, 16> scaler, float last) {
  scaler.standard_deviation[15] = last;
  return scaler;
}

/// A header whose types say another thing than at its export: it states the hashes of then.
struct Retyped : pinnquad::test::RecordedModel {
#if defined(OTHER_FEATURE)
  struct Features : pinnquad::PaperFeatures {
    [[maybe_unused]] static constexpr auto names = with_first(pinnquad::PaperFeatures::names, "vdot_wx");
  };
#elif defined(OTHER_FEATURE_UNIT)
  struct Features : pinnquad::PaperFeatures {
    [[maybe_unused]] static constexpr auto units = with_first(pinnquad::PaperFeatures::units, "g");
  };
#elif defined(OTHER_OUTPUT)
  using Outputs = pinnquad::RotorSpeedOutputs;
#elif defined(OTHER_VEHICLE)
  struct Vehicle : pinnquad::PaperQuadrotor {
    [[maybe_unused]] static constexpr const char* name = "my_quadrotor";
  };
#elif defined(ROTOR_TURNS_THE_OTHER_WAY)
  struct Vehicle : pinnquad::PaperQuadrotor {
    template <class Number>
    static constexpr pinnquad::Airframe<Number> value() {
      auto airframe = pinnquad::PaperQuadrotor::value<Number>();
      airframe.rotors[3].spin = pinnquad::Spin::counter_clockwise;
      return airframe;
    }
  };
#elif defined(OTHER_LAYER)
  using Network =
      pinnquad::Mlp<float, pinnquad::InputSize<16>, pinnquad::Hidden<1, 8>, pinnquad::OutputSize<4>, pinnquad::Tanh>;
#elif defined(OTHER_BASE)
  using Outputs = pinnquad::ResidualOutputs<pinnquad::LinearizedBase>;
#endif
};

struct ThrowingFeatures : pinnquad::PaperFeatures {
  template <class Scalar>
  static pinnquad::Status check(const Inputs<Scalar>& in) {
    return pinnquad::PaperFeatures::check<Scalar>(in);
  }
};
struct ThrowingOutputs : pinnquad::CommandOutputs {
  template <class Scalar>
  static constexpr Scalar command(Scalar output, const pinnquad::Airframe<Scalar>&) {
    return output;
  }
};

/// The small model with one member changed by the case.
struct Changed : RecordedNumbers {
#if defined(NEWER_FORMAT)
  static constexpr int format_version = pinnquad::header_format_version + 1;
#elif defined(OLDER_FORMAT)
  static constexpr int format_version = pinnquad::header_format_version - 1;
#elif defined(SPREAD_ZERO)
  static constexpr auto input = with_spread(RecordedNumbers::input, 0.0F);
#elif defined(WEIGHT_NOT_A_NUMBER)
  static constexpr auto parameters = with_last(RecordedNumbers::parameters, not_a_number);
#elif defined(WEIGHT_INFINITE)
  static constexpr auto parameters = with_last(RecordedNumbers::parameters, -infinity);
#elif defined(SPREAD_INFINITE)
  static constexpr auto input = with_spread(RecordedNumbers::input, infinity);
#elif defined(ENVELOPE_NOT_A_NUMBER)
  static constexpr auto envelope_lower = with_last(RecordedNumbers::envelope_lower, not_a_number);
#elif defined(GOLDEN_OUTSIDE)
  static constexpr std::array<float, 16> envelope_upper{};
#elif defined(TOO_FEW_PARAMETERS)
  static constexpr std::array<float, 171> parameters{};
#elif defined(ENVELOPE_LENGTH)
  static constexpr std::array<float, 15> envelope_upper{};
#elif defined(SCALER_LENGTH)
  static constexpr pinnquad::Scaler<float, 3> output{};
#elif defined(INPUT_SCALER_LENGTH)
  static constexpr pinnquad::Scaler<float, 17> input{};
#elif defined(NO_GOLDEN_VECTORS)
  static constexpr std::array<std::array<float, 16>, 0> golden_features{};
  static constexpr std::array<std::array<float, 4>, 0> golden_commands{};
#elif defined(GOLDEN_LENGTH)
  static constexpr std::array<std::array<float, 15>, 6> golden_features{};
#elif defined(INPUTS_DIFFER)
  using Network = pinnquad::Network<float, pinnquad::InputSize<15>, pinnquad::Dense<4>>;
#elif defined(OUTPUTS_DIFFER)
  using Network = pinnquad::Network<float, pinnquad::InputSize<16>, pinnquad::Dense<8>>;
#elif defined(FEATURES_MAY_THROW)
  using Features = ThrowingFeatures;
#elif defined(OUTPUTS_MAY_THROW)
  using Outputs = ThrowingOutputs;
#elif defined(SCALAR_DIFFERS)
  using Scalar = double;
#endif
};

/// The small model with one record changed by the case, and optional records that are sound.
struct Recorded : RecordedNumbers {
#if defined(NO_COMMAND_RANGE)
  static constexpr double command_lower = 1.5;
#elif defined(LAG_OF_NO_ROTOR)
  static constexpr double lag_removed_s = 3.5;
#elif defined(COMMANDS_TO_FIVE)
  static constexpr double command_upper = 5;
#elif defined(PERIOD_NEGATIVE)
  static constexpr double sample_period_s = -0.004;
#elif defined(OTHER_ALLOCATION)
  static constexpr auto allocation = [] {
    auto changed = RecordedNumbers::allocation;
    changed[3][2] *= 1.001;
    return changed;
  }();
#endif
#if defined(BIAS_LENGTH)
  static constexpr std::array<float, 3> bias_time_constants_s{};
#elif defined(BIAS_NEGATIVE)
  static constexpr std::array<float, 4> bias_time_constants_s = {0.2f, 0.5f, -0.5f, 0.5f};
#elif defined(BIAS_TOO_FAST)
  static constexpr std::array<float, 4> bias_time_constants_s = {0.2f, 0.5f, 0.0001f, 0.5f};
#else
  static constexpr std::array<float, 4> bias_time_constants_s = {0.2f, 0.5f, 0.5f, 0.0f};
#endif
  static constexpr bool worse_than_mean = false, beats_linear_regression = true;
#if defined(R_SQUARED_NEGATIVE)
  static constexpr double test_r_squared = -3.5, linear_regression_r_squared = -4;
#elif defined(R_SQUARED_ABOVE_1)
  static constexpr double test_r_squared = 1.5, linear_regression_r_squared = 0.5;
#else
  static constexpr double test_r_squared = 0.75, linear_regression_r_squared = 0.5;
#endif
};

struct Undescribed : pinnquad::test::SmallNumbers {
  static constexpr int format_version = pinnquad::header_format_version;
};

struct Edited : pinnquad::test::RecordedModel {
  static constexpr int training_rows = 6001;
};

/// A header cut short.
struct Truncated {
  using Scalar = float;
  using Network = RecordedNumbers::Network;
  using Features = RecordedNumbers::Features;
};

struct Nothing {};

#if defined(NOT_A_MODEL)
using Model = Nothing;
#elif defined(MEMBER_MISSING)
using Model = Truncated;
#elif defined(UNDESCRIBED)
using Model = Undescribed;
#elif defined(UNHASHED)
using Model = RecordedNumbers;
#elif defined(EDITED)
using Model = Edited;
#elif defined(OTHER_FEATURE) || defined(OTHER_FEATURE_UNIT) || defined(OTHER_OUTPUT) || defined(OTHER_VEHICLE) || \
    defined(ROTOR_TURNS_THE_OTHER_WAY) || defined(OTHER_LAYER) || defined(OTHER_BASE)
using Model = Retyped;
#elif defined(NO_COMMAND_RANGE) || defined(PERIOD_NEGATIVE) || defined(OTHER_ALLOCATION) || defined(BIAS_LENGTH) || \
    defined(BIAS_NEGATIVE) || defined(BIAS_TOO_FAST) || defined(LAG_OF_NO_ROTOR) || defined(COMMANDS_TO_FIVE) ||    \
    defined(R_SQUARED_NEGATIVE) || defined(R_SQUARED_ABOVE_1)
using Model = Hashed<Recorded>;
#else
using Model = Hashed<Changed>;
static_assert(pinnquad::require_model<Hashed<Recorded>>());
#endif

}  // namespace

int main() {
  const pinnquad::InverseDynamics<Model> inverse;
  pinnquad::Commands<float> commands{};
  const pinnquad::Status status = inverse.predict({}, commands);
  return status == pinnquad::Status::ok ? static_cast<int>(sizeof(Nothing) + sizeof(Truncated) + sizeof(Changed)) : 0;
}
