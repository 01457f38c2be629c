// SPDX-License-Identifier: MIT
// The forms of the local monotonicity loss: literal as Algorithm 1 prints it, and the match of steps.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <random>
#include <vector>

#include "pinnquad/loss/local_monotonicity.hpp"
#include "support/loss_batches.hpp"
#include "support/sign_step.hpp"
#include "support/tolerances.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {

using Array = Eigen::ArrayXd;
using PaperContext = Context<PaperFeatures, PaperQuadrotor>;

template <class Form, class Step>
double compared(const Step& step, const Array& m, const Array& n) {
  Array gradient = Array::Zero(m.size());
  return Form::compare(step, m, n, 1.0, gradient);
}

template <class Loss>
double value(const Loss& loss, const PaperContext& context, const PaperBatch<double>& batch) {
  PaperBatch<double>::Gradient gradient;
  gradient.setZero(4, batch.size());
  return loss.evaluate(context, batch, 1.0, gradient);
}

/// Signed sum of the predicted commands and angular acceleration, physical units, the signs of Eq. (2) typed again.
struct Series {
  std::vector<double> m, n;
};
Series physical_series(const std::array<double, 4>& signs, int axis, const PaperContext& context,
                       const PaperBatch<double>& batch) {
  Series series;
  const auto feature = static_cast<std::size_t>(3 + axis);
  for (int sample = 0; sample < batch.size(); ++sample) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      sum += signs[i] * (batch.prediction(static_cast<int>(i), sample) * context.output.standard_deviation[i] +
                         context.output.mean[i]);
    }
    series.m.push_back(sum);
    series.n.push_back(batch.features(3 + axis, sample) * context.input.standard_deviation[feature] +
                       context.input.mean[feature]);
  }
  return series;
}

constexpr double printed_digits = 5e-5;  // docs/paper.md, deviation 8, gives four digits after the point

}  // namespace

TEST_CASE("footnote 2: Algorithm 1 as printed gives 0.7992 and 0.6106 (docs/paper.md, deviation 8)") {
  const Array x = array({1, 2, 3, 4, 5});
  const Array y1 = array({1, -2, -3, 4, 5}), y2 = array({1, 2, 3, 1.9455, 2.5});
  const TanhStep step = LocalMonotonicity<Roll, TanhStep, Literal>{}.step;
  CHECK(std::fabs(compared<Literal>(step, y1, x) - 0.7992) <= printed_digits);
  CHECK(std::fabs(compared<Literal>(step, y2, x) - 0.6106) <= printed_digits);
  CHECK(std::fabs(compared<Standardised>(step, y1, x) - 0.9991) <= printed_digits);
  CHECK(std::fabs(compared<Standardised>(step, y2, x) - 0.7632) <= printed_digits);
}

TEST_CASE("footnote 2: the match loss tells the two patterns apart as well, with the sign: 2 and 1") {
  const Array x = array({1, 2, 3, 4, 5});
  // of four steps, all up in x: two go down in the first series, one in the second; each costs (1 + 1)^2
  CHECK(compared<Match>(SignStep{}, array({1, -2, -3, 4, 5}), x) == 2.0);
  CHECK(compared<Match>(SignStep{}, array({1, 2, 3, 1.9455, 2.5}), x) == 1.0);
}

TEST_CASE("the gain a form begins with; one that is set stays") {
  CHECK(LocalMonotonicity<Roll>{}.step.gain == 3.0);
  CHECK((LocalMonotonicity<Roll, TanhStep, Literal>{}.step.gain == 1.0));
  CHECK((LocalMonotonicity<Roll, TanhStep, Match>{}.step.gain == 3.0));
  CHECK((LocalMonotonicity<Roll, TanhStep, Literal>{TanhStep{2.0}}.step.gain == 2.0));
}

TEST_CASE("literal: raw commands and rad/s^2, N_b - 1 terms over N_b, in every axis") {
  std::mt19937_64 engine(65);
  auto context = flight_context<PaperContext>();
  context.input.standard_deviation[3] = 11.0;
  context.input.standard_deviation[4] = 7.0;
  context.input.standard_deviation[5] = 0.9;
  context.input.mean[3] = 2.0;
  for (const int size : {1, 2, 3, 17, 64}) {
    const auto batch = random_batch<double>(size, engine);
    const auto plain = [&](const std::array<double, 4>& signs, int axis) {
      const Series s = physical_series(signs, axis, context, batch);
      double total = 0.0;
      for (std::size_t i = 0; i + 1 < s.m.size(); ++i) {
        total += 1.0 - std::tanh(s.m[i + 1] - s.m[i]) * std::tanh(s.n[i + 1] - s.n[i]);
      }
      return total / static_cast<double>(s.m.size());
    };
    const double tolerance = rounding<double>(1000);  // differences of values near 10 within sums of 4
    CHECK(std::fabs(value(LocalMonotonicity<Roll, TanhStep, Literal>{}, context, batch) - plain({-1, 1, 1, -1}, 0)) <=
          tolerance);
    CHECK(std::fabs(value(LocalMonotonicity<Pitch, TanhStep, Literal>{}, context, batch) - plain({1, -1, 1, -1}, 1)) <=
          tolerance);
    CHECK(std::fabs(value(LocalMonotonicity<Yaw, TanhStep, Literal>{}, context, batch) - plain({1, 1, -1, -1}, 2)) <=
          tolerance);
  }
}

TEST_CASE("match: squared difference of the steps of the standardised series, mean over the pairs") {
  std::mt19937_64 engine(66);
  const auto context = flight_context<PaperContext>();  // scaler of the inputs: identity
  for (const int size : {1, 2, 3, 17, 64}) {
    const auto batch = random_batch<double>(size, engine);
    const Series s = physical_series({1, -1, 1, -1}, 1, context, batch);
    double total = 0.0;
    for (std::size_t i = 0; i + 1 < s.m.size(); ++i) {
      const double step_m = std::tanh(3.0 * (s.m[i + 1] - s.m[i]) / context.signed_sum_deviation[1]);
      const double difference = step_m - std::tanh(3.0 * (s.n[i + 1] - s.n[i]));
      total += difference * difference;
    }
    const double expected = size > 1 ? total / (size - 1) : 0.0;
    CHECK(std::fabs(value(LocalMonotonicity<Pitch, TanhStep, Match>{}, context, batch) - expected) <=
          rounding<double>(1000));
  }
}

TEST_CASE("match: 0 for equal series, 4 for steep opposed ones, 1 for one that stands still") {
  const Array steep = array({0, 100, 300, 350, 900}), still = array({4, 4, 4, 4, 4});
  CHECK(compared<Match>(TanhStep{}, steep, steep) == 0.0);
  CHECK(compared<Match>(TanhStep{}, steep, Array(-steep)) == 4.0);
  CHECK(compared<Match>(TanhStep{}, still, steep) == 1.0);
}
