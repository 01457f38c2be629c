// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <pinnquad/evaluation/errors.hpp>
#include <stdexcept>
#include <vector>

using pinnquad::prediction_errors;
using Row = std::array<double, 4>;
using Table = std::vector<Row>;

namespace {

constexpr double rounding = 1e-14;  // sums of a few numbers of order one

// targets per motor: mean 2.5, squares around it 5; constant in the last motor
const Table targets = {{1, 1, 4, 7}, {2, 2, 3, 7}, {3, 3, 2, 7}, {4, 4, 1, 7}};

}  // namespace

TEST_CASE("errors of a table, by hand") {
  Table predictions = targets;
  const double motor_1[] = {1, -1, 1, -3};  // sum of |e| 6, of squares 12
  for (std::size_t i = 0; i < 4; ++i) {
    predictions[i][0] += motor_1[i];
    predictions[i][1] = 2.5;  // the mean
    predictions[i][3] += 2;
  }
  const auto errors = prediction_errors(predictions, targets);
  CHECK(errors.per_motor[0].mean_absolute == 1.5);
  CHECK(errors.per_motor[0].root_mean_square == doctest::Approx(std::sqrt(3.0)).epsilon(rounding));
  CHECK(errors.per_motor[0].r_squared == doctest::Approx(1 - 12.0 / 5).epsilon(rounding));
  CHECK(errors.per_motor[1].r_squared == 0);  // as good as the mean
  CHECK(errors.per_motor[2].mean_absolute == 0);
  CHECK(errors.per_motor[2].root_mean_square == 0);
  CHECK(errors.per_motor[2].r_squared == 1);  // perfect
  CHECK(errors.per_motor[3].mean_absolute == 2);
  CHECK(errors.per_motor[3].root_mean_square == 2);
  CHECK(std::isnan(errors.per_motor[3].r_squared));  // constant target
  CHECK(errors.mean.mean_absolute == doctest::Approx((1.5 + 1 + 0 + 2) / 4).epsilon(rounding));
  CHECK(errors.mean.root_mean_square ==
        doctest::Approx((std::sqrt(3.0) + std::sqrt(1.25) + 0 + 2) / 4).epsilon(rounding));
  CHECK(std::isnan(errors.mean.r_squared));
}

TEST_CASE("scaling both tables scales the errors and leaves R^2") {
  constexpr double scale = 8;  // a power of two: exact
  Table predictions = {{1.5, 1, 4, 6}, {2, 2.25, 3, 8}, {2.5, 3, 2.5, 7}, {4, 4.5, 1, 7}};
  const auto errors = prediction_errors(predictions, targets);
  Table scaled_targets = targets;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t motor = 0; motor < 4; ++motor) {
      predictions[i][motor] *= scale;
      scaled_targets[i][motor] *= scale;
    }
  }
  const auto scaled = prediction_errors(predictions, scaled_targets);
  for (std::size_t motor = 0; motor < 3; ++motor) {
    CHECK(scaled.per_motor[motor].mean_absolute == scale * errors.per_motor[motor].mean_absolute);
    CHECK(scaled.per_motor[motor].root_mean_square == scale * errors.per_motor[motor].root_mean_square);
    CHECK(scaled.per_motor[motor].r_squared == errors.per_motor[motor].r_squared);
  }
  CHECK(errors.per_motor[0].mean_absolute <= errors.per_motor[0].root_mean_square);
}

TEST_CASE("a NaN prediction is not hidden, and touches its own motor only") {
  Table predictions = targets;
  predictions[2][1] = std::numeric_limits<double>::quiet_NaN();
  const auto errors = prediction_errors(predictions, targets);
  CHECK(std::isnan(errors.per_motor[1].mean_absolute));
  CHECK(std::isnan(errors.per_motor[1].r_squared));
  CHECK(std::isnan(errors.mean.root_mean_square));
  CHECK(errors.per_motor[0].mean_absolute == 0);
}

TEST_CASE("tables that do not match are refused") {
  CHECK_THROWS_WITH_AS(prediction_errors(Table(3), Table(2)),
                       "prediction_errors: expected series of equal length, found 3 and 2", std::invalid_argument);
  CHECK_THROWS_WITH_AS(prediction_errors(Table{}, Table{}), "prediction_errors: expected at least one row, found none",
                       std::invalid_argument);
}
