// SPDX-License-Identifier: MIT
#include "pinnquad/flight.hpp"

using namespace pinnquad;

constexpr int inputs = PhysicsFeatures::size;
using Residual = Network<float, InputSize<residual_inputs<PhysicsFeatures>>, Dense<4>>;
using Predictor = MonotonePredictor<PhysicsFeatures, Residual>;
using Numbers = Predictor::Parameters;
constexpr auto bounds = std::size_t(MonotoneBase<PhysicsFeatures>::parameter_count);

constexpr auto all_at(float value) {
  std::array<float, std::size_t(inputs)> values{};
  for (float& each : values) each = value;
  return values;
}
constexpr Numbers sound() {
  Numbers parameters{};
  for (std::size_t i = 0; i < 3; ++i) parameters[i] = 0.5f;
  for (std::size_t k = 0; k < 4; ++k) {
    parameters[bounds + k] = -0.1f;
    parameters[bounds + 4 + k] = 0.1f;
  }
  return parameters;
}

struct Certified {
  using Scalar = float;
  using Network = Predictor;
  using Features = PhysicsFeatures;
  using Outputs = AxisCommandOutputs;
  using Vehicle = PaperQuadrotor;
  static constexpr Numbers parameters = sound();
  static constexpr Scaler<float, inputs> input{};
  static constexpr Scaler<float, 4> output{};
  static constexpr auto envelope_lower = all_at(-10);
  static constexpr auto envelope_upper = all_at(10);
};

/// The same with another number.
#define NUMBERS(...)                                 \
  constexpr Numbers changed() {                      \
    Numbers parameters = sound();                    \
    __VA_ARGS__;                                     \
    return parameters;                               \
  }                                                  \
  struct Changed : Certified {                       \
    static constexpr Numbers parameters = changed(); \
  };                                                 \
  static_assert(require_certificate<Changed>())

/// Models on a base: of features that it reads, and of others.
template <class FeatureSet, class Schema, class Predictor = MonotoneBase<FeatureSet>>
struct OnBase {
  using Scalar = float;
  using Network = Predictor;
  using Features = FeatureSet;
  using Outputs = Schema;
  using Vehicle = PaperQuadrotor;
};
template <class FeatureSet>
using FourOf = Network<float, InputSize<FeatureSet::size>, Dense<4>>;

// SOUND
static_assert(require_certificate<Certified>());
static_assert(certificate_of<Certified>().slope[0] > 0.49 && certificate_of<Certified>().command_bound[3] < 0.11);
static_assert(require_shape<OnBase<PhysicsFeatures, SignedSumsOn<RigidBodyBase>>>() &&
              require_shape<OnBase<WithColumns<PhysicsFeatures, BatteryVoltage>, SignedSumsOn<RigidBodyBase>>>());
static_assert(require_shape<OnBase<PaperFeatures, ResidualOutputs<LinearizedBase>, FourOf<PaperFeatures>>>());

// CASE NO_STRUCTURE: pinnquad: this model has no structure that could be proven
struct Unstructured : Certified {
  using Outputs = CommandOutputs;
};
static_assert(require_certificate<Unstructured>());
// CASE LONE_ANGULAR_ACCELERATION: pinnquad: a feature of the model shows an angular acceleration beside the three
using LonePast = PartlyWindowed<InverseFeatures, Chosen<NamedFeatures, 3>, 2, PeriodMicroseconds<20000>>;
struct Lone : Certified {
  using Network = MonotoneBase<LonePast>;
  using Features = LonePast;
};
static_assert(require_certificate<Lone>());
// CASE SLOPE_BELOW_ZERO: pinnquad: a slope of the model is not above 0
NUMBERS(parameters[1] = -0.5f);
// CASE SLOPE_BELOW_ROUNDING: pinnquad: a slope of the model is not above 0 by its floor, or by what its network or rounding
NUMBERS(parameters[2] = 1e-4f; for (std::size_t i = 3; i < 20; ++i) parameters[i] = 1e4f);
// CASE BOUNDS_UPSIDE_DOWN: pinnquad: the bounds of the model's residual are none
NUMBERS(parameters[bounds + 1] = 0.2f);
// CASE RESIDUAL_SEES_TOO_MUCH: pinnquad: a predictor inside Masked takes all features that are not masked
constexpr int wrong = Masked<Network<float, InputSize<inputs>, Dense<4>>, inputs, 3>::outputs;
// CASE WITHHELD_TWICE: pinnquad: Masked features are in threes, ascending, and do not overlap
constexpr int wrong = Masked<Residual, inputs, 3, 5>::outputs;
// CASE BASE_SEES_THE_TURNING: pinnquad: SignedSumsOn needs a base that is not shown the angular acceleration
struct Turning : RigidBodyBase {
  static constexpr std::array<ReadFeature, 2> reads = {{{2, "s_z", "m/s^2"}, {4, "wdot_y", "rad/s^2"}}};
};
constexpr int wrong = SignedSumsOn<Turning>::size;
// CASE BASE_SAYS_NOTHING: pinnquad: a base has `reads`, prepare.., commands.. and slopes.., static and noexcept
struct Silent {
  static constexpr const char* description = "Silent";
};
constexpr int wrong = SignedSumsOn<Silent>::size;
// CASE BASE_WITHOUT_SLOPES: pinnquad: a base has `reads`, prepare.., commands.. and slopes.., static and noexcept
struct Slopeless : RigidBodyBase {
  static void slopes() noexcept;
};
constexpr int wrong = ResidualOutputs<Slopeless>::size;
// CASE RIGID_BODY_OF_INVERSE_FEATURES: pinnquad: the outputs' base reads a feature that the feature set has not
static_assert(require_shape<OnBase<InverseFeatures, SignedSumsOn<RigidBodyBase>>>());
// CASE RIGID_BODY_OF_OTHER_UNITS: pinnquad: the outputs' base reads a feature that the feature set has not
struct OtherUnits : PhysicsFeatures {
  [[maybe_unused]] static constexpr auto units = [] {
    auto all = PhysicsFeatures::units;
    all[2] = "g";
    return all;
  }();
};
static_assert(require_shape<OnBase<OtherUnits, SignedSumsOn<RigidBodyBase>>>());
// CASE NO_ANGULAR_ACCELERATION: pinnquad: a model that is monotone in the angular acceleration needs a feature set
constexpr int wrong = MonotoneBase<Joined<SpecificForce, BodyRates>>::outputs;
