// SPDX-License-Identifier: MIT
// CASE NO_OUTPUT_CHECK: pinnquad: a Guard needs FiniteOutputs: without it the NaN of a broken weight would reach a motor
// CASE NO_GUARD_AT_ALL: pinnquad: a Guard needs FiniteOutputs
// CASE NO_INPUT_CHECK: pinnquad: a Guard without FiniteInputs needs TrainingEnvelope
// CASE TWICE: pinnquad: a policy of a Guard is named twice
// CASE TWO_LIMITS: pinnquad: a policy of a Guard is named twice
// CASE NOT_A_POLICY: pinnquad: this type is not a policy of a Guard
// CASE LIMITS_REVERSED: pinnquad: a Guard's lower command limit lies above the upper one
// CASE CLIPS_TO_INFINITY: pinnquad: a Guard's command limits must be numbers
// CASE CLIPS_TO_NAN: pinnquad: a Guard's command limits must be numbers
// CASE REFUSES_INFINITY: pinnquad: a Guard's command limits must be numbers
// CASE CLIPS_REVERSED: pinnquad: a Guard's lower command limit lies above the upper one
// CASE CLIPS_BEYOND_FLOAT: pinnquad: a Guard's command limits must be numbers of the model's Scalar
// CASE FALLBACK_MAY_THROW: pinnquad: a fallback's call must be noexcept
// CASE DISTANCE_LIMIT_INFINITE: pinnquad: the distance limit of a JointDistance must be a positive number
// CASE DISTRIBUTION_OF_FEWER: pinnquad: the distribution of a JointDistance has another size than the model's features
// CASE TWO_DISTRIBUTIONS: pinnquad: a policy of a Guard is named twice
// CASE DISTRIBUTION_OF_OTHER_DATA: pinnquad: the distribution of a JointDistance is that of other training data than the model's
// CASE NOT_A_GUARD: pinnquad: the second argument of InverseDynamics is a Guard
// CASE FALLBACK_OF_OTHER_INPUTS: pinnquad: this fallback can't be asked with the model's inputs, or must be told place and time
// CASE FALLBACK_NEEDS_TIME: pinnquad: this fallback can't be asked with the model's inputs, or must be told place and time
// CASE GROUND_WITHOUT_HEIGHT: pinnquad: an effect of this vehicle depends on height, place or time, which these inputs don't say
// CASE GUST_WITHOUT_TIME: pinnquad: an effect of this vehicle depends on place or time, which these inputs don't say
// CASE COMMANDS_OF_THREE: deleted.*predict
// CASE COMMANDS_IN_DOUBLE: deleted.*predict
#include <limits>

#include "../support/small_model.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/inference/analytic_inverse.hpp"

