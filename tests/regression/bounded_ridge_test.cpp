// SPDX-License-Identifier: MIT
// Ridge under bounds: the free fit where it keeps them, else the least cost on the border, against many other weights
// that keep them.
#include "pinnquad/regression/ridge.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "pinnquad/core/random.hpp"

using namespace pinnquad;

namespace {

constexpr int inputs = 5;

/// y = 1 + 2 x_0 - 0.3 x_1 + 0.2 x_2 + noise, features that go together.
RegressionSums rows(std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  RegressionSums sums(inputs, 1);
  for (int i = 0; i < 300; ++i) {
    double x[inputs];
    for (double& v : x) v = uniform(engine, -1, 1);
    x[2] += 0.8 * x[1];
    x[4] += 0.5 * x[0];
    const double y = 1 + 2 * x[0] - 0.3 * x[1] + 0.2 * x[2] + uniform(engine, -0.5, 0.5);
    sums.add(static_cast<const double*>(x), &y);
  }
  return sums;
}

double cost(const RegressionSums& sums, const AffineMap& map, double penalty) {
  double squares = 0;
  for (const double w : map.weights) squares += w * w;
  return squared_error(sums, map) / sums.rows() + penalty * squares;
}

double bound_value(const AffineMap& map, const pinnquad::detail::WeightBound& bound) {
  double sum = 0;
  for (const auto& [feature, factor] : bound.terms) sum += factor * map.weights[static_cast<std::size_t>(feature)];
  return sum;
}

}  // namespace

TEST_CASE("bounds that the free fit keeps leave it as it is") {
  const RegressionSums sums = rows(1);
  const AffineMap free = fit_ridge(sums, 0.01), bounded = fit_bounded_ridge(sums, 0.01, {}, {{{{0, 1.0}}, 0.5, false}});
  for (std::size_t i = 0; i < inputs; ++i) CHECK(bounded.weights[i] == doctest::Approx(free.weights[i]).epsilon(1e-12));
  CHECK(bounded.intercept[0] == doctest::Approx(free.intercept[0]));
}

TEST_CASE("bounds that it breaks: the least cost of all weights that keep them") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const RegressionSums sums = rows(seed);
    const double penalty = 0.02;
    const std::vector<bool> taken = {true, true, true, false, true};
    const std::vector<pinnquad::detail::WeightBound> bounds = {{{{1, 1.0}}, 0.1, false},
                                                               {{{1, 2.0}, {2, 1.0}, {4, 0.5}}, 0.6, false}};
    const AffineMap map = fit_bounded_ridge(sums, penalty, taken, bounds);
    CHECK(map.weights[3] == 0);
    for (const pinnquad::detail::WeightBound& bound : bounds) CHECK(bound_value(map, bound) >= bound.least - 1e-9);
    const double least = cost(sums, map, penalty);
    CHECK(cost(sums, fit_ridge(sums, penalty, taken), penalty) < least);  // the free fit breaks a bound
    std::mt19937_64 engine(seed);
    int kept = 0;
    const Eigen::VectorXd mean = sums.means();
    for (int other = 0; other < 4000; ++other) {
      AffineMap moved = map;
      const double size = other % 2 == 0 ? 0.01 : 0.3;
      for (const std::size_t i : {0U, 1U, 2U, 4U}) moved.weights[i] += uniform(engine, -size, size);
      bool keeps = true;
      for (const pinnquad::detail::WeightBound& bound : bounds)
        keeps = keeps && bound_value(moved, bound) >= bound.least;
      if (!keeps) continue;
      ++kept;
      moved.intercept[0] = mean[inputs];  // the best one for these weights
      for (int i = 0; i < inputs; ++i) moved.intercept[0] -= moved.weights[static_cast<std::size_t>(i)] * mean[i];
      CHECK(cost(sums, moved, penalty) >= least - 1e-12);
    }
    CHECK(kept > 200);
  }
}

TEST_CASE("a pinned sum is that sum, whichever side the rows would have it on") {
  const RegressionSums sums = rows(7);
  for (const double wanted : {0.5, 3.0}) {
    const pinnquad::detail::WeightBound pinned{{{0, 1.5}}, wanted, true};
    CHECK(bound_value(fit_bounded_ridge(sums, 0, {}, {pinned}), pinned) == doctest::Approx(wanted).epsilon(1e-9));
  }
}

TEST_CASE("what can't be solved is refused") {
  const RegressionSums sums = rows(1);
  CHECK_THROWS_AS(fit_bounded_ridge(RegressionSums(inputs, 1), 0, {}, {}), std::invalid_argument);
  CHECK_THROWS_AS(fit_bounded_ridge(RegressionSums(inputs, 2), 0, {}, {}), std::invalid_argument);
  CHECK_THROWS_AS(fit_bounded_ridge(sums, -1, {}, {}), std::invalid_argument);
  CHECK_THROWS_AS(fit_bounded_ridge(sums, 0, {}, std::vector<pinnquad::detail::WeightBound>(9, {{{0, 1.0}}, 0, false})),
                  std::invalid_argument);
  const std::vector<pinnquad::detail::WeightBound> contradiction = {{{{0, 1.0}}, 1, true}, {{{0, 1.0}}, 2, true}};
  CHECK_THROWS_AS(fit_bounded_ridge(sums, 0, {}, contradiction), std::invalid_argument);
}

TEST_CASE("the sums of one output are those of a fit to it alone") {
  RegressionSums two(2, 2);
  for (int i = 0; i < 30; ++i) {
    const double x[2] = {std::sin(1.0 * i), std::cos(2.0 * i)}, y[2] = {x[0] + 1, 3 * x[1] - x[0]};
    two.add(static_cast<const double*>(x), static_cast<const double*>(y));
  }
  const AffineMap both = fit_ridge(two, 0.1);
  for (int k = 0; k < 2; ++k) {
    const AffineMap one = fit_ridge(two.of_output(k), 0.1);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(one.weights[i] == doctest::Approx(both.weights[2 * std::size_t(k) + i]).epsilon(1e-12));
    }
    CHECK(one.intercept[0] == doctest::Approx(both.intercept[std::size_t(k)]));
  }
}

TEST_CASE("a bound of a feature that is left out, or of none, is refused") {
  const RegressionSums sums = rows(1);
  const std::vector<bool> taken = {true, false, true, true, true};
  for (const int feature : {-1, 1, inputs}) {
    CHECK_THROWS_AS(fit_bounded_ridge(sums, 0, taken, {{{{0, 1.0}, {feature, 1.0}}, 0.1, false}}),
                    std::invalid_argument);
  }
}
