// SPDX-License-Identifier: MIT
// Is a network worth flying? Its errors on rows that it was not trained on, beside the two predictors that cost nothing:
// the mean of the commands, and linear regression on the same features.
#pragma once

#include <cmath>

namespace pinnquad {

/// Coefficients of determination on the test rows, the mean over the commands (evaluation/errors.hpp).
struct Verdict {
  double test_r_squared = 0;               ///< of the model
  double linear_regression_r_squared = 0;  ///< of evaluation/linear_regression.hpp, fitted on the model's training rows

  /// Answering always with the mean command would have been better; so too if R^2 is NaN. Such a model is not for flight.
  bool worse_than_mean() const noexcept { return !(test_r_squared >= 0); }
  /// False if the plain linear map predicts the commands as well or better: the network has learned nothing beyond it.
  bool beats_linear_regression() const noexcept {
    return test_r_squared > linear_regression_r_squared ||
           (std::isnan(linear_regression_r_squared) && !std::isnan(test_r_squared));
  }
};

}  // namespace pinnquad
