// SPDX-License-Identifier: MIT
// Is a network worth flying? Its errors on rows that it was not trained on, beside the two predictors that cost
// nothing: the mean of the commands, and linear regression on the same features.
#pragma once

#include <cstddef>
#include <limits>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/evaluation/errors.hpp"

namespace pinnquad {

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
  for (const ErrorMeasures& motor : errors.per_motor) {
    if (is_finite(worst) && (!is_finite(motor.r_squared) || motor.r_squared < worst)) worst = motor.r_squared;
  }
  return {errors.mean.r_squared, linear_regression_r_squared, worst};
}

}  // namespace pinnquad
