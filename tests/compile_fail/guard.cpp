// SPDX-License-Identifier: MIT
// CASE NO_OUTPUT_CHECK: pinnquad: a Guard needs FiniteOutputs: without it the NaN of a broken weight would reach a motor
// CASE NO_GUARD_AT_ALL: pinnquad: a Guard needs FiniteOutputs
// CASE NO_INPUT_CHECK: pinnquad: a Guard without FiniteInputs needs TrainingEnvelope
// CASE CLAMPS_UNCHECKED: pinnquad: ClampToEnvelope needs FiniteInputs
// CASE REFUSES_AND_CLAMPS: pinnquad: a Guard either refuses what is outside the envelope or clamps it, not both
// CASE TWICE: pinnquad: a policy of a Guard is named twice
// CASE TWO_LIMITS: pinnquad: a policy of a Guard is named twice
// CASE NOT_A_POLICY: pinnquad: this type is not a policy of a Guard
// CASE LIMITS_REVERSED: pinnquad: a Guard's lower command limit lies above the upper one
// CASE NOT_A_GUARD: pinnquad: the second argument of InverseDynamics is a Guard
// CASE FALLBACK_OF_OTHER_INPUTS: pinnquad: this fallback can't be asked with the model's inputs, or must be told place and time
// CASE FALLBACK_NEEDS_TIME: pinnquad: this fallback can't be asked with the model's inputs, or must be told place and time
// CASE GROUND_WITHOUT_HEIGHT: pinnquad: an effect of this vehicle depends on height, place or time, which these inputs don't say
// CASE GUST_WITHOUT_TIME: pinnquad: an effect of this vehicle depends on place or time, which these inputs don't say
#include "../support/small_model.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/inference/analytic_inverse.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"

namespace {

using namespace pinnquad;

struct Reversed {
  static constexpr double lower = 1.0;
  static constexpr double upper = 0.0;
};

struct OtherInputs {
  Status operator()(const State<float>&, Commands<float>&) const noexcept { return Status::ok; }
};

struct NeedsTime {
  Status operator()(const MotionInputs<float>&, const PlaceAndTime<float>&, Commands<float>&) const noexcept {
    return Status::ok;
  }
};

using NearGround = Quadrotor<float, ConyersGroundEffect>;
using InGusts = Quadrotor<float, ConyersGroundEffect, PeriodicWind>;

#if defined(NO_OUTPUT_CHECK)
using Policies = Guard<FiniteInputs, TrainingEnvelope, ClipCommands<>>;
#elif defined(NO_GUARD_AT_ALL)
using Policies = Guard<>;
#elif defined(NO_INPUT_CHECK)
using Policies = Guard<FiniteOutputs>;
#elif defined(CLAMPS_UNCHECKED)
using Policies = Guard<ClampToEnvelope, FiniteOutputs>;
#elif defined(REFUSES_AND_CLAMPS)
using Policies = Extend<TrainingGuard, ClampToEnvelope>;
#elif defined(TWICE)
using Policies = Extend<TrainingGuard, FiniteInputs>;
#elif defined(TWO_LIMITS)
using Policies = Extend<TrainingGuard, ClipCommands<>, ClipCommands<Reversed>>;
#elif defined(NOT_A_POLICY)
using Policies = Extend<TrainingGuard, int>;
#elif defined(LIMITS_REVERSED)
using Policies = Extend<TrainingGuard, RefuseCommands<Reversed>>;
#elif defined(NOT_A_GUARD)
using Policies = FiniteOutputs;
#elif defined(FALLBACK_OF_OTHER_INPUTS)
using Policies = Extend<TrainingGuard, Fallback<OtherInputs>>;
#elif defined(FALLBACK_NEEDS_TIME)
using Policies = Extend<TrainingGuard, Fallback<NeedsTime>>;
#elif defined(GROUND_WITHOUT_HEIGHT)
using Policies = Extend<TrainingGuard, Fallback<AnalyticInverse<NearGround>>>;
#else
using Policies = Extend<TrainingGuard, RefuseCommands<>, ClipCommands<>, Fallback<AnalyticInverse<Quadrotor<float>>>>;
#endif

template <class Vehicle>
AnalyticInverse<Vehicle> by_formula() {
  return AnalyticInverse<Vehicle>(Vehicle(airframe_value<PaperQuadrotor, float>()));
}

}  // namespace

int main() {
#if defined(GROUND_WITHOUT_HEIGHT)
  const Policies guard(by_formula<NearGround>());
#elif defined(FALLBACK_OF_OTHER_INPUTS) || defined(FALLBACK_NEEDS_TIME) || defined(NO_OUTPUT_CHECK) ||                 \
    defined(NO_GUARD_AT_ALL) || defined(NO_INPUT_CHECK) || defined(CLAMPS_UNCHECKED) || defined(REFUSES_AND_CLAMPS) || \
    defined(TWICE) || defined(TWO_LIMITS) || defined(NOT_A_POLICY) || defined(LIMITS_REVERSED) || defined(NOT_A_GUARD)
  const Policies guard{};
#else
  const Policies guard(by_formula<Quadrotor<float>>());
#endif
  const InverseDynamics<test::SmallModel, Policies> inverse(guard);
  Commands<float> commands{};
  Status status = inverse.predict({}, commands);
#if defined(GUST_WITHOUT_TIME)
  status = by_formula<InGusts>()(MotionInputsWithAltitude<float>{}, commands);
#else
  status = by_formula<NearGround>()(MotionInputsWithAltitude<float>{}, commands);
  status = by_formula<InGusts>()(MotionInputs<float>{}, PlaceAndTime<float>{}, commands);
#endif
  return has_output(status) ? static_cast<int>(sizeof(OtherInputs) + sizeof(NeedsTime) + sizeof(Reversed)) : 0;
}
