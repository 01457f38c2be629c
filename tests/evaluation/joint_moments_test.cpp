// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <pinnquad/evaluation/summary.hpp>
#include <stdexcept>
#include <vector>

using pinnquad::joint_moments;

TEST_CASE("moments of four points, by hand") {
  const auto moments = joint_moments({1, 2, 3, 6}, {2, 1, 5, 4});
  CHECK(moments.mean_x == 3);
  CHECK(moments.mean_y == 3);
  CHECK(moments.variance_x == 14.0 / 3);
  CHECK(moments.variance_y == 10.0 / 3);
  CHECK(moments.covariance == 7.0 / 3);  // (2 + 2 + 0 + 3) / 3
}

TEST_CASE("swapping the series swaps the moments; variance is the covariance with itself") {
  const std::vector<double> x = {0.3, -1.2, 4.4, 2.0};
  const std::vector<double> y = {1.1, 0.2, -3.0, 0.7};
  const auto xy = joint_moments(x, y);
  const auto yx = joint_moments(y, x);
  CHECK(xy.covariance == yx.covariance);
  CHECK(xy.variance_x == yx.variance_y);
  CHECK(joint_moments(x, x).covariance == xy.variance_x);
}

TEST_CASE("fewer than two pairs have no variance, unequal series no moments") {
  CHECK(std::isnan(joint_moments({1}, {2}).variance_x));
  CHECK(std::isnan(joint_moments({1}, {2}).covariance));
  CHECK(joint_moments({1}, {2}).mean_y == 2);
  CHECK(std::isnan(joint_moments({}, {}).mean_x));
  CHECK_THROWS_WITH_AS(joint_moments({1, 2}, {1}), "joint_moments: expected series of equal length, found 2 and 1",
                       std::invalid_argument);
}
