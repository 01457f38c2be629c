// SPDX-License-Identifier: MIT
#include "pinnquad/evaluation/errors.hpp"

#include <doctest/doctest.h>

#include <random>

#include "pinnquad/core/random.hpp"

namespace {

using pinnquad::fit_linear_regression;
using X = std::vector<std::array<double, 3>>;
using Y = std::vector<std::array<double, 2>>;

constexpr double rounding = 1e-10;  // of sums over a few hundred rows, by second moments

/// Features of very different size and offset, with correlation.
X random_features(std::size_t rows, unsigned seed) {
  std::mt19937_64 engine(seed);
  X x(rows);
  for (auto& row : x) {
    const double common = pinnquad::standard_normal(engine);
    row = {100 + common, 1e-3 * (common + pinnquad::standard_normal(engine)), 50 * pinnquad::standard_normal(engine)};
  }
  return x;
}

Y affine(const X& x) {
  Y y;
  for (const auto& v : x) y.push_back({0.5 - 0.02 * v[0] + 30 * v[1] + 0.001 * v[2], -1 + 4 * v[1]});
  return y;
}

}  // namespace

TEST_CASE("an affine map is found, and predicts rows that it was not fitted on") {
  const X x = random_features(300, 1);
  const auto fit = fit_linear_regression(x, affine(x));
  CHECK(fit.rank == 3);
  CHECK(fit.coefficients[0][0] == doctest::Approx(-0.02).epsilon(rounding));
  CHECK(fit.coefficients[0][1] == doctest::Approx(30).epsilon(rounding));
  CHECK(fit.coefficients[0][2] == doctest::Approx(0.001).epsilon(rounding));
  CHECK(fit.coefficients[1][1] == doctest::Approx(4).epsilon(rounding));
  CHECK(fit.intercept[0] == doctest::Approx(0.5).epsilon(1e-8));
  const X others = random_features(50, 2);
  const Y expected = affine(others);
  for (std::size_t i = 0; i < others.size(); ++i) {
    for (std::size_t k = 0; k < 2; ++k)
      CHECK(fit.predict(others[i])[k] == doctest::Approx(expected[i][k]).epsilon(1e-8));
  }
}

TEST_CASE("least squares: the residuals sum to 0 and are orthogonal to every feature") {
  const X x = random_features(200, 3);
  Y y = affine(x);
  std::mt19937_64 engine(4);
  for (auto& row : y) {
    for (double& v : row) v += pinnquad::standard_normal(engine);
  }
  const auto fit = fit_linear_regression(x, y);
  for (std::size_t k = 0; k < 2; ++k) {
    double sum = 0;
    std::array<double, 3> products{}, sizes{};
    for (std::size_t n = 0; n < x.size(); ++n) {
      const double residual = y[n][k] - fit.predict(x[n])[k];
      sum += residual;
      for (std::size_t i = 0; i < 3; ++i) {
        products[i] += residual * x[n][i];
        sizes[i] += std::abs(residual * x[n][i]);
      }
    }
    CHECK(std::abs(sum) <= 1e-9 * double(x.size()));
    for (std::size_t i = 0; i < 3; ++i) CHECK(std::abs(products[i]) <= 1e-9 * sizes[i]);
  }
}

TEST_CASE("features that stand still, repeat others or are sums of others do no harm") {
  X x = random_features(300, 5);
  const Y y = affine(x);
  std::vector<std::array<double, 6>> more;
  for (const auto& v : x) more.push_back({v[0], v[1], v[2], 7.3, 2 * v[1] + 5, v[0] - 0.01 * v[2]});
  const auto fit = fit_linear_regression(more, y);
  CHECK(fit.rank == 3);
  for (std::size_t n = 0; n < more.size(); ++n) {
    for (std::size_t k = 0; k < 2; ++k) CHECK(fit.predict(more[n])[k] == doctest::Approx(y[n][k]).epsilon(1e-7));
  }
}

TEST_CASE("a column is constant where it moves by less than 1e-12 of its mean") {
  const auto rank = [](double share) {
    X x;
    Y y;
    for (int i = 0; i < 100; ++i) {
      const double sign = i % 2 == 0 ? 1 : -1;
      x.push_back({8 * (1 + share * sign), 0, 0});
      y.push_back({sign, 0});
    }
    return fit_linear_regression(x, y).rank;
  };
  CHECK(rank(1.3e-12) == 1);
  CHECK(rank(0.7e-12) == 0);
}

TEST_CASE("without anything to learn from the mean is predicted") {
  const auto fit = fit_linear_regression(X(4, {1, 2, 3}), Y{{1, 0}, {2, 0}, {3, 0}, {4, 0}});
  CHECK(fit.rank == 0);
  CHECK(fit.predict({9, 9, 9})[0] == doctest::Approx(2.5));
  CHECK_THROWS_AS(fit_linear_regression(X{}, Y{}), std::invalid_argument);
  CHECK_THROWS_AS(fit_linear_regression(X(2), Y(3)), std::invalid_argument);
}
