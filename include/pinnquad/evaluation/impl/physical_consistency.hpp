// SPDX-License-Identifier: MIT
// Bodies of physical_consistency.hpp.
#pragma once

#include <algorithm>

#include "pinnquad/evaluation/physical_consistency.hpp"

namespace pinnquad {

PINNQUAD_BODY ConfidenceEllipse covariance_ellipse(const detail::JointMoments& moments, double sigmas) {
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
  ellipse.angle_deg = std::atan2(moments.covariance, half_difference) * (90 / pi);
  if (ellipse.angle_deg <= -90) ellipse.angle_deg = 90;
  return ellipse;
}

PINNQUAD_BODY detail::AxisDeviation axis_deviation(const std::vector<double>& x, const std::vector<double>& y) {
  const detail::JointMoments moments = joint_moments(x, y);
  return {std::sqrt(moments.variance_x), std::sqrt(moments.variance_y)};
}

PINNQUAD_BODY ConfidenceEllipse confidence_ellipse(const std::vector<double>& x, const std::vector<double>& y,
                                                   double sigmas, const detail::AxisDeviation& deviation) {
  detail::JointMoments moments = joint_moments(x, y);
  if (!(deviation.x > 0) || !(deviation.y > 0)) return {};
  moments.mean_x /= deviation.x;
  moments.mean_y /= deviation.y;
  moments.variance_x /= deviation.x * deviation.x;
  moments.variance_y /= deviation.y * deviation.y;
  moments.covariance /= deviation.x * deviation.y;
  return covariance_ellipse(moments, sigmas);
}

PINNQUAD_BODY double angle_difference_deg(double first_deg, double second_deg) {
  return std::abs(std::remainder(first_deg - second_deg, 180.0));
}

PINNQUAD_BODY std::vector<std::array<double, 2>> ellipse_outline(const ConfidenceEllipse& ellipse, std::size_t points) {
  if (points < 2) throw std::invalid_argument("ellipse_outline: expected at least 2 points");
  const double angle = ellipse.angle_deg * (pi / 180);
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  std::vector<std::array<double, 2>> outline(points);
  for (std::size_t i = 0; i + 1 < points; ++i) {
    const double turn = 2 * pi * static_cast<double>(i) / static_cast<double>(points - 1);
    const double major = ellipse.semi_major * std::cos(turn);
    const double minor = ellipse.semi_minor * std::sin(turn);
    outline[i] = {ellipse.center_x + major * cosine - minor * sine, ellipse.center_y + major * sine + minor * cosine};
  }
  outline.back() = outline.front();
  return outline;
}

PINNQUAD_BODY double slope_error(const std::vector<double>& target_sum, const std::vector<double>& predicted_sum,
                                 const std::vector<double>& angular_acceleration) {
  const double target = joint_moments(target_sum, angular_acceleration).covariance;
  const double predicted = joint_moments(predicted_sum, angular_acceleration).covariance;
  return target == 0 ? not_a_number : std::abs(predicted / target - 1);
}

PINNQUAD_BODY double sign_violation_share(const std::vector<double>& predicted_sum,
                                          const std::vector<double>& angular_acceleration, double above,
                                          const std::vector<std::size_t>& starts) {
  detail::require_equal_length("sign_violation_share", predicted_sum.size(), angular_acceleration.size());
  std::size_t pairs = 0;
  std::size_t violations = 0;
  const std::size_t rows = std::min(predicted_sum.size(), angular_acceleration.size());  // equal; gcc 12 can't see it
  for (std::size_t i = 0; i + 1 < rows; ++i) {
    if (std::binary_search(starts.begin(), starts.end(), i + 1)) continue;
    // by comparison: the product of two small differences could underflow to 0
    const bool large = std::abs(angular_acceleration[i + 1] - angular_acceleration[i]) > above;
    const bool rises = large && angular_acceleration[i + 1] > angular_acceleration[i];
    const bool falls = large && angular_acceleration[i + 1] < angular_acceleration[i];
    const bool sum_rises = predicted_sum[i + 1] > predicted_sum[i];
    const bool sum_falls = predicted_sum[i + 1] < predicted_sum[i];
    if (!rises && !falls) continue;
    if (std::isnan(predicted_sum[i] + predicted_sum[i + 1])) return not_a_number;
    ++pairs;
    violations += (rises && sum_falls) || (falls && sum_rises) ? 1 : 0;
  }
  return pairs == 0 ? not_a_number : static_cast<double>(violations) / static_cast<double>(pairs);
}

PINNQUAD_BODY PhysicalConsistency physical_consistency(const AxisSeries& series) {
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
  result.sign_violation_share = sign_violation_share(series.predicted, x, 0, series.starts);
  return result;
}

}  // namespace pinnquad
