// SPDX-License-Identifier: MIT
// The triangle of running least squares: R^T R is the sum of products with forgetting, its solution that of the normal
// equations, and the answer to sines that of the plant.
#include "pinnquad/control/onboard/triangle.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <random>

#include "pinnquad/control/onboard/sum_regression.hpp"
#include "pinnquad/core/random.hpp"

using namespace pinnquad;

TEST_CASE("R^T R of each variant is the sum of products, each row as often as it is remembered") {
  constexpr double keep = 0.97, rounding = 1e-10;
  using Shared = detail::SharedTriangle<double, 3, 2, 4>;
  Shared triangles;
  std::array<Eigen::Matrix<double, 6, 6>, 4> sums;
  sums.fill(Eigen::Matrix<double, 6, 6>::Zero());
  std::mt19937_64 random{3};
  for (int n = 0; n < 300; ++n) {
    Shared::Row row{};
    Shared::Owns owns{};
    for (double& x : row) x = standard_normal(random);
    for (std::size_t v = 0; v < owns.size(); ++v) {
      for (double& x : owns[v]) x = standard_normal(random);
      Eigen::Matrix<double, 6, 1> m;
      m << row[0], row[1], row[2], owns[v][0], owns[v][1], row[3];
      sums[v] = keep * sums[v] + m * m.transpose();
    }
    triangles.turn_in(row, owns, std::sqrt(keep));
  }
  for (std::size_t v = 0; v < sums.size(); ++v) {
    const detail::Triangle<double, 6> triangle = triangles.of(v);
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = i; j < 6; ++j) {
        double product = 0;
        for (std::size_t k = 0; k <= i; ++k) product += triangle.at(k, i) * triangle.at(k, j);
        CHECK(std::abs(product - sums[v](static_cast<int>(i), static_cast<int>(j))) < rounding * sums[v].norm());
      }
    }
    CHECK(triangles.left(v) == triangle.at(5, 5));
  }
}

TEST_CASE("a solution is that of the normal equations with the prior") {
  constexpr double rows = 200, repeats = 3, tolerance = 1e-8;
  detail::SumTriangle<double> triangle;
  Eigen::Matrix<double, 7, 7> products = Eigen::Matrix<double, 7, 7>::Zero();
  Eigen::Matrix<double, 7, 1> with_output = Eigen::Matrix<double, 7, 1>::Zero();
  std::mt19937_64 random{5};
  for (int n = 0; n < rows; ++n) {
    detail::SumTriangle<double>::Row row{};
    row[0] = 1;
    for (std::size_t i = 1; i < 7; ++i) row[i] = standard_normal(random);
    row[7] = 2 - row[1] + 0.5 * row[4] + 30 * row[6] + standard_normal(random);
    triangle.turn_in(row, 1.0);
    const Eigen::Map<const Eigen::Matrix<double, 7, 1>> x(row.data());
    products += x * x.transpose();
    with_output += row[7] * x;
  }
  const detail::Terms<double> mean{0, 1, 0, 0, 0, 0, 20}, deviations{5, 0.1, 1, 0.3, 1, 0.2, 10};
  const detail::SumSolution<double> solution =
      detail::solved(detail::SumTriangle<double>(triangle), rows, mean, deviations, repeats);
  for (int i = 0; i < 7; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double weight = repeats * solution.left_square / (deviations[at] * deviations[at]);
    products(i, i) += weight;
    with_output[i] += weight * mean[at];
  }
  const Eigen::Matrix<double, 7, 1> expected = products.ldlt().solve(with_output);
  for (std::size_t i = 0; i < 7; ++i) {
    CHECK(std::abs(solution.theta[i] - expected[static_cast<int>(i)]) < tolerance * expected.norm());
  }
  const double variance = repeats * solution.left_square * products.inverse()(6, 6);
  CHECK(std::abs(solution.standard_error / std::sqrt(variance) - 1) < tolerance);
}

TEST_CASE("a place between two lags: their mean, the ends where it lies beyond") {
  for (std::size_t i = 0; i + 1 < detail::lag_count; ++i) {
    const double between = 0.5 * (detail::lag_bank_s<double>[i] + detail::lag_bank_s<double>[i + 1]);
    const detail::LagPlace<double> place = detail::lag_place(between);
    CHECK(place.lower == i);
    CHECK(std::abs(place.seconds() - between) < 1e-15);
  }
  CHECK(std::abs(detail::lag_place(0.0).seconds() - detail::lag_bank_s<double>.front()) < 1e-15);
  CHECK(std::abs(detail::lag_place(9.0).seconds() - detail::lag_bank_s<double>.back()) < 1e-15);
}
