// SPDX-License-Identifier: MIT
#include "pinnquad/regression/ridge.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <random>

#include "pinnquad/core/random.hpp"

using namespace pinnquad;
using namespace pinnquad::detail;

namespace {

Eigen::MatrixXd random_factor(int size, unsigned seed) {
  std::mt19937_64 engine(seed);
  Eigen::MatrixXd factor(size, size);
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) factor(i, j) = uniform(engine, -1, 1) + (i == j ? 2 : 0);
  }
  return factor;
}

}  // namespace

TEST_CASE("whitening makes a covariance the identity, by a lower triangle; its upper one is not read") {
  for (const int size : {1, 2, 7, 34}) {
    CAPTURE(size);
    const Eigen::MatrixXd factor = random_factor(size, 1), a = factor * factor.transpose();
    Eigen::MatrixXd lower = a.triangularView<Eigen::Lower>();
    lower.triangularView<Eigen::StrictlyUpper>().setConstant(std::numeric_limits<double>::quiet_NaN());
    const auto whitening = whitening_of(lower);
    REQUIRE(whitening);
    CHECK(whitening->isLowerTriangular(0));
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(size, size);
    CHECK((*whitening * a * whitening->transpose() - identity).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("what is not positive definite or not finite has no whitening") {
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(3, 3);
  CHECK(whitening_of(a));
  a(2, 2) = 0;
  CHECK_FALSE(whitening_of(a));
  a(2, 2) = -1;
  CHECK_FALSE(whitening_of(a));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    a = Eigen::MatrixXd::Identity(3, 3);
    a(1, 0) = bad;
    CHECK_FALSE(whitening_of(a));
    a(1, 0) = 0;
    a(2, 2) = bad;
    CHECK_FALSE(whitening_of(a));
  }
}
