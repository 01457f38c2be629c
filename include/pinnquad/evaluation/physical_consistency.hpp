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

#include "pinnquad/core/body.hpp"
#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/evaluation/summary.hpp"

namespace pinnquad {

namespace detail {
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
ConfidenceEllipse covariance_ellipse(const detail::JointMoments& moments, double sigmas = 3);

/// The standard deviations of the points (x[i], y[i]); to be taken from the target, for the target's and the
/// prediction's ellipse.
detail::AxisDeviation axis_deviation(const std::vector<double>& x, const std::vector<double>& y);

/// The ellipse of the points (x[i] / deviation.x, y[i] / deviation.y): by default in their own units, with a deviation
/// standardised. In its own deviation a cloud lies at +-45 degrees whatever its correlation; in the target's, the angle
/// of a prediction says how far its slope or sign is off. Deviation: the paper does not say how its axes are scaled; in
/// raw units roll and pitch stay below 1 degree, where its differences are 20 to 30 (docs/paper.md, deviation 12). NaN
/// for fewer than two points and for a deviation of 0 or NaN.
/// Throws std::invalid_argument for series of different length.
ConfidenceEllipse confidence_ellipse(const std::vector<double>& x, const std::vector<double>& y, double sigmas = 3,
                                     const detail::AxisDeviation& deviation = {});

/// Angle between two axes (not directions), degrees, 0..90: |a - b| folded, so that 89 and -89 are 2 degrees apart.
double angle_difference_deg(double first_deg, double second_deg);

/// Points (x, y) on the outline for a plot, equally spaced in the ellipse's own angle, from the tip of the major axis
/// round to the same point again: `points` of them, the last equal to the first. Throws std::invalid_argument below 2.
std::vector<std::array<double, 2>> ellipse_outline(const ConfidenceEllipse& ellipse, std::size_t points = 73);

/// |cov(S_predicted, omega_dot) / cov(S_target, omega_dot) - 1|: the relative error of the regression slope of S on
/// omega_dot; 0 is perfect, no unit. NaN if the target does not covary or there are fewer than two rows.
/// Throws std::invalid_argument for series of different length.
double slope_error(const std::vector<double>& target_sum, const std::vector<double>& predicted_sum,
                   const std::vector<double>& angular_acceleration);

/// Share of consecutive pairs of rows in which the predicted sum moves against the angular acceleration:
///   #{i : dS_i d_omega_dot_i < 0} / #{i : d_omega_dot_i != 0},   d x_i = x_{i+1} - x_i,  i = 0 .. n-2
/// A sum that stands still is no violation. Rows must be in time order. Twice this share is the local monotonicity loss
/// (Alg. 1) with the sign as step if no difference is 0. NaN if no pair counts, or if a sum of one that counts is NaN.
/// `above`: pairs count whose |d_omega_dot_i| is larger, rad/s^2. `starts`: rows in order that do not follow the row
/// before, as the first one of a flight.
/// Throws std::invalid_argument for series of different length.
double sign_violation_share(const std::vector<double>& predicted_sum, const std::vector<double>& angular_acceleration,
                            double above = 0, const std::vector<std::size_t>& starts = {});

/// Signed command sum and angular acceleration about one axis, row by row, in time order.
struct AxisSeries {
  std::vector<double> angular_acceleration;  ///< rad/s^2
  std::vector<double> target;                ///< sum of the flown commands
  std::vector<double> predicted;
  std::vector<std::size_t> starts{};  ///< rows that do not follow the row before
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
PhysicalConsistency physical_consistency(const AxisSeries& series);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/evaluation/impl/physical_consistency.hpp"
#endif
