// SPDX-License-Identifier: MIT
// Algorithm 1, with the readings of docs/paper.md, deviations 8 and 9, and the forms of the loss: literal as it is
// printed, and the match of steps.
#include "pinnquad/loss/local_monotonicity.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numeric>
#include <random>
#include <vector>

#include "support/loss_batches.hpp"
#include "support/tolerances.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {

using Array = Eigen::ArrayXd;
using PaperContext = Context<PaperFeatures, PaperQuadrotor>;

/// The paper and docs/paper.md give four digits after the point.
constexpr double printed_digits = 5e-5;

/// With it the step is the sign, as footnote 2 of the paper has it.
constexpr double sign = 1e12;

template <class Form = Standardised>
double value(double gain, const Array& m, const Array& n) {
  Array gradient = Array::Zero(m.size());
  return Form::compare(gain, m, n, 1.0, gradient);
}

template <class Loss, class ContextType>
double value(const Loss& loss, const ContextType& context, const PaperBatch<double>& batch) {
  PaperBatch<double>::Gradient gradient;
  gradient.setZero(4, batch.size());
  return loss.evaluate(context, batch, 1.0, gradient);
}

/// Signed sum of the predicted commands and angular acceleration, physical units, the signs of Eq. (2) typed again.
struct Series {
  std::vector<double> m, n;

  /// Over all pairs.
  template <class Pair>
  double sum(const Pair& of) const {
    double total = 0.0;
    for (std::size_t i = 0; i + 1 < m.size(); ++i) total += of(m[i + 1] - m[i], n[i + 1] - n[i]);
    return total;
  }
};
constexpr std::array<double, 4> typed_signs[3] = {{-1, 1, 1, -1}, {1, -1, 1, -1}, {1, 1, -1, -1}};

template <class ContextType, class ToCommand>
Series physical_series(int axis, const ContextType& context, const PaperBatch<double>& batch,
                       const ToCommand& to_command) {
  Series series;
  const auto feature = static_cast<std::size_t>(3 + axis);
  for (int sample = 0; sample < batch.size(); ++sample) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      sum += typed_signs[axis][i] *
             to_command(batch.prediction(static_cast<int>(i), sample) * context.output.standard_deviation[i] +
                        context.output.mean[i]);
    }
    series.m.push_back(sum);
    series.n.push_back(batch.features(3 + axis, sample) * context.input.standard_deviation[feature] +
                       context.input.mean[feature]);
  }
  return series;
}
double as_it_is(double u) { return u; }

/// The losses of a form about each axis, against expected(axis, batch), for batches of several sizes.
template <class Form, class ContextType, class Expected>
void check_axes(unsigned seed, const ContextType& context, double roundings, const Expected& expected) {
  std::mt19937_64 engine(seed);
  for (const int size : {1, 2, 3, 17, 64}) {
    const auto batch = random_batch<double>(size, engine);
    const double values[] = {value(LocalMonotonicity<Roll, Form>{}, context, batch),
                             value(LocalMonotonicity<Pitch, Form>{}, context, batch),
                             value(LocalMonotonicity<Yaw, Form>{}, context, batch)};
    for (int axis = 0; axis < 3; ++axis) {
      CAPTURE(axis);
      CHECK(std::fabs(values[axis] - expected(axis, batch)) <= rounding<double>(roundings));
    }
  }
}
double mean_of_pairs(double total, int size) { return size > 1 ? total / (size - 1) : 0.0; }

/// The paper's airframe with the connectors of two motors swapped: 1 <-> 3 (front right, front left).
struct Swapped {
  static constexpr const char* name = "swapped";
  template <class Scalar>
  static constexpr Airframe<Scalar> value() {
    Airframe<Scalar> a = PaperQuadrotor::value<Scalar>();
    const auto first = a.rotors[0];
    a.rotors[0] = a.rotors[2];
    a.rotors[2] = first;
    return a;
  }
};

}  // namespace

