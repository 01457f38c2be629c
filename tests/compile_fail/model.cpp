// SPDX-License-Identifier: MIT
// CASE NOT_A_MODEL: pinnquad: this type is not an exported model
// CASE MEMBER_MISSING: pinnquad: this type is not an exported model
// CASE NEWER_FORMAT: pinnquad: the model was exported by a newer pinnquad than this one; update the library
// CASE OLDER_FORMAT: pinnquad: the model's format is older than this library reads; export it again
// CASE UNDESCRIBED: pinnquad: the model lacks what its format demands
// CASE OTHER_FRAME: pinnquad: the model was trained in other frames
// CASE OTHER_FEATURE: pinnquad: the model was trained on other features than its feature set now has
// CASE OTHER_FEATURE_UNIT: pinnquad: the model was trained in other units than its feature set now has
// CASE FEATURE_NAME_MISSING: pinnquad: the model was trained on other features than its feature set now has
// CASE OTHER_OUTPUT: pinnquad: the model has other outputs than its output schema now has
// CASE OTHER_OUTPUT_UNIT: pinnquad: the model's outputs have another unit than its output schema
// CASE OTHER_VEHICLE: pinnquad: the model was trained for another airframe than its Vehicle
// CASE ROTORS_SWAPPED: pinnquad: the model was trained with another motor order than its Vehicle now has
// CASE ROTOR_TURNS_THE_OTHER_WAY: pinnquad: the model was trained with another motor order than its Vehicle now has
// CASE SPREAD_ZERO: pinnquad: a scaler's spread is not positive
// CASE WEIGHT_NOT_A_NUMBER: pinnquad: a weight of the model is NaN or infinite
// CASE WEIGHT_INFINITE: pinnquad: a weight of the model is NaN or infinite
// CASE SPREAD_INFINITE: pinnquad: a scaler's number is NaN or infinite
// CASE ENVELOPE_NOT_A_NUMBER: pinnquad: a border of the model's envelope is NaN or infinite
// CASE GOLDEN_OUTSIDE: pinnquad: a golden vector lies outside the model's envelope
// CASE TOO_FEW_PARAMETERS: pinnquad: the exported parameters do not have the network's length
// CASE ENVELOPE_LENGTH: pinnquad: the envelope does not have the length of the feature set
// CASE SCALER_LENGTH: pinnquad: a scaler does not have the length of what it scales
// CASE NO_GOLDEN_VECTORS: pinnquad: the model has no golden vectors
// CASE GOLDEN_LENGTH: pinnquad: a golden vector does not have the length
// CASE INPUTS_DIFFER: pinnquad: the network's input count differs from the feature set's size
// CASE OUTPUTS_DIFFER: pinnquad: the network's output count differs from the output schema's size
// CASE FEATURES_MAY_THROW: pinnquad: a feature set's check.. and extract.. must be noexcept
// CASE OUTPUTS_MAY_THROW: pinnquad: an output schema's functions must be noexcept
// CASE SCALAR_DIFFERS: pinnquad: the model's Scalar is not that of its Network
#include <array>
#include <limits>

#include "../support/described_model.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"

namespace {

using pinnquad::test::DescribedModel;

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
  scaler.spread[15] = last;
  return scaler;
}

