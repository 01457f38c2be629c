// SPDX-License-Identifier: MIT
// Ridge regression against NumPy, closed forms, its normal equations, and the refits that leaving out a group stands
// for.
#include "pinnquad/regression/ridge.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include "pinnquad/core/random.hpp"

using namespace pinnquad;

namespace {

struct Row {
  std::array<double, 4> x;
  std::array<double, 2> y;
};

/// Numbers that a script of two lines makes too.
Row row_of(int i) {
  const double a = std::sin(0.7 * i), b = std::cos(0.3 * i * i), c = 0.02 * i, d = a * c;
  return {{a, b, c, d}, {1 + 2 * a - c + 0.1 * std::cos(5.0 * i), -3 + 0.5 * b * c}};
}

constexpr int all_rows = 40;

RegressionSums sums_of(int first, int last) {
  RegressionSums sums(4, 2);
  for (int i = first; i < last; ++i) {
    const Row row = row_of(i);
    sums.add(row.x.data(), row.y.data());
  }
  return sums;
}

/// Rows of `inputs` numbers, one target that some of them make, noise.
RegressionSums random_sums(std::mt19937_64& engine, int inputs, int rows, double offset) {
  RegressionSums sums(inputs, 1);
  std::vector<double> x(static_cast<std::size_t>(inputs));
  for (int i = 0; i < rows; ++i) {
    for (double& v : x) v = uniform(engine, -1, 1);
    const double y = offset + x[0] - 2 * x[1] + uniform(engine, -1, 1);
    sums.add(x.data(), &y);
  }
  return sums;
}

}  // namespace

TEST_CASE("without a penalty it is least squares: numpy.linalg.lstsq") {
  const std::array<std::array<double, 5>, 2> numpy = {
      {{1.0064005329548082, 1.9862921235128126, -0.0035691215121875786, -1.00832618865038, 0.024574954009710395},
       {-3.055782511894342, -0.0059656517512367, 0.21968911681453712, 0.11990141817176737, -0.00836638132889962}}};
  const AffineMap map = fit_ridge(sums_of(0, all_rows), 0);
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(map.intercept[k] == doctest::Approx(numpy[k][0]).epsilon(1e-10));
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(map.weights[4 * k + i] == doctest::Approx(numpy[k][1 + i]).epsilon(1e-9));
    }
  }
}

TEST_CASE("with a penalty the intercept goes free: numpy.linalg.solve of the centred equations") {
  const std::array<double, 8> weights = {1.1389758992081775,   0.08515067166477287,  -0.16271202443257118,
                                         0.3980464006438417,   0.002603459324004581, 0.12642811288631006,
                                         0.015556160992542303, 0.0015472216526666348};
  const AffineMap map = fit_ridge(sums_of(0, all_rows), 0.3);
  for (std::size_t i = 0; i < weights.size(); ++i) CHECK(map.weights[i] == doctest::Approx(weights[i]).epsilon(1e-11));
  CHECK(map.intercept[0] == doctest::Approx(0.7027339680843869).epsilon(1e-12));
  CHECK(map.intercept[1] == doctest::Approx(-2.995890114609223).epsilon(1e-12));
}

TEST_CASE("features that do not vary together: each weight is its covariance over its variance and the penalty") {
  RegressionSums sums(2, 1);
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-3.0, 3.0}) {
      const std::array<double, 2> x = {a, b};
      const double y = 5 + 4 * a - 2 * b;
      sums.add(x.data(), &y);
    }
  }
  for (const double penalty : {0.0, 0.5, 7.0, 1e6}) {
    const AffineMap map = fit_ridge(sums, penalty);
    CHECK(map.weights[0] == doctest::Approx(4 / (1 + penalty)));
    CHECK(map.weights[1] == doctest::Approx(-2 * 9 / (9 + penalty)));
    CHECK(map.intercept[0] == doctest::Approx(5));
  }
}

TEST_CASE("a feature that stands still and one that another repeats do no harm, without a penalty too") {
  RegressionSums sums(6, 2);
  for (int i = 0; i < all_rows; ++i) {
    const Row row = row_of(i);
    const std::array<double, 6> x = {row.x[0], row.x[1], row.x[2], row.x[3], row.x[0], 12.5};
    sums.add(x.data(), row.y.data());
  }
  // numpy.linalg.lstsq of the centred rows: the shortest of all solutions shares between the two
  const std::array<double, 5> numpy = {0.9931460617564051, -0.0035691215121873565, -1.0083261886503803,
                                       0.02457495400971238, 0.993146061756405};
  const AffineMap map = fit_ridge(sums, 0);
  for (std::size_t i = 0; i < numpy.size(); ++i) CHECK(map.weights[i] == doctest::Approx(numpy[i]).epsilon(1e-8));
  CHECK(std::abs(map.weights[5]) < 1e-9);
  const AffineMap penalised = fit_ridge(sums, 1e-3);
  CHECK(penalised.weights[0] == doctest::Approx(penalised.weights[4]));
  CHECK(std::abs(penalised.weights[5]) < 1e-9);
}

