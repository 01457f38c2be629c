// SPDX-License-Identifier: MIT
// CASE NO_STRUCTURE: pinnquad: this model has no structure that could be proven
// CASE LONE_ANGULAR_ACCELERATION: pinnquad: a feature of the model shows an angular acceleration beside the three
// CASE SLOPE_BELOW_ZERO: pinnquad: a slope of the model is not above 0
// CASE SLOPE_ZERO: pinnquad: a slope of the model is not above 0
// CASE SLOPE_HARDLY_ABOVE_ZERO: pinnquad: a slope of the model is not above 0 by its floor
// CASE SLOPE_BELOW_ROUNDING: pinnquad: a slope of the model is not above 0 by its floor, or by what its network or rounding
// CASE BOUNDS_UPSIDE_DOWN: pinnquad: the bounds of the model's residual are none
// CASE RESIDUAL_SEES_TOO_MUCH: pinnquad: a predictor inside Masked takes all features that are not masked
// CASE WITHHELD_TWICE: pinnquad: Masked features are in threes, ascending, and do not overlap
// CASE BASE_SEES_THE_TURNING: pinnquad: SignedSumsOn needs a base that is not shown the angular acceleration
// CASE BASE_SAYS_NOTHING: pinnquad: a base has `reads`, prepare.., commands.. and slopes.., static and noexcept
// CASE BASE_WITHOUT_SLOPES: pinnquad: a base has `reads`, prepare.., commands.. and slopes.., static and noexcept
// CASE RIGID_BODY_OF_INVERSE_FEATURES: pinnquad: the outputs' base reads a feature that the feature set has not
// CASE RIGID_BODY_OF_PAPER_FEATURES: pinnquad: the outputs' base reads a feature that the feature set has not
// CASE RIGID_BODY_OF_OTHER_UNITS: pinnquad: the outputs' base reads a feature that the feature set has not
// CASE LINEARIZED_OF_PHYSICS_FEATURES: pinnquad: the outputs' base reads a feature that the feature set has not
// CASE NO_ANGULAR_ACCELERATION: pinnquad: a model that is monotone in the angular acceleration needs a feature set
#include "pinnquad/flight.hpp"

