// SPDX-License-Identifier: MIT
// Does a prediction respect angular momentum? About each axis the signed command sum S (a row of Eq. (2)) and the
// angular acceleration must run alike; these measures say how well the predicted sum does, against the sum that was
// flown.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pinnquad/evaluation/confidence_ellipse.hpp"
#include "pinnquad/evaluation/summary.hpp"

namespace pinnquad {

/// |cov(S_predicted, omega_dot) / cov(S_target, omega_dot) - 1|: the relative error of the regression slope of S on
/// omega_dot; 0 is perfect, no unit. NaN if the target does not covary or there are fewer than two rows.
/// Throws std::invalid_argument for series of different length.
inline double slope_error(const std::vector<double>& target_sum, const std::vector<double>& predicted_sum,
                          const std::vector<double>& angular_acceleration) {
  const double target = joint_moments(target_sum, angular_acceleration).covariance;
  const double predicted = joint_moments(predicted_sum, angular_acceleration).covariance;
  return target == 0 ? not_a_number : std::abs(predicted / target - 1);
}

/// Share of consecutive pairs of rows in which the predicted sum moves against the angular acceleration:
///   #{i : dS_i d_omega_dot_i < 0} / #{i : d_omega_dot_i != 0},   d x_i = x_{i+1} - x_i,  i = 0 .. n-2
/// A sum that stands still is no violation. Rows must be in time order and follow each other. Twice this share is the
/// local monotonicity loss (Alg. 1) with the sign as step if no difference is 0. NaN if no pair counts.
/// `above`: pairs count whose |d_omega_dot_i| is larger, rad/s^2.
/// Throws std::invalid_argument for series of different length.
inline double sign_violation_share(const std::vector<double>& predicted_sum,
                                   const std::vector<double>& angular_acceleration, double above = 0) {
  detail::require_equal_length("sign_violation_share", predicted_sum.size(), angular_acceleration.size());
  std::size_t pairs = 0;
  std::size_t violations = 0;
  const std::size_t rows = std::min(predicted_sum.size(), angular_acceleration.size());  // equal; gcc 12 can't see it
  for (std::size_t i = 0; i + 1 < rows; ++i) {
    // by comparison: the product of two small differences could underflow to 0
    const bool large = std::abs(angular_acceleration[i + 1] - angular_acceleration[i]) > above;
    const bool rises = large && angular_acceleration[i + 1] > angular_acceleration[i];
    const bool falls = large && angular_acceleration[i + 1] < angular_acceleration[i];
    const bool sum_rises = predicted_sum[i + 1] > predicted_sum[i];
    const bool sum_falls = predicted_sum[i + 1] < predicted_sum[i];
    pairs += rises || falls ? 1 : 0;
    violations += (rises && sum_falls) || (falls && sum_rises) ? 1 : 0;
  }
  return pairs == 0 ? not_a_number : static_cast<double>(violations) / static_cast<double>(pairs);
}

/// All measures of one axis of rotation (roll, pitch or yaw). Ellipses have x = angular acceleration, y = command sum.
struct PhysicalConsistency {
  ConfidenceEllipse target;                  ///< raw units
  ConfidenceEllipse predicted;               ///< raw units
  ConfidenceEllipse target_standardized;     ///< both axes in units of the target's deviation
  ConfidenceEllipse predicted_standardized;  ///< in the same units
  double angle_difference_deg = 0;           ///< Delta m of Table 3: between the standardised ellipses, 0..90
  double raw_angle_difference_deg = 0;       ///< between the raw ellipses, 0..90
  double slope_error = 0;                    ///< see slope_error()
  double target_correlation = 0;             ///< PCC of the flown sum
  double predicted_correlation = 0;          ///< PCC of the predicted sum
  double sign_violation_share = 0;           ///< see sign_violation_share()
};

/// Measures a predicted command sum against the one flown; rows in time order, omega_dot in rad/s^2.
/// Throws std::invalid_argument for series of different length.
inline PhysicalConsistency physical_consistency(const std::vector<double>& target_sum,
                                                const std::vector<double>& predicted_sum,
                                                const std::vector<double>& angular_acceleration, double sigmas = 3) {
  const AxisDeviation deviation = axis_deviation(angular_acceleration, target_sum);
  PhysicalConsistency result;
  result.target = confidence_ellipse(angular_acceleration, target_sum, sigmas);
  result.predicted = confidence_ellipse(angular_acceleration, predicted_sum, sigmas);
  result.target_standardized = standardized_confidence_ellipse(angular_acceleration, target_sum, deviation, sigmas);
  result.predicted_standardized =
      standardized_confidence_ellipse(angular_acceleration, predicted_sum, deviation, sigmas);
  result.angle_difference_deg =
      angle_difference_deg(result.target_standardized.angle_deg, result.predicted_standardized.angle_deg);
  result.raw_angle_difference_deg = angle_difference_deg(result.target.angle_deg, result.predicted.angle_deg);
  result.slope_error = slope_error(target_sum, predicted_sum, angular_acceleration);
  result.target_correlation = pearson_correlation(target_sum, angular_acceleration);
  result.predicted_correlation = pearson_correlation(predicted_sum, angular_acceleration);
  result.sign_violation_share = sign_violation_share(predicted_sum, angular_acceleration);
  return result;
}

}  // namespace pinnquad
