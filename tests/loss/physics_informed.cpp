// SPDX-License-Identifier: MIT
// Eq. (5): the weighted sum.
#include "pinnquad/loss/physics_informed.hpp"

#include <doctest/doctest.h>

#include <random>

#include "pinnquad/schedule/schedule.hpp"
#include "support/loss_batches.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {

using PaperContext = Context<PaperFeatures, PaperQuadrotor>;
using Gradient = PaperBatch<double>::Gradient;

/// The same terms summed in another order: a few ulp of values of order 1.
constexpr double sum_tolerance = 1e-14;

struct Outcome {
  double value;
  Gradient gradient;
};

template <class Loss>
Outcome outcome(const Loss& loss, const PaperContext& context, const PaperBatch<double>& batch) {
  Outcome result;
  result.gradient.setZero(4, batch.size());
  result.value = loss.evaluate(context, batch, 1.0, result.gradient);
  return result;
}

struct NotALoss {};
struct ReturnsNothing {
  template <class ContextType, class Batch, class GradientType>
  void evaluate(const ContextType&, const Batch&, typename Batch::Scalar, GradientType&) const {}
};

/// Doubles what is in the gradient and adds its number: the result tells in which order the terms came.
template <int Number>
struct Doubling {
  template <class ContextType, class Batch, class GradientType>
  typename Batch::Scalar evaluate(const ContextType&, const Batch&, typename Batch::Scalar, GradientType& g) const {
    g = g * 2.0 + GradientType::Constant(g.rows(), g.cols(), Number);
    return 0;
  }
};

}  // namespace

TEST_CASE("base and terms add to the gradient in the order in which they are named, whatever the compiler") {
  std::mt19937_64 engine(64);
  const auto context = flight_context<PaperContext>();
  const auto batch = random_batch<double>(5, engine);
  const PhysicsInformed<Doubling<1>, Weighted<Doubling<2>, Constant>, Weighted<Doubling<3>, Constant>,
                        Weighted<Doubling<4>, Constant>>
      loss{};
  CHECK(outcome(loss, context, batch).gradient(0, 0) == ((1 * 2 + 2) * 2 + 3) * 2 + 4);
}

TEST_CASE("what is a loss") {
  CHECK(is_loss<Mse>);
  CHECK(is_loss<LocalMonotonicity<Roll>>);
  CHECK(is_loss<LocalMonotonicity<Yaw, Literal>>);
  CHECK(is_loss<PhysicsInformed<Mse>>);
  CHECK(is_loss<PaperLoss<CyclicalAnnealing>>);
  CHECK_FALSE(is_loss<NotALoss>);
  CHECK_FALSE(is_loss<ReturnsNothing>);
  CHECK_FALSE(is_loss<Constant>);
  CHECK_FALSE(is_loss<int>);
}

TEST_CASE("the paper's loss is Mse + lambda (roll + pitch + yaw), lambda by the schedule, value and gradient") {
  std::mt19937_64 engine(61);
  auto context = flight_context<PaperContext>();
  const auto batch = random_batch<double>(33, engine);
  const auto base = outcome(Mse{}, context, batch);
  const auto roll = outcome(LocalMonotonicity<Roll>{}, context, batch);
  const auto pitch = outcome(LocalMonotonicity<Pitch>{}, context, batch);
  const auto yaw = outcome(LocalMonotonicity<Yaw>{}, context, batch);
  for (const int epoch : {0, 30, 45, 59, 60}) {
    context.progress = {epoch, 300};
    const double lambda = CyclicalAnnealing{}.weight(epoch, 300);
    const auto sum = outcome(PaperLoss<CyclicalAnnealing>{}, context, batch);
    CHECK(std::fabs(sum.value - (base.value + lambda * (roll.value + pitch.value + yaw.value))) <= sum_tolerance);
    const Gradient expected = base.gradient + lambda * (roll.gradient + pitch.gradient + yaw.gradient);
    CHECK((sum.gradient - expected).cwiseAbs().maxCoeff() <= sum_tolerance);
  }
}

TEST_CASE("each axis has a schedule of its own") {
  std::mt19937_64 engine(62);
  const auto context = flight_context<PaperContext>();
  const auto batch = random_batch<double>(9, engine);
  PhysicsInformed<Mse, Weighted<LocalMonotonicity<Roll>, Constant>, Weighted<LocalMonotonicity<Yaw>, Constant>> loss{};
  std::get<0>(loss.terms).schedule.value = 0.3;
  std::get<1>(loss.terms).schedule.value = 0.0;
  const auto base = outcome(Mse{}, context, batch), roll = outcome(LocalMonotonicity<Roll>{}, context, batch);
  CHECK(std::fabs(outcome(loss, context, batch).value - (base.value + 0.3 * roll.value)) <= sum_tolerance);
  std::get<0>(loss.terms).schedule.value = 0.0;
  std::get<1>(loss.terms).schedule.value = 2.0;
  const auto yaw = outcome(LocalMonotonicity<Yaw>{}, context, batch);
  CHECK(std::fabs(outcome(loss, context, batch).value - (base.value + 2.0 * yaw.value)) <= sum_tolerance);
}

TEST_CASE("without terms, or with weights of zero, it is its base") {
  std::mt19937_64 engine(63);
  const auto context = flight_context<PaperContext>();
  const auto batch = random_batch<double>(5, engine);
  const auto base = outcome(Mse{}, context, batch);
  CHECK(outcome(PhysicsInformed<Mse>{}, context, batch).value == base.value);
  PhysicsInformed<Mse, Weighted<LocalMonotonicity<Pitch>, Constant>> loss{};
  std::get<0>(loss.terms).schedule.value = 0.0;
  const auto none = outcome(loss, context, batch);
  CHECK(none.value == base.value);
  CHECK(none.gradient == base.gradient);
}

TEST_CASE("a sum of losses is a loss: it nests, and its weight multiplies through") {
  std::mt19937_64 engine(64);
  const auto context = flight_context<PaperContext>();
  const auto batch = random_batch<double>(7, engine);
  using Inner = PhysicsInformed<Mse, Weighted<LocalMonotonicity<Roll>, Constant>>;
  PhysicsInformed<Mse, Weighted<Inner, Constant>> outer{};
  std::get<0>(outer.terms).schedule.value = 0.5;
  const auto base = outcome(Mse{}, context, batch), inner = outcome(Inner{}, context, batch);
  const auto nested = outcome(outer, context, batch);
  CHECK(std::fabs(nested.value - (base.value + 0.5 * inner.value)) <= sum_tolerance);
  CHECK((nested.gradient - (base.gradient + 0.5 * inner.gradient)).cwiseAbs().maxCoeff() <= sum_tolerance);
}