TEST_CASE("more features than rows: all rows are met, by the shortest weights") {
  std::mt19937_64 engine(4);
  RegressionSums sums(9, 1);
  std::vector<std::array<double, 9>> xs;
  std::vector<double> ys;
  for (int i = 0; i < 5; ++i) {
    xs.emplace_back();
    for (double& v : xs.back()) v = uniform(engine, -1, 1);
    ys.push_back(uniform(engine, -1, 1));
    sums.add(xs.back().data(), &ys.back());
  }
  const AffineMap map = fit_ridge(sums, 0), near = fit_ridge(sums, 1e-7);
  for (std::size_t i = 0; i < xs.size(); ++i) CHECK(map(xs[i].data())[0] == doctest::Approx(ys[i]).epsilon(1e-9));
  for (std::size_t i = 0; i < 9; ++i) CHECK(map.weights[i] == doctest::Approx(near.weights[i]).epsilon(1e-4));
}

TEST_CASE("a feature that is not taken gets no weight, and the others are fitted as if it were not there") {
  const AffineMap map = fit_ridge(sums_of(0, all_rows), 0.1, {true, false, true, false});
  RegressionSums fewer(2, 2);
  for (int i = 0; i < all_rows; ++i) {
    const Row row = row_of(i);
    const std::array<double, 2> x = {row.x[0], row.x[2]};
    fewer.add(x.data(), row.y.data());
  }
  const AffineMap expected = fit_ridge(fewer, 0.1);
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(map.weights[4 * k] == doctest::Approx(expected.weights[2 * k]));
    CHECK(map.weights[4 * k + 1] == 0);
    CHECK(map.weights[4 * k + 2] == doctest::Approx(expected.weights[2 * k + 1]));
    CHECK(map.weights[4 * k + 3] == 0);
    CHECK(map.intercept[k] == doctest::Approx(expected.intercept[k]));
  }
}

TEST_CASE("the error from sums is the error of the rows, of rows that were not fitted too") {
  const AffineMap map = fit_ridge(sums_of(0, 25), 0.01);
  double squares = 0;
  for (int i = 25; i < all_rows; ++i) {
    const Row row = row_of(i);
    const std::vector<double> y = map(row.x.data());
    for (std::size_t k = 0; k < 2; ++k) squares += (y[k] - row.y[k]) * (y[k] - row.y[k]);
  }
  CHECK(squared_error(sums_of(25, all_rows), map) == doctest::Approx(squares).epsilon(1e-10));
}

TEST_CASE("leaving out a group by subtraction is a refit to the rows of the others") {
  const std::vector<std::array<int, 2>> pieces = {{{0, 9}}, {{9, 20}}, {{20, 33}}, {{33, all_rows}}};
  std::vector<RegressionSums> groups;
  for (const auto& piece : pieces) groups.push_back(sums_of(piece[0], piece[1]));
  const std::vector<double> penalties = {0, 1e-4, 1e-2, 0.3};
  std::size_t best = 0;
  std::vector<double> expected;
  for (const double penalty : penalties) {
    double squares = 0;
    for (const auto& out : pieces) {
      RegressionSums others(4, 2);
      for (int i = 0; i < all_rows; ++i) {
        if (i >= out[0] && i < out[1]) continue;
        const Row row = row_of(i);
        others.add(row.x.data(), row.y.data());
      }
      const AffineMap map = fit_ridge(others, penalty);
      for (int i = out[0]; i < out[1]; ++i) {
        const Row row = row_of(i);
        const std::vector<double> y = map(row.x.data());
        for (std::size_t k = 0; k < 2; ++k) squares += (y[k] - row.y[k]) * (y[k] - row.y[k]);
      }
    }
    expected.push_back(squares / (2 * all_rows));
    if (expected.back() < expected[best]) best = expected.size() - 1;
  }
  CHECK(choose_penalty(groups, penalties) == penalties[best]);
}

TEST_CASE("noise calls for a penalty, many clean rows for none") {
  std::mt19937_64 engine(9);
  std::vector<RegressionSums> noisy, plain;
  for (int group = 0; group < 4; ++group) noisy.push_back(random_sums(engine, 30, 12, 0.0));
  for (int group = 0; group < 4; ++group) plain.push_back(random_sums(engine, 3, 3000, 0.0));
  CHECK(choose_penalty(noisy) > 1e-2);
  CHECK(choose_penalty(plain) < 1e-2);
}

TEST_CASE("of penalties that err alike the largest is chosen, wherever it stands") {
  std::vector<RegressionSums> groups;
  for (int group = 0; group < 3; ++group) {  // features that stand still explain nothing under any penalty
    RegressionSums sums(2, 1);
    const std::array<double, 2> still{};
    for (int i = 0; i < 5; ++i) {
      const double y = std::sin(1.3 * i + group);
      sums.add(still.data(), &y);
    }
    groups.push_back(sums);
  }
  CHECK(choose_penalty(groups, {1e-3, 1.0, 1e-1}) == 1.0);
  CHECK(choose_penalty(groups, {1.0, 1e-3}) == 1.0);
}

TEST_CASE("what has no answer is refused in a line") {
  CHECK_THROWS_AS(fit_ridge(RegressionSums(3, 1), 1), std::invalid_argument);
  CHECK_THROWS_AS(fit_ridge(sums_of(0, 5), -1), std::invalid_argument);
  CHECK_THROWS_AS(fit_ridge(sums_of(0, 5), std::nan("")), std::invalid_argument);
  CHECK_THROWS_AS(choose_penalty({sums_of(0, 5)}), std::invalid_argument);
  CHECK_THROWS_AS(choose_penalty({sums_of(0, 5), sums_of(5, 9)}, {}), std::invalid_argument);
}
