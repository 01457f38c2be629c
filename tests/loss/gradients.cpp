// SPDX-License-Identifier: MIT
// Every loss in every context: its gradient against central differences, in double.
#include <doctest/doctest.h>

#include <random>
#include <vector>

#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/outputs/wrench_outputs.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "support/central_difference.hpp"
#include "support/loss_batches.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {

/// A loss as a user writes it: no term of the library, gradient of a single entry per sample.
struct QuarticFirstOutput {
  template <class ContextType, class Batch, class Gradient>
  typename Batch::Scalar evaluate(const ContextType&, const Batch& batch, typename Batch::Scalar weight,
                                  Gradient& gradient) const {
    using Scalar = typename Batch::Scalar;
    Scalar sum(0);
    for (int i = 0; i < batch.size(); ++i) {
      const Scalar v = batch.prediction(0, i);
      sum += v * v * v * v;
      gradient(0, i) += weight * Scalar(4) * v * v * v;
    }
    return sum;
  }
};

/// Terms with weights far apart, so that one in the wrong place shows.
struct FarApart : PhysicsInformed<Mse, Weighted<LocalMonotonicity<Roll>, CyclicalAnnealing>,
                                  Weighted<LocalMonotonicity<Pitch>, Constant>,
                                  Weighted<LocalMonotonicity<Yaw>, CyclicalAnnealing>> {
  FarApart() {
    std::get<0>(terms).schedule = {0.7, 5, 0.2};
    std::get<1>(terms).schedule.value = 3.0;
    std::get<1>(terms).loss.gain = 0.4;
    std::get<2>(terms).schedule.maximum = 11.0;
  }
};

/// Of two samples the correlation is 1 or -1: no slope to compare.
template <class Loss>
constexpr bool flat_on_a_pair = false;
template <class Axis>
constexpr bool flat_on_a_pair<PearsonCorrelation<Axis>> = true;

template <class Loss, class ContextType>
void check_gradient(const Loss& loss, ContextType context) {
  static_assert(pinnquad::is_loss<Loss>);
  constexpr int outputs = ContextType::output_count;
  using Batch = PaperBatch<double, outputs>;
  context.progress = {13, 20};
  std::mt19937_64 engine(71);
  for (const int size : {1, 2, 3, 5, 40, 63, 64}) {
    if (size == 2 && flat_on_a_pair<Loss>) continue;
    for (const double weight : {1.0, -0.25}) {
      CAPTURE(size);
      CAPTURE(weight);
      auto batch = random_batch<double, outputs>(size, engine);
      batch.prediction *= 0.3;  // steps that are not saturated: a slope to see
      batch.features *= 0.3;
      typename Batch::Gradient before, gradient;
      before.setZero(outputs, size);
      for (Eigen::Index i = 0; i < before.size(); ++i) before.data()[i] = pinnquad::standard_normal(engine);
      gradient = before;
      const double value = loss.evaluate(context, batch, weight, gradient);
      const typename Batch::Gradient added = gradient - before;  // a loss adds to the gradient
      const auto count = static_cast<std::size_t>(batch.prediction.size());
      auto numerical = central_differences(
          [&] {
            typename Batch::Gradient unused;
            unused.setZero(outputs, size);
            return loss.evaluate(context, batch, weight, unused);
          },
          batch.prediction.data(), count);
      for (double& v : numerical) v *= weight;  // the value is the loss itself, the gradient is weighted
      CHECK(gradient_error(added.data(), numerical.data(), count) <= gradient_tolerance);
      typename Batch::Gradient unused;
      unused.setZero(outputs, size);
      CHECK(loss.evaluate(context, batch, 0.0, unused) == value);
      CHECK(unused.cwiseAbs().maxCoeff() == 0.0);
    }
  }
}

}  // namespace

TEST_CASE_TEMPLATE("gradient of every loss", Loss, Mse, LocalMonotonicity<Roll>, LocalMonotonicity<Pitch>,
                   LocalMonotonicity<Yaw>, LocalMonotonicity<Roll, Literal>, LocalMonotonicity<Pitch, Match>,
                   PaperLoss<Constant, Match>, PaperLoss<Constant, Literal>, PaperLoss<CyclicalAnnealing>,
                   PaperLoss<Constant>, FarApart, PhysicsInformed<Mse>, PearsonCorrelation<Roll>,
                   PearsonCorrelation<Yaw>, QuarticFirstOutput) {
  SUBCASE("commands") {
    check_gradient(Loss{}, flight_context<Context<PaperFeatures, PaperQuadrotor, CommandOutputs>>());
  }
  SUBCASE("rotor speeds") {
    check_gradient(Loss{}, flight_context<Context<PaperFeatures, PaperQuadrotor, RotorSpeedOutputs>>());
  }
  SUBCASE("six accelerations") {
    check_gradient(Loss{}, flight_context<Context<PaperFeatures, PaperQuadrotor, AccelerationOutputs>>());
  }
  SUBCASE("a residual on another inverse") {
    using Residual = ResidualOutputs<LinearizedBase>;
    auto context = flight_context<Context<PaperFeatures, PaperQuadrotor, Residual>>();
    context.input.standard_deviation.fill(0.05);  // motions whose commands by the base leave the steps a slope
    check_gradient(Loss{}, context);
  }
}