#if defined(OTHER_VEHICLE)
struct RenamedQuadrotor : pinnquad::PaperQuadrotor {
  static constexpr const char* name = "my_quadrotor";
};
#endif

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
struct Changed : DescribedModel {
#if defined(NEWER_FORMAT)
  static constexpr int format_version = pinnquad::model_format_version + 1;
#elif defined(OLDER_FORMAT)
  static constexpr int format_version = pinnquad::oldest_model_format_version - 1;
#elif defined(OTHER_FRAME)
  static constexpr const char* frame = "body FLU, world ENU";
#elif defined(OTHER_FEATURE)
  static constexpr auto feature_names = with_first(DescribedModel::feature_names, "vdot_wx");
#elif defined(OTHER_FEATURE_UNIT)
  static constexpr auto feature_units = with_first(DescribedModel::feature_units, "g");
#elif defined(FEATURE_NAME_MISSING)
  static constexpr std::array<const char*, 1> feature_names = {"vdot_bx"};
#elif defined(OTHER_OUTPUT)
  static constexpr auto output_names = with_first(DescribedModel::output_names, "n1");
#elif defined(OTHER_OUTPUT_UNIT)
  static constexpr const char* output_unit = "rev/s";
#elif defined(OTHER_VEHICLE)
  using Vehicle = RenamedQuadrotor;
#elif defined(ROTORS_SWAPPED)
  static constexpr std::array<std::array<int, 3>, 4> motor_torque_signs = {
      { {1, -1, 1},
        {-1, 1, 1},
        {1, 1, -1},
        { -1,
          -1,
          -1 } }};
#elif defined(ROTOR_TURNS_THE_OTHER_WAY)
  static constexpr std::array<std::array<int, 3>, 4> motor_torque_signs = {
      { {-1, 1, 1},
        {1, -1, 1},
        {1, 1, -1},
        { -1,
          -1,
          1 } }};
#elif defined(SPREAD_ZERO)
  static constexpr auto input = with_spread(DescribedModel::input, 0.0F);
#elif defined(WEIGHT_NOT_A_NUMBER)
  static constexpr auto parameters = with_last(DescribedModel::parameters, not_a_number);
#elif defined(WEIGHT_INFINITE)
  static constexpr auto parameters = with_last(DescribedModel::parameters, -infinity);
#elif defined(SPREAD_INFINITE)
  static constexpr auto input = with_spread(DescribedModel::input, infinity);
#elif defined(ENVELOPE_NOT_A_NUMBER)
  static constexpr auto envelope_lower = with_last(DescribedModel::envelope_lower, not_a_number);
#elif defined(GOLDEN_OUTSIDE)
  static constexpr std::array<float, 16> envelope_upper{};
#elif defined(TOO_FEW_PARAMETERS)
  static constexpr std::array<float, 171> parameters{};
#elif defined(ENVELOPE_LENGTH)
  static constexpr std::array<float, 15> envelope_upper{};
#elif defined(SCALER_LENGTH)
  static constexpr pinnquad::Scaler<float, 3> output{};
#elif defined(NO_GOLDEN_VECTORS)
  static constexpr std::array<std::array<float, 16>, 0> golden_features{};
  static constexpr std::array<std::array<float, 4>, 0> golden_commands{};
#elif defined(GOLDEN_LENGTH)
  static constexpr std::array<std::array<float, 15>, 6> golden_features{};
#elif defined(INPUTS_DIFFER)
  using Network = pinnquad::Network<float, pinnquad::Inputs<15>, pinnquad::Dense<4>>;
#elif defined(OUTPUTS_DIFFER)
  using Network = pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<8>>;
#elif defined(FEATURES_MAY_THROW)
  using Features = ThrowingFeatures;
#elif defined(OUTPUTS_MAY_THROW)
  using Outputs = ThrowingOutputs;
#elif defined(SCALAR_DIFFERS)
  using Scalar = double;
#endif
};

/// A header that claims format 2 and has the members of format 1.
struct Undescribed : pinnquad::test::SmallModel {
  static constexpr int format_version = 2;
};

/// A header cut short.
struct Truncated {
  using Scalar = float;
  using Network = DescribedModel::Network;
  using Features = DescribedModel::Features;
};

struct Nothing {};

#if defined(NOT_A_MODEL)
using Model = Nothing;
#elif defined(MEMBER_MISSING)
using Model = Truncated;
#elif defined(UNDESCRIBED)
using Model = Undescribed;
#else
using Model = Changed;
#endif

}  // namespace

int main() {
  const pinnquad::InverseDynamics<Model> inverse;
  pinnquad::Commands<float> commands{};
  const pinnquad::Status status = inverse.predict({}, commands);
  return status == pinnquad::Status::ok ? static_cast<int>(sizeof(Nothing) + sizeof(Truncated) + sizeof(Changed)) : 0;
}