TEST_CASE("footnote 2 of the paper, by each form") {
  const Array x = array({1, 2, 3, 4, 5});
  const Array y1 = array({1, -2, -3, 4, 5});
  const Array y2 = array({1, 2, 3, 1.9455, 2.5});
  SUBCASE("the sign as step function gives the paper's values") {
    CHECK(value(sign, y1, x) == 1.0);
    CHECK(value(sign, y2, x) == 0.5);
  }
  SUBCASE("Algorithm 1's tanh, mean over N - 1 pairs (docs/paper.md, deviation 8)") {
    CHECK(std::fabs(value(1.0, y1, x) - 0.9991) <= printed_digits);
    CHECK(std::fabs(value(1.0, y2, x) - 0.7632) <= printed_digits);
  }
  SUBCASE("divided by N_b as printed, tanh gives neither (docs/paper.md, deviation 8)") {
    const double step = LocalMonotonicity<Roll, Literal>{}.gain;
    CHECK(std::fabs(value<Literal>(step, y1, x) - 0.7992) <= printed_digits);
    CHECK(std::fabs(value<Literal>(step, y2, x) - 0.6106) <= printed_digits);
  }
  SUBCASE("the match: of four steps, all up in x, two and one go down; each costs (1 + 1)^2") {
    CHECK(value<Match>(sign, y1, x) == 2.0);
    CHECK(value<Match>(sign, y2, x) == 1.0);
  }
}

TEST_CASE("the gain a form begins with; one that is set stays") {
  CHECK(LocalMonotonicity<Roll>{}.gain == 3.0);
  CHECK((LocalMonotonicity<Roll, Literal>{}.gain == 1.0));
  CHECK((LocalMonotonicity<Roll, Match>{}.gain == 3.0));
  CHECK((LocalMonotonicity<Roll, Literal>{2.0}.gain == 2.0));
}

TEST_CASE("laws of the loss on two series") {
  std::mt19937_64 engine(51);
  for (int round = 0; round < 200; ++round) {
    const auto size = static_cast<Eigen::Index>(1 + pinnquad::uniform_index(engine, 20));
    Array m(size), n(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      m[i] = pinnquad::standard_normal(engine);
      n[i] = pinnquad::standard_normal(engine);
    }
    const double step = Standardised::gain;
    const double loss = value(step, m, n);
    CHECK(loss >= 0.0);
    CHECK(loss <= 2.0);
    CHECK(loss == value(step, n, m));  // symmetric
    CHECK(loss == doctest::Approx(value(step, Array(-m), Array(-n))));
    CHECK(loss == doctest::Approx(value(step, Array(m + 7.0), Array(n - 3.0))).epsilon(1e-12));  // offsets cancel
    if (size > 1) {
      CHECK(loss + value(step, Array(-m), n) == doctest::Approx(2.0));  // opposed: 2 - loss
      CHECK(value(sign, Array(3.0 * m), n) == value(sign, m, n));
    }
  }
}

TEST_CASE("0 for series that rise steeply together, 2 (match: 4) for opposed ones, 1 for one that stands still") {
  const Array steep = array({0, 100, 300, 350, 900}), still = array({4, 4, 4, 4, 4});
  for (const double gain : {1.0, 3.0}) {
    CHECK(value(gain, steep, steep) == 0.0);
    CHECK(value(gain, steep, Array(-steep)) == 2.0);
    CHECK(value(gain, still, steep) == 1.0);
  }
  CHECK(value(sign, steep, steep) == 0.0);
  CHECK(value(sign, steep, Array(-steep)) == 2.0);
  CHECK(value(sign, still, steep) == 1.0);
  CHECK(value<Match>(Match::gain, steep, steep) == 0.0);
  CHECK(value<Match>(Match::gain, steep, Array(-steep)) == 4.0);
  CHECK(value<Match>(Match::gain, still, steep) == 1.0);
}

