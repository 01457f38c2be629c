// SPDX-License-Identifier: MIT
// Covariance confidence ellipse (CCE) of a cloud of points, drawn at 3 sigma (Figs. 2 and 8), and the angle of its
// principal axis: the paper's "slope (or rotation angle)", whose difference from target to prediction is Delta m.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "pinnquad/evaluation/summary.hpp"

namespace pinnquad {

namespace detail {
inline constexpr double pi = 3.14159265358979323846;
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
inline ConfidenceEllipse covariance_ellipse(const JointMoments& moments, double sigmas = 3) {
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

/// The ellipse of the points (x[i], y[i]), in their units. NaN for fewer than two points.
/// Throws std::invalid_argument for series of different length.
inline ConfidenceEllipse confidence_ellipse(const std::vector<double>& x, const std::vector<double>& y,
                                            double sigmas = 3) {
  return covariance_ellipse(joint_moments(x, y), sigmas);
}

/// Standard deviation along each axis: the units in which a standardised ellipse is measured.
struct AxisDeviation {
  double x = 1;
  double y = 1;
};

/// The standard deviations of the points (x[i], y[i]); to be taken from the target, for the target's and the
/// prediction's ellipse.
inline AxisDeviation axis_deviation(const std::vector<double>& x, const std::vector<double>& y) {
  const JointMoments moments = joint_moments(x, y);
  return {std::sqrt(moments.variance_x), std::sqrt(moments.variance_y)};
}

/// The ellipse of the points (x[i] / deviation.x, y[i] / deviation.y), no unit. With its own deviation a cloud lies at
/// +-45 degrees whatever its correlation; a prediction's angle, in the target's deviation, says how far its slope or
/// sign is off. Deviation: the paper does not say how its axes are scaled; in raw units roll and pitch stay below 1
/// degree, where its differences are 20 to 30 (docs/paper.md, deviation 12). NaN ellipse if a deviation is 0 or NaN.
/// Throws std::invalid_argument for series of different length.
inline ConfidenceEllipse standardized_confidence_ellipse(const std::vector<double>& x, const std::vector<double>& y,
                                                         const AxisDeviation& deviation, double sigmas = 3) {
  JointMoments moments = joint_moments(x, y);
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

}  // namespace pinnquad