namespace {

using namespace pinnquad;

using Features = PhysicsFeatures;
constexpr int inputs = Features::size;
using Residual = Network<float, InputSize<residual_inputs<Features>>, Dense<4>>;
using Predictor = MonotonePredictor<Features, Residual>;

constexpr auto all_at(float value) {
  std::array<float, std::size_t(inputs)> values{};
  for (float& each : values) each = value;
  return values;
}
constexpr Predictor::Parameters numbers() {
  Predictor::Parameters parameters{};
  for (std::size_t i = 0; i < 3; ++i) parameters[i] = 0.5f;
#ifdef SLOPE_BELOW_ZERO
  parameters[1] = -0.5f;
#endif
#ifdef SLOPE_HARDLY_ABOVE_ZERO
  parameters[1] = 1e-45f;
#endif
#ifdef SLOPE_BELOW_ROUNDING
  parameters[2] = 1e-4f;
  for (std::size_t i = 3; i < 20; ++i) parameters[i] = 1e4f;
#endif
#ifdef SLOPE_ZERO
  parameters[2] = 0;
#endif
  constexpr auto bounds = std::size_t(MonotoneBase<Features>::parameter_count);
  for (std::size_t k = 0; k < 4; ++k) {
    parameters[bounds + k] = -0.1f;
    parameters[bounds + 4 + k] = 0.1f;
  }
#ifdef BOUNDS_UPSIDE_DOWN
  parameters[bounds + 1] = 0.2f;
#endif
  return parameters;
}

struct Certified {
  using Scalar = float;
  using Network = Predictor;
  using Features = PhysicsFeatures;
#ifdef NO_STRUCTURE
  using Outputs = CommandOutputs;
#else
  using Outputs = AxisCommandOutputs;
#endif
  using Vehicle = PaperQuadrotor;
  static constexpr Predictor::Parameters parameters = numbers();
  static constexpr Scaler<float, inputs> input{};
  static constexpr Scaler<float, 4> output{};
  static constexpr auto envelope_lower = all_at(-10);
  static constexpr auto envelope_upper = all_at(10);
};
static_assert(require_certificate<Certified>());
static_assert(certificate_of<Certified>().slope[0] > 0.49 && certificate_of<Certified>().command_bound[3] < 0.11);

#ifdef LONE_ANGULAR_ACCELERATION
using LonePast = PartlyWindowed<InverseFeatures, Chosen<NamedFeatures, 3>, 2, PeriodMicroseconds<20000>>;
struct Lone : Certified {
  using Network = MonotoneBase<LonePast>;
  using Features = LonePast;
};
static_assert(require_certificate<Lone>());
#endif

/// Models on a base: of features that it reads, and of others.
template <class FeatureSet, class Schema, class Predictor = MonotoneBase<FeatureSet>>
struct OnBase {
  using Scalar = float;
  using Network = Predictor;
  using Features = FeatureSet;
  using Outputs = Schema;
  using Vehicle = PaperQuadrotor;
};
struct OtherUnits : PhysicsFeatures {
  [[maybe_unused]] static constexpr auto units = [] {
    auto all = PhysicsFeatures::units;
    all[2] = "g";
    return all;
  }();
};
template <class FeatureSet>
using FourOf = Network<float, InputSize<FeatureSet::size>, Dense<4>>;
static_assert(require_shape<OnBase<PhysicsFeatures, SignedSumsOn<RigidBodyBase>>>() &&
              require_shape<OnBase<WithColumns<PhysicsFeatures, BatteryVoltage>, SignedSumsOn<RigidBodyBase>>>());
static_assert(require_shape<OnBase<PaperFeatures, ResidualOutputs<LinearizedBase>, FourOf<PaperFeatures>>>());
#if defined(RIGID_BODY_OF_INVERSE_FEATURES)
static_assert(require_shape<OnBase<InverseFeatures, SignedSumsOn<RigidBodyBase>>>());
#elif defined(RIGID_BODY_OF_PAPER_FEATURES)
static_assert(require_shape<OnBase<PaperFeatures, SignedSumsOn<RigidBodyBase>>>());
#elif defined(RIGID_BODY_OF_OTHER_UNITS)
static_assert(require_shape<OnBase<OtherUnits, SignedSumsOn<RigidBodyBase>>>());
#elif defined(LINEARIZED_OF_PHYSICS_FEATURES)
static_assert(require_shape<OnBase<PhysicsFeatures, ResidualOutputs<LinearizedBase>, FourOf<PhysicsFeatures>>>());
#endif

#ifdef RESIDUAL_SEES_TOO_MUCH
constexpr int wrong = Masked<Network<float, InputSize<inputs>, Dense<4>>, inputs, 3>::outputs;
#elif defined(WITHHELD_TWICE)
constexpr int wrong = Masked<Residual, inputs, 3, 5>::outputs;
#elif defined(BASE_SEES_THE_TURNING)
struct Turning : RigidBodyBase {
  static constexpr std::array<ReadFeature, 2> reads = {{{2, "s_z", "m/s^2"}, {4, "wdot_y", "rad/s^2"}}};
};
constexpr int wrong = SignedSumsOn<Turning>::size;
#elif defined(BASE_SAYS_NOTHING)
struct Silent {
  static constexpr const char* description = "Silent";
};
constexpr int wrong = SignedSumsOn<Silent>::size;
#elif defined(BASE_WITHOUT_SLOPES)
struct Slopeless : RigidBodyBase {
  static void slopes() noexcept;
};
constexpr int wrong = ResidualOutputs<Slopeless>::size;
#elif defined(NO_ANGULAR_ACCELERATION)
constexpr int wrong = MonotoneBase<Joined<SpecificForce, BodyRates>>::outputs;
#else
constexpr int wrong = 0;
#endif

}  // namespace

int main() { return wrong; }
