// SPDX-License-Identifier: MIT
// Does a prediction respect angular momentum? About each axis the signed command sum S (a row of Eq. (2)) and the
// angular acceleration must run alike. Measures: the covariance confidence ellipse (CCE) of the cloud, drawn at 3 sigma
// (Figs. 2 and 8), the angle of its principal axis, whose difference from target to prediction is the paper's Delta m,
// the slope and the signs of steps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "pinnquad/evaluation/summary.hpp"

namespace pinnquad {

namespace detail {
inline constexpr double pi = 3.14159265358979323846;

/// Standard deviation along each axis: the units in which a standardised ellipse is measured.
struct AxisDeviation {
  double x = 1;
  double y = 1;
};
}  // namespace detail

/// An ellipse in the plane of x and y: centre, semi-axes, angle of the major axis from +x towards +y in (-90, 90].
/// A circle has no angle; it is given as 0.
struct ConfidenceEllipse {
  double center_x = not_a_number;
  double center_y = not_a_number;
  double semi_major = not_a_number;
  double semi_minor = not_a_number;
  double angle_deg = not_a_number;
};

/// The ellipse of given moments: semi-axes are `sigmas` times the roots of the eigenvalues of the covariance matrix,
///   angle = atan2(2 cov, var_x - var_y) / 2.
/// NaN moments give a NaN ellipse; points on a line give semi_minor 0.
inline ConfidenceEllipse covariance_ellipse(const detail::JointMoments& moments, double sigmas = 3) {
  const double half_sum = (moments.variance_x + moments.variance_y) / 2;
  const double half_difference = (moments.variance_x - moments.variance_y) / 2;
  const double root = std::hypot(half_difference, moments.covariance);
  const double largest = half_sum + root;
  // det / largest keeps digits that half_sum - root loses for a thin ellipse
  const double determinant = moments.variance_x * moments.variance_y - moments.covariance * moments.covariance;
  const double smallest = largest > 0 ? determinant / largest : half_sum - root;

  ConfidenceEllipse ellipse;
  ellipse.center_x = moments.mean_x;
  ellipse.center_y = moments.mean_y;
  ellipse.semi_major = sigmas * std::sqrt(largest);
  ellipse.semi_minor = sigmas * std::sqrt(smallest < 0 ? 0 : smallest);  // below 0 by rounding only; NaN goes through
  ellipse.angle_deg = std::atan2(moments.covariance, half_difference) * (90 / detail::pi);
  if (ellipse.angle_deg <= -90) ellipse.angle_deg = 90;
  return ellipse;
}

/// The standard deviations of the points (x[i], y[i]); to be taken from the target, for the target's and the
/// prediction's ellipse.
inline detail::AxisDeviation axis_deviation(const std::vector<double>& x, const std::vector<double>& y) {
  const detail::JointMoments moments = joint_moments(x, y);
  return {std::sqrt(moments.variance_x), std::sqrt(moments.variance_y)};
}

/// The ellipse of the points (x[i] / deviation.x, y[i] / deviation.y): by default in their own units, with a deviation
/// standardised. In its own deviation a cloud lies at +-45 degrees whatever its correlation; in the target's, the angle
/// of a prediction says how far its slope or sign is off. Deviation: the paper does not say how its axes are scaled; in
/// raw units roll and pitch stay below 1 degree, where its differences are 20 to 30 (docs/paper.md, deviation 12). NaN
/// for fewer than two points and for a deviation of 0 or NaN.
/// Throws std::invalid_argument for series of different length.
inline ConfidenceEllipse confidence_ellipse(const std::vector<double>& x, const std::vector<double>& y,
                                            double sigmas = 3, const detail::AxisDeviation& deviation = {}) {
  detail::JointMoments moments = joint_moments(x, y);
  if (!(deviation.x > 0) || !(deviation.y > 0)) return {};
  moments.mean_x /= deviation.x;
  moments.mean_y /= deviation.y;
  moments.variance_x /= deviation.x * deviation.x;
  moments.variance_y /= deviation.y * deviation.y;
  moments.covariance /= deviation.x * deviation.y;
  return covariance_ellipse(moments, sigmas);
}

/// Angle between two axes (not directions), degrees, 0..90: |a - b| folded, so that 89 and -89 are 2 degrees apart.
inline double angle_difference_deg(double first_deg, double second_deg) {
  return std::abs(std::remainder(first_deg - second_deg, 180.0));
}

/// Points (x, y) on the outline for a plot, equally spaced in the ellipse's own angle, from the tip of the major axis
/// round to the same point again: `points` of them, the last equal to the first. Throws std::invalid_argument below 2.
inline std::vector<std::array<double, 2>> ellipse_outline(const ConfidenceEllipse& ellipse, std::size_t points = 73) {
  if (points < 2) throw std::invalid_argument("ellipse_outline: expected at least 2 points");
  const double angle = ellipse.angle_deg * (detail::pi / 180);
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  std::vector<std::array<double, 2>> outline(points);
  for (std::size_t i = 0; i + 1 < points; ++i) {
    const double turn = 2 * detail::pi * static_cast<double>(i) / static_cast<double>(points - 1);
    const double major = ellipse.semi_major * std::cos(turn);
    const double minor = ellipse.semi_minor * std::sin(turn);
    outline[i] = {ellipse.center_x + major * cosine - minor * sine, ellipse.center_y + major * sine + minor * cosine};
  }
  outline.back() = outline.front();
  return outline;
}

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

/// Signed command sum and angular acceleration about one axis, row by row, in time order.
struct AxisSeries {
  std::vector<double> angular_acceleration;  ///< rad/s^2
  std::vector<double> target;                ///< sum of the flown commands
  std::vector<double> predicted;
};

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

/// Measures a predicted command sum against the one flown; ellipses at 3 sigma.
/// Throws std::invalid_argument for series of different length.
inline PhysicalConsistency physical_consistency(const AxisSeries& series) {
  const std::vector<double>& x = series.angular_acceleration;
  const detail::AxisDeviation deviation = axis_deviation(x, series.target);
  PhysicalConsistency result;
  result.target = confidence_ellipse(x, series.target);
  result.predicted = confidence_ellipse(x, series.predicted);
  result.target_standardized = confidence_ellipse(x, series.target, 3, deviation);
  result.predicted_standardized = confidence_ellipse(x, series.predicted, 3, deviation);
  result.angle_difference_deg =
      angle_difference_deg(result.target_standardized.angle_deg, result.predicted_standardized.angle_deg);
  result.raw_angle_difference_deg = angle_difference_deg(result.target.angle_deg, result.predicted.angle_deg);
  result.slope_error = slope_error(series.target, series.predicted, x);
  result.target_correlation = pearson_correlation(series.target, x);
  result.predicted_correlation = pearson_correlation(series.predicted, x);
  result.sign_violation_share = sign_violation_share(series.predicted, x);
  return result;
}

}  // namespace pinnquad
