// SPDX-License-Identifier: MIT
#include "pinnquad/evaluation/errors.hpp"

#include <doctest/doctest.h>

#include <limits>

using pinnquad::Verdict;
using pinnquad::verdict_on;
using pinnquad::detail::PredictionErrors;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

PredictionErrors<4> errors(double a, double b, double c, double d) {
  PredictionErrors<4> result;
  const double r_squared[] = {a, b, c, d};
  for (std::size_t i = 0; i < 4; ++i) result.per_motor[i].r_squared = r_squared[i];
  result.mean.r_squared = (a + b + c + d) / 4;
  return result;
}

}  // namespace

TEST_CASE("a model is for flight if it is no worse than the mean of the commands; a poor motor is named") {
  CHECK_FALSE(verdict_on(errors(0.9, 0.8, 0.7, 0.6), 0).worse_than_mean());
  CHECK_FALSE(verdict_on(errors(0.9, 0.8, 0.7, 0.6), 0).has_poor_motor());
  CHECK_FALSE(verdict_on(errors(0, 0.8, 0.7, 0.6), 0).has_poor_motor());
  CHECK_FALSE(verdict_on(errors(0, 0, 0, 0), 0.8).worse_than_mean());
  for (const auto& poor : {errors(-1e-9, -1e-9, -1e-9, -1e-9), errors(0.9, not_a_number, 0.9, 0.9)}) {
    CHECK(verdict_on(poor, 0).worse_than_mean());
  }
  for (const auto& poor : {errors(0.9, 0.9, 0.9, -2.5), errors(-2.5, 0.9, 0.9, 0.9)}) {
    CHECK(verdict_on(poor, 0).has_poor_motor());
  }
  CHECK(verdict_on(errors(0.9, 0.9, 0.9, -2.5), 0.125).test_r_squared == doctest::Approx(0.05));
  CHECK(verdict_on(errors(0.9, 0.9, 0.9, -2.5), 0.125).linear_regression_r_squared == 0.125);
  CHECK(verdict_on(errors(0.9, 0.9, 0.9, -2.5), 0.125).worst_motor_r_squared == -2.5);
}

TEST_CASE("a model beats linear regression by a greater R^2, or where that has none") {
  CHECK(Verdict{0.75, 0.5, 0.5}.beats_linear_regression());
  CHECK_FALSE(Verdict{0.5, 0.5, 0.5}.beats_linear_regression());
  CHECK(Verdict{0.75, not_a_number, 0.5}.beats_linear_regression());
  CHECK_FALSE(Verdict{not_a_number, 0.5, not_a_number}.beats_linear_regression());
  CHECK_FALSE(Verdict{not_a_number, not_a_number, not_a_number}.beats_linear_regression());
}
