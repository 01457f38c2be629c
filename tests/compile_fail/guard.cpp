// SPDX-License-Identifier: MIT
#include <limits>

#include "../support/small_model.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/inference/analytic_inverse.hpp"

using namespace pinnquad;

/// Limits of commands: 2 stands for infinity, 3 for NaN, 4 for more than a float holds.
template <int Lower, int Upper>
struct Limits {
  static constexpr double value(int of) {
    return of == 2   ? std::numeric_limits<double>::infinity()
           : of == 3 ? std::numeric_limits<double>::quiet_NaN()
           : of == 4 ? 1e300
                     : double(of);
  }
  static constexpr double lower = value(Lower), upper = value(Upper);
};
using Reversed = Limits<1, 0>;

/// Of so many features.
template <int Size, int Limit>
struct Distribution {
  static constexpr std::array<float, std::size_t(Size)> distribution_mean{};
  static constexpr std::array<float, std::size_t(Size) * (Size + 1) / 2> whitening{};
  static constexpr double squared_distance_limit = Limits<0, Limit>::upper;
};

using NearGround = Quadrotor<float, GroundEffect<Conyers>>;
using InGusts = Quadrotor<float, GroundEffect<Conyers>, PeriodicWind>;

template <class Vehicle>
AnalyticInverse<Vehicle> by_formula() {
  return AnalyticInverse<Vehicle>(Vehicle(airframe_value<PaperQuadrotor, float>()));
}

template <class Policies, class Asked = Commands<float>>
Status guarded(const Policies& guard = {}) {
  const InverseDynamics<test::SmallModel, Policies> inverse(guard);
  Asked commands{};
  return inverse.predict({}, commands);
}
template <class... Policies>
Status extended() {
  return guarded<Extend<TrainingGuard, Policies...>>();
}

// SOUND
using Policies = Extend<TrainingGuard, RefuseCommands<>, ClipCommands<>, JointDistance<Distribution<16, 1>>,
                        Fallback<AnalyticInverse<Quadrotor<float>>>>;
const auto status = guarded<Policies>(Policies(by_formula<Quadrotor<float>>()));
Commands<float> commands{};
const auto near = by_formula<NearGround>()(MotionInputsWithAltitude<float>{}, commands);
const auto in_gusts = by_formula<InGusts>()(MotionInputs<float>{}, PlaceAndTime<float>{}, commands);

// CASE NO_GUARD_AT_ALL: pinnquad: a Guard without FiniteInputs needs TrainingEnvelope
const auto status = guarded<Guard<>>();
// CASE NO_INPUT_CHECK: pinnquad: a Guard without FiniteInputs needs TrainingEnvelope
const auto status = guarded<Guard<ClipCommands<>>>();
// CASE TWICE: pinnquad: a policy of a Guard is named twice
const auto status = extended<FiniteInputs>();
// CASE TWO_LIMITS: pinnquad: a policy of a Guard is named twice
const auto status = extended<ClipCommands<>, ClipCommands<Reversed>>();
// CASE NOT_A_POLICY: pinnquad: this type is not a policy of a Guard
const auto status = extended<int>();
// CASE LIMITS_REVERSED: pinnquad: a Guard's lower command limit lies above the upper one
const auto status = extended<RefuseCommands<Reversed>>();
// CASE CLIPS_TO_INFINITY: pinnquad: a Guard's command limits must be numbers
const auto status = extended<ClipCommands<Limits<0, 2>>>();
// CASE REFUSES_INFINITY: pinnquad: a Guard's command limits must be numbers
const auto status = extended<RefuseCommands<Limits<0, 2>>>();
// CASE CLIPS_REVERSED: pinnquad: a Guard's lower command limit lies above the upper one
const auto status = extended<ClipCommands<Reversed>>();
// CASE CLIPS_BEYOND_FLOAT: pinnquad: a Guard's command limits must be numbers of the model's Scalar
const auto status = extended<ClipCommands<Limits<0, 4>>>();
// CASE FALLBACK_MAY_THROW: pinnquad: a fallback's call must be noexcept
struct MayThrow {
  Status operator()(const MotionInputs<float>&, Commands<float>&) const { return Status::no_solution; }
};
const auto status = extended<Fallback<MayThrow>>();
// CASE DISTANCE_LIMIT_INFINITE: pinnquad: the distance limit of a JointDistance must be a positive number
const auto status = extended<JointDistance<Distribution<16, 2>>>();
// CASE DISTRIBUTION_OF_FEWER: pinnquad: the distribution of a JointDistance has another size than the model's features
const auto status = extended<JointDistance<Distribution<15, 1>>>();
// CASE DISTRIBUTION_OF_OTHER_DATA: pinnquad: the distribution of a JointDistance is that of other training data than the model's
struct OtherData : Distribution<16, 1> {
  static constexpr std::uint64_t training_data_hash = 2;
};
const auto status = extended<JointDistance<OtherData>>();
// CASE NOT_A_GUARD: pinnquad: the second argument of InverseDynamics is a Guard
const auto status = guarded<FiniteInputs>();
// CASE FALLBACK_OF_OTHER_INPUTS: pinnquad: this fallback can't be asked with the model's inputs, or must be told place and time
struct OtherInputs {
  Status operator()(const State<float>&, Commands<float>&) const noexcept { return Status::ok; }
};
const auto status = extended<Fallback<OtherInputs>>();
// CASE FALLBACK_NEEDS_TIME: pinnquad: this fallback can't be asked with the model's inputs, or must be told place and time
struct NeedsTime {
  Status operator()(const MotionInputs<float>&, const PlaceAndTime<float>&, Commands<float>&) const noexcept {
    return Status::ok;
  }
};
const auto status = extended<Fallback<NeedsTime>>();
// CASE GROUND_WITHOUT_HEIGHT: pinnquad: an effect of this vehicle depends on height, place or time, which these inputs don't say
using Policies = Extend<TrainingGuard, Fallback<AnalyticInverse<NearGround>>>;
const auto status = guarded<Policies>(Policies(by_formula<NearGround>()));
// CASE GUST_WITHOUT_TIME: pinnquad: an effect of this vehicle depends on place or time, which these inputs don't say
Commands<float> commands{};
const auto status = by_formula<InGusts>()(MotionInputsWithAltitude<float>{}, commands);
// CASE COMMANDS_IN_DOUBLE: deleted.*predict
const auto status = guarded<TrainingGuard, Commands<double>>();
