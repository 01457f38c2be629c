// SPDX-License-Identifier: MIT
// CASE WEIGHTED_NOT_A_LOSS: pinnquad: Weighted's first argument is not a loss
// CASE WEIGHTED_NOT_A_SCHEDULE: pinnquad: Weighted's second argument is not a schedule
// CASE SCHEDULE_MAY_THROW: pinnquad: Weighted's second argument is not a schedule. it needs weight.epoch, epochs. const noexcept
// CASE BASE_NOT_A_LOSS: pinnquad: PhysicsInformed's first argument is not a loss
// CASE ARGUMENTS_SWAPPED: pinnquad: Weighted's first argument is not a loss
// CASE TERM_NOT_WEIGHTED: pinnquad: a term of PhysicsInformed is not Weighted
// CASE CONTEXT_NOT_A_FEATURE_SET: pinnquad: Context's first argument is not a feature set
// CASE CONTEXT_NOT_AN_AIRFRAME: pinnquad: Context's second argument is not an airframe
// CASE CONTEXT_NOT_A_SCHEMA: pinnquad: Context's third argument is not an output schema
// CASE FORM_AS_STEP: pinnquad: LocalMonotonicity's second argument is not a step function
// CASE NOT_A_FORM: pinnquad: LocalMonotonicity's third argument is not a form
// CASE NO_ANGULAR_ACCELERATION: pinnquad: LocalMonotonicity and PearsonCorrelation need a feature set that holds the angular accelerations
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/loss/context.hpp"
#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/schedule/schedule.hpp"

namespace {

using pinnquad::Constant;
using pinnquad::Context;
using pinnquad::LocalMonotonicity;
using pinnquad::Mse;
using pinnquad::PaperFeatures;
using pinnquad::PaperQuadrotor;
using pinnquad::PhysicsInformed;
using pinnquad::Roll;
using pinnquad::Weighted;

struct Nothing {};

struct MayThrow {
  double weight(int, int) const { return 0.1; }
};

/// A feature set without angular accelerations.
struct VelocitiesOnly : PaperFeatures {
  static constexpr int angular_acceleration = -1;
};

#if defined(WEIGHTED_NOT_A_LOSS)
using Loss = PhysicsInformed<Mse, Weighted<Nothing, Constant>>;
#elif defined(WEIGHTED_NOT_A_SCHEDULE)
using Loss = PhysicsInformed<Mse, Weighted<LocalMonotonicity<Roll>, Nothing>>;
#elif defined(SCHEDULE_MAY_THROW)
using Loss = PhysicsInformed<Mse, Weighted<LocalMonotonicity<Roll>, MayThrow>>;
#elif defined(BASE_NOT_A_LOSS)
using Loss = PhysicsInformed<Nothing, Weighted<LocalMonotonicity<Roll>, Constant>>;
#elif defined(TERM_NOT_WEIGHTED)
using Loss = PhysicsInformed<Mse, LocalMonotonicity<Roll>>;
#elif defined(FORM_AS_STEP)
using Loss = PhysicsInformed<Mse, Weighted<LocalMonotonicity<Roll, pinnquad::Literal>, Constant>>;
#elif defined(NOT_A_FORM)
using Loss = PhysicsInformed<Mse, Weighted<LocalMonotonicity<Roll, pinnquad::TanhStep, Nothing>, Constant>>;
#elif defined(ARGUMENTS_SWAPPED)
using Loss = PhysicsInformed<Mse, Weighted<Constant, LocalMonotonicity<Roll>>>;
#else
using Loss = PhysicsInformed<Mse, Weighted<LocalMonotonicity<Roll>, Constant>>;
#endif

#if defined(CONTEXT_NOT_A_FEATURE_SET)
using Knowledge = Context<Nothing, PaperQuadrotor>;
#elif defined(CONTEXT_NOT_AN_AIRFRAME)
using Knowledge = Context<PaperFeatures, Nothing>;
#elif defined(CONTEXT_NOT_A_SCHEMA)
using Knowledge = Context<PaperFeatures, PaperQuadrotor, Nothing>;
#elif defined(NO_ANGULAR_ACCELERATION)
using Knowledge = Context<VelocitiesOnly, PaperQuadrotor>;
#else
using Knowledge = Context<PaperFeatures, PaperQuadrotor>;
#endif

}  // namespace

int main() {
  using Batch = pinnquad::detail::LossBatch<double, 16, 4, 8>;
  Batch batch;
  batch.resize(2);
  Batch::Gradient gradient;
  gradient.setZero(4, 2);
  return static_cast<int>(Loss{}.evaluate(Knowledge{}, batch, 1.0, gradient)) +
         static_cast<int>(sizeof(Nothing) + sizeof(VelocitiesOnly) + sizeof(MayThrow));
}
