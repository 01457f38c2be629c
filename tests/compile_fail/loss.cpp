// SPDX-License-Identifier: MIT
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/loss/context.hpp"
#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/schedule/schedule.hpp"

using namespace pinnquad;

struct Nothing {};

template <class Loss, class Knowledge = Context<PaperFeatures, PaperQuadrotor>>
double evaluated() {
  using Batch = detail::LossBatch<double, 16, 4, 8>;
  Batch batch;
  batch.resize(2);
  Batch::Gradient gradient;
  gradient.setZero(4, 2);
  return Loss{}.evaluate(Knowledge{}, batch, 1.0, gradient);
}
using Monotone = LocalMonotonicity<Roll>;
using Sound = PhysicsInformed<Mse, Weighted<Monotone, Constant>>;

// SOUND
const double loss = evaluated<Sound>();

// CASE WEIGHTED_NOT_A_LOSS: pinnquad: Weighted's first argument is not a loss
const double loss = evaluated<PhysicsInformed<Mse, Weighted<Nothing, Constant>>>();
// CASE WEIGHTED_NOT_A_SCHEDULE: pinnquad: Weighted's second argument is not a schedule
const double loss = evaluated<PhysicsInformed<Mse, Weighted<Monotone, Nothing>>>();
// CASE SCHEDULE_MAY_THROW: pinnquad: Weighted's second argument is not a schedule. it needs weight.epoch, epochs. const noexcept
struct MayThrow {
  double weight(int, int) const { return 0.1; }
};
const double loss = evaluated<PhysicsInformed<Mse, Weighted<Monotone, MayThrow>>>();
// CASE BASE_NOT_A_LOSS: pinnquad: PhysicsInformed's first argument is not a loss
const double loss = evaluated<PhysicsInformed<Nothing, Weighted<Monotone, Constant>>>();
// CASE TERM_NOT_WEIGHTED: pinnquad: a term of PhysicsInformed is not Weighted
const double loss = evaluated<PhysicsInformed<Mse, Monotone>>();
// CASE CONTEXT_NOT_A_FEATURE_SET: pinnquad: Context's first argument is not a feature set
const double loss = evaluated<Sound, Context<Nothing, PaperQuadrotor>>();
// CASE CONTEXT_NOT_AN_AIRFRAME: pinnquad: Context's second argument is not an airframe
const double loss = evaluated<Sound, Context<PaperFeatures, Nothing>>();
// CASE CONTEXT_NOT_A_SCHEMA: pinnquad: Context's third argument is not an output schema
const double loss = evaluated<Sound, Context<PaperFeatures, PaperQuadrotor, Nothing>>();
// CASE NOT_A_FORM: pinnquad: LocalMonotonicity's second argument is not a form
const double loss = evaluated<PhysicsInformed<Mse, Weighted<LocalMonotonicity<Roll, Nothing>, Constant>>>();
// CASE NO_ANGULAR_ACCELERATION: pinnquad: LocalMonotonicity and PearsonCorrelation need a feature set that holds the angular accelerations
struct VelocitiesOnly : PaperFeatures {
  static constexpr int angular_acceleration = -1;
};
const double loss = evaluated<Sound, Context<VelocitiesOnly, PaperQuadrotor>>();