TEST_CASE("the sign has no slope: it can't train") {
  Array gradient = Array::Zero(3);
  pinnquad::local_monotonicity(sign, array({1, 2, 0}), array({0, 1, 2}), 1.0, gradient);
  CHECK(gradient.abs().maxCoeff() == 0.0);
}

TEST_CASE(
    "pairs of docs/paper.md, deviation 9: p_dot with -u1+u2+u3-u4, q_dot with u1-u2+u3-u4, r_dot with u1+u2-u3-u4") {
  const auto check = [](const auto& context, const auto& to_command) {
    const auto steps_of = [&](int axis, const PaperBatch<double>& batch, const auto& pair) {
      const double deviation = context.signed_sum_deviation[static_cast<std::size_t>(axis)];
      const Series series = physical_series(axis, context, batch, to_command);
      return mean_of_pairs(
          series.sum([&](double m, double n) { return pair(std::tanh(3.0 * m / deviation), std::tanh(3.0 * n)); }),
          batch.size());
    };
    check_axes<Standardised>(54, context, 1000, [&](int axis, const PaperBatch<double>& batch) {
      return steps_of(axis, batch, [](double m, double n) { return 1.0 - m * n; });
    });
    check_axes<Match>(66, context, 1000, [&](int axis, const PaperBatch<double>& batch) {
      return steps_of(axis, batch, [](double m, double n) { return (m - n) * (m - n); });
    });
  };
  SUBCASE("commands") { check(flight_context<PaperContext>(), as_it_is); }
  SUBCASE("rotor speeds count as the commands they stand for (docs/paper.md, deviation 20)") {
    check(flight_context<Context<PaperFeatures, PaperQuadrotor, RotorSpeedOutputs>>(), [](double speed_rev_s) {
      const double n_max_rev_s = 8500.0 / 60.0;
      return std::copysign(speed_rev_s * speed_rev_s / (n_max_rev_s * n_max_rev_s), speed_rev_s);
    });
  }
}

TEST_CASE("literal: raw commands and rad/s^2, N_b - 1 terms over N_b, in every axis") {
  auto context = flight_context<PaperContext>();
  context.input.standard_deviation[3] = 11.0;
  context.input.standard_deviation[4] = 7.0;
  context.input.standard_deviation[5] = 0.9;
  context.input.mean[3] = 2.0;
  check_axes<Literal>(65, context, 1000, [&](int axis, const PaperBatch<double>& batch) {
    const Series series = physical_series(axis, context, batch, as_it_is);
    return series.sum([](double m, double n) { return 1.0 - std::tanh(m) * std::tanh(n); }) / batch.size();
  });
}

TEST_CASE("the signs come from the airframe: swapped motors, swapped signs") {
  std::mt19937_64 engine(55);
  const auto batch = random_batch<double>(20, engine);
  auto swapped = batch;  // prediction rows 0 and 2 change places
  swapped.prediction.row(0) = batch.prediction.row(2);
  swapped.prediction.row(2) = batch.prediction.row(0);
  const PaperContext paper{};
  const Context<PaperFeatures, Swapped> other{};
  const auto check = [&](const auto& loss) {
    CHECK(value(loss, other, swapped) == doctest::Approx(value(loss, paper, batch)).epsilon(1e-12));
    CHECK(std::fabs(value(loss, other, batch) - value(loss, paper, batch)) > 0.01);
  };
  check(LocalMonotonicity<Roll>{});
  check(LocalMonotonicity<Yaw>{});
  using SwappedContext = Context<PaperFeatures, Swapped>;
  CHECK(SwappedContext::signs<Roll>() == std::array<double, 4>{1, 1, -1, -1});
  CHECK(SwappedContext::signs<Pitch>() == std::array<double, 4>{1, -1, 1, -1});
  CHECK(SwappedContext::signs<Yaw>() == std::array<double, 4>{-1, 1, 1, -1});
}