namespace {

using namespace pinnquad;

struct Reversed {
  static constexpr double lower = 1.0;
  static constexpr double upper = 0.0;
};

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

/// Of so many features.
template <int Size, int Limit>
struct Distribution {
  static constexpr std::array<float, std::size_t(Size)> distribution_mean{};
  static constexpr std::array<float, std::size_t(Size) * (Size + 1) / 2> whitening{};
  static constexpr double squared_distance_limit = Limits<0, Limit>::upper;
};

struct OtherData : Distribution<16, 1> {
  static constexpr std::uint64_t training_data_hash = 2;
};

struct MayThrow {
  Status operator()(const MotionInputs<float>&, Commands<float>&) const { return Status::no_solution; }
};

struct OtherInputs {
  Status operator()(const State<float>&, Commands<float>&) const noexcept { return Status::ok; }
};

struct NeedsTime {
  Status operator()(const MotionInputs<float>&, const PlaceAndTime<float>&, Commands<float>&) const noexcept {
    return Status::ok;
  }
};

using NearGround = Quadrotor<float, GroundEffect<Conyers>>;
using InGusts = Quadrotor<float, GroundEffect<Conyers>, PeriodicWind>;

#if defined(NO_OUTPUT_CHECK)
using Policies = Guard<FiniteInputs, TrainingEnvelope, ClipCommands<>>;
#elif defined(NO_GUARD_AT_ALL)
using Policies = Guard<>;
#elif defined(NO_INPUT_CHECK)
using Policies = Guard<FiniteOutputs>;
#elif defined(TWICE)
using Policies = Extend<TrainingGuard, FiniteInputs>;
#elif defined(TWO_LIMITS)
using Policies = Extend<TrainingGuard, ClipCommands<>, ClipCommands<Reversed>>;
#elif defined(NOT_A_POLICY)
using Policies = Extend<TrainingGuard, int>;
#elif defined(LIMITS_REVERSED)
using Policies = Extend<TrainingGuard, RefuseCommands<Reversed>>;
#elif defined(CLIPS_TO_INFINITY)
using Policies = Extend<TrainingGuard, ClipCommands<Limits<0, 2>>>;
#elif defined(CLIPS_TO_NAN)
using Policies = Extend<TrainingGuard, ClipCommands<Limits<3, 1>>>;
#elif defined(REFUSES_INFINITY)
using Policies = Extend<TrainingGuard, RefuseCommands<Limits<0, 2>>>;
#elif defined(CLIPS_REVERSED)
using Policies = Extend<TrainingGuard, ClipCommands<Reversed>>;
#elif defined(CLIPS_BEYOND_FLOAT)
using Policies = Extend<TrainingGuard, ClipCommands<Limits<0, 4>>>;
#elif defined(DISTANCE_LIMIT_INFINITE)
using Policies = Extend<TrainingGuard, JointDistance<Distribution<16, 2>>>;
#elif defined(DISTRIBUTION_OF_FEWER)
using Policies = Extend<TrainingGuard, JointDistance<Distribution<15, 1>>>;
#elif defined(TWO_DISTRIBUTIONS)
using Policies = Extend<TrainingGuard, JointDistance<Distribution<16, 1>>, JointDistance<Distribution<15, 1>>>;
#elif defined(DISTRIBUTION_OF_OTHER_DATA)
using Policies = Extend<TrainingGuard, JointDistance<OtherData>>;
#elif defined(FALLBACK_MAY_THROW)
using Policies = Extend<TrainingGuard, Fallback<MayThrow>>;
#elif defined(NOT_A_GUARD)
using Policies = FiniteOutputs;
#elif defined(FALLBACK_OF_OTHER_INPUTS)
using Policies = Extend<TrainingGuard, Fallback<OtherInputs>>;
#elif defined(FALLBACK_NEEDS_TIME)
using Policies = Extend<TrainingGuard, Fallback<NeedsTime>>;
#elif defined(GROUND_WITHOUT_HEIGHT)
using Policies = Extend<TrainingGuard, Fallback<AnalyticInverse<NearGround>>>;
#else
using Policies = Extend<TrainingGuard, RefuseCommands<>, ClipCommands<>, JointDistance<Distribution<16, 1>>,
                        Fallback<AnalyticInverse<Quadrotor<float>>>>;
#endif

template <class Vehicle>
AnalyticInverse<Vehicle> by_formula() {
  return AnalyticInverse<Vehicle>(Vehicle(airframe_value<PaperQuadrotor, float>()));
}

}  // namespace

int main() {
#if defined(GROUND_WITHOUT_HEIGHT)
  const Policies guard(by_formula<NearGround>());
#elif defined(FALLBACK_OF_OTHER_INPUTS) || defined(FALLBACK_NEEDS_TIME) || defined(NO_OUTPUT_CHECK) ||              \
    defined(NO_GUARD_AT_ALL) || defined(NO_INPUT_CHECK) || defined(TWICE) || defined(TWO_LIMITS) ||                 \
    defined(NOT_A_POLICY) || defined(LIMITS_REVERSED) || defined(NOT_A_GUARD) || defined(CLIPS_TO_INFINITY) ||      \
    defined(CLIPS_TO_NAN) || defined(REFUSES_INFINITY) || defined(CLIPS_REVERSED) || defined(CLIPS_BEYOND_FLOAT) || \
    defined(FALLBACK_MAY_THROW) || defined(DISTANCE_LIMIT_INFINITE) || defined(DISTRIBUTION_OF_FEWER) ||            \
    defined(TWO_DISTRIBUTIONS) || defined(DISTRIBUTION_OF_OTHER_DATA)
  const Policies guard{};
#else
  const Policies guard(by_formula<Quadrotor<float>>());
#endif
  const InverseDynamics<test::SmallModel, Policies> inverse(guard);
#if defined(COMMANDS_OF_THREE)
  std::array<float, 3> commands{};
#elif defined(COMMANDS_IN_DOUBLE)
  Commands<double> commands{};
#else
  Commands<float> commands{};
#endif
  Status status = inverse.predict({}, commands);
#if defined(GUST_WITHOUT_TIME)
  status = by_formula<InGusts>()(MotionInputsWithAltitude<float>{}, commands);
#else
  status = by_formula<NearGround>()(MotionInputsWithAltitude<float>{}, commands);
  status = by_formula<InGusts>()(MotionInputs<float>{}, PlaceAndTime<float>{}, commands);
#endif
  return has_output(status) ? static_cast<int>(sizeof(OtherInputs) + sizeof(NeedsTime) + sizeof(Reversed)) : 0;
}
