// SPDX-License-Identifier: MIT
// Pearson's correlation as a loss, and what the paper's footnote 2 says of it.
#include "pinnquad/loss/local_monotonicity.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>
#include <random>

#include "support/loss_batches.hpp"
#include "support/tolerances.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {

using Array = Eigen::ArrayXd;
using PaperContext = Context<PaperFeatures, PaperQuadrotor>;

double value(const Array& m, const Array& n) {
  Array gradient = Array::Zero(m.size());
  return pinnquad::pearson_loss(m, n, 1.0, gradient);
}

}  // namespace

TEST_CASE("footnote 2 of the paper: two different patterns, one correlation (docs/paper.md, deviation 8)") {
  const Array x = array({1, 2, 3, 4, 5});
  CHECK(std::fabs(1.0 - value(array({1, -2, -3, 4, 5}), x) - 0.626099) <= 5e-7);
  CHECK(std::fabs(1.0 - value(array({1, 2, 3, 1.9455, 2.5}), x) - 0.626096) <= 5e-7);
}

TEST_CASE("laws: 0 in proportion, 2 opposed, symmetric, without unit or offset") {
  std::mt19937_64 engine(61);
  for (int round = 0; round < 100; ++round) {
    const auto size = static_cast<Eigen::Index>(3 + pinnquad::uniform_index(engine, 30));
    Array m(size), n(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      m[i] = pinnquad::standard_normal(engine);
      n[i] = pinnquad::standard_normal(engine);
    }
    CHECK(value(m, Array(2.0 * m + 1.0)) <= rounding<double>(100));
    CHECK(std::fabs(value(m, Array(-m)) - 2.0) <= rounding<double>(100));
    CHECK(value(m, n) == doctest::Approx(value(n, m)).epsilon(1e-12));
    CHECK(value(m, n) == doctest::Approx(value(Array(0.01 * m - 4.0), Array(30.0 * n + 2.0))).epsilon(1e-10));
  }
}

TEST_CASE("the sign is the allocation's: commands that turn the vehicle the measured way correlate") {
  std::mt19937_64 engine(64);
  auto batch = random_batch<double>(64, engine);
  const auto context = flight_context<PaperContext>();
  const double signs[4] = {-1, 1, 1, -1};  // Eq. (2), roll
  for (int i = 0; i < 64; ++i) {
    double sum = 0.0;
    for (int k = 0; k < 4; ++k)
      sum += signs[k] * batch.prediction(k, i) * context.output.standard_deviation[static_cast<std::size_t>(k)];
    batch.features(3, i) = 40.0 * sum;
  }
  PaperBatch<double>::Gradient gradient;
  gradient.setZero(4, 64);
  CHECK(PearsonCorrelation<Roll>{}.evaluate(context, batch, 1.0, gradient) <= rounding<double>(1000));
}

TEST_CASE("no correlation, no gradient: a series that stands still, a single sample") {
  Array gradient = array({5, 5, 5});
  CHECK(pinnquad::pearson_loss(array({2, 2, 2}), array({1, 2, 3}), 1.0, gradient) == 1.0);
  CHECK(pinnquad::pearson_loss(array({1, 2, 3}), array({2, 2, 2}), 1.0, gradient) == 1.0);
  CHECK((gradient == 5.0).all());
  Array one = array({5});
  CHECK(pinnquad::pearson_loss(array({1}), array({2}), 1.0, one) == 0.0);
  CHECK(one[0] == 5.0);
}

TEST_CASE("the gradient is added") {
  const Array m = array({1, 2, 4}), n = array({1, 3, 2});
  Array from_zero = Array::Zero(3), from_five = array({5, 5, 5});
  pinnquad::pearson_loss(m, n, 1.0, from_zero);
  pinnquad::pearson_loss(m, n, 1.0, from_five);
  CHECK((from_five - from_zero - 5).abs().maxCoeff() <= rounding<double>(10));
}
