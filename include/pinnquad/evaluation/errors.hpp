// SPDX-License-Identifier: MIT
// How far predictions are from targets, per motor and as their mean over motors: mean absolute error, root mean square
// error, coefficient of determination. The verdict sets them beside the two predictors that cost nothing: the mean of
// the commands, and linear regression on the same features.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/evaluation/summary.hpp"

namespace pinnquad {

namespace detail {

/// Errors e_i = prediction_i - target_i of one output over n rows, t its targets:
///   mean_absolute    = sum |e_i| / n               in the unit of the output; Delta Y of Table 3
///   root_mean_square = sqrt(sum e_i^2 / n)         in the unit of the output
///   r_squared        = 1 - sum e_i^2 / sum (t_i - mean t)^2    1 is perfect, 0 as good as the mean, NaN for constant t
struct ErrorMeasures {
  double mean_absolute = 0;
  double root_mean_square = 0;
  double r_squared = 0;
};

}  // namespace detail

/// Errors per motor, and the arithmetic mean of each measure over the motors.
template <std::size_t Motors>
struct PredictionErrors {
  std::array<detail::ErrorMeasures, Motors> per_motor{};
  detail::ErrorMeasures mean;
};

/// Compares predictions with targets, row by row. A NaN in a column gives NaN for that motor and the mean.
/// Throws std::invalid_argument for no rows or tables of different length.
template <std::size_t Motors>
PredictionErrors<Motors> prediction_errors(const std::vector<std::array<double, Motors>>& predictions,
                                           const std::vector<std::array<double, Motors>>& targets) {
  static_assert(Motors > 0, "prediction_errors: a row needs at least one output");
  detail::require_equal_length("prediction_errors", predictions.size(), targets.size());
  if (targets.empty()) throw std::invalid_argument("prediction_errors: expected at least one row, found none");

  const auto rows = static_cast<double>(targets.size());
  PredictionErrors<Motors> errors;
  for (std::size_t motor = 0; motor < Motors; ++motor) {
    std::vector<double> target(targets.size());
    for (std::size_t i = 0; i < targets.size(); ++i) target[i] = targets[i][motor];
    const double mean_target = detail::mean_of(target);

    double absolute = 0;
    double squares = 0;
    double squares_of_mean = 0;
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const double error = predictions[i][motor] - target[i];
      absolute += std::abs(error);
      squares += error * error;
      squares_of_mean += (target[i] - mean_target) * (target[i] - mean_target);
    }
    detail::ErrorMeasures& measures = errors.per_motor[motor];
    measures.mean_absolute = absolute / rows;
    measures.root_mean_square = std::sqrt(squares / rows);
    measures.r_squared = squares_of_mean > 0 ? 1 - squares / squares_of_mean : not_a_number;

    constexpr auto motors = static_cast<double>(Motors);
    errors.mean.mean_absolute += measures.mean_absolute / motors;
    errors.mean.root_mean_square += measures.root_mean_square / motors;
    errors.mean.r_squared += measures.r_squared / motors;
  }
  return errors;
}

/// Coefficients of determination on the test rows (evaluation/errors.hpp); but for the worst motor's the mean over the
/// commands.
struct Verdict {
  double test_r_squared = 0;               ///< of the model
  double linear_regression_r_squared = 0;  ///< of evaluation/linear_regression.hpp, fitted on the model's training rows
  /// Of the model, the least of the motors; NaN if one is, or if nothing is said of it.
  double worst_motor_r_squared = std::numeric_limits<double>::quiet_NaN();

  /// Answering always with the mean command would have been better; so too if R^2 is NaN. Such a model is not for
  /// flight.
  bool worse_than_mean() const noexcept { return !(is_finite(test_r_squared) && test_r_squared >= 0); }
  /// The same of one motor: a good mean may hide it.
  bool has_poor_motor() const noexcept { return is_finite(worst_motor_r_squared) && worst_motor_r_squared < 0; }
  /// False if the plain linear map predicts the commands as well or better: the network has learned nothing beyond it.
  bool beats_linear_regression() const noexcept {
    return is_finite(test_r_squared) &&
           (!is_finite(linear_regression_r_squared) || test_r_squared > linear_regression_r_squared);
  }
};

/// The verdict on a model by its errors on the test rows.
template <std::size_t Motors>
Verdict verdict_on(const PredictionErrors<Motors>& errors, double linear_regression_r_squared) noexcept {
  double worst = errors.per_motor[0].r_squared;
  for (const detail::ErrorMeasures& motor : errors.per_motor) {
    if (is_finite(worst) && (!is_finite(motor.r_squared) || motor.r_squared < worst)) worst = motor.r_squared;
  }
  return {errors.mean.r_squared, linear_regression_r_squared, worst};
}

}  // namespace pinnquad
