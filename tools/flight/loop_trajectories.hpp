// SPDX-License-Identifier: MIT
// Trajectories of a closed loop that an airframe can fly: far above the ground, or near it where a model was trained
// there.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

#include "pinnquad/control/trajectory.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace programs {

/// Where a model that is shown the altitude was trained.
struct NearGround {
  double lowest_m = 0, highest_m = 0;  ///< altitude, its envelope
  /// Of the body velocity, the largest either way in its envelope; none of a component that it is not shown.
  std::array<std::optional<double>, 3> reach_m_s{};

  /// Takes a feature's envelope, if it says something of that.
  void take(std::string_view feature, double lower, double upper) {
    constexpr std::array<std::string_view, 3> velocity = {"v_bx", "v_by", "v_bz"};
    if (feature == "altitude") {
      lowest_m = lower;
      highest_m = upper;
    }
    for (std::size_t axis = 0; axis < velocity.size(); ++axis) {
      if (feature == velocity[axis]) reach_m_s[axis] = std::min(upper, -lower);
    }
  }
};

namespace detail {

/// The shortest period in which the largest sideways acceleration, `factor_m` times the square of the rate, stays
/// within 40 % of what thrust beyond hover allows.
inline double least_period_s(const pinnquad::Airframe<double>& airframe, double factor_m) {
  constexpr double turn = 6.283185307179586;
  const double thrust_to_weight = airframe.thrust_to_weight();
  const double sideways =
      pinnquad::standard_gravity_m_s2<double> * std::sqrt(std::max(0.01, thrust_to_weight * thrust_to_weight - 1));
  return turn / std::sqrt(0.4 * sideways / factor_m);
}

/// The shortest period, of 4 s or more, in which motions of these amplitudes along each axis stay in half of a model's
/// envelope: the feedback adds to what is planned.
inline double least_period_s(const NearGround& range, const std::array<double, 3>& amplitude_m) {
  constexpr double turn = 6.283185307179586, share = 0.5;
  double period_s = 4;
  for (std::size_t axis = 0; axis < amplitude_m.size(); ++axis) {
    if (!range.reach_m_s[axis]) continue;
    period_s = std::max(period_s, turn * amplitude_m[axis] / (share * *range.reach_m_s[axis]));
  }
  return period_s;
}

constexpr double far_above_ground_m = 20;
constexpr double least_altitude_m = 0.1;  ///< the margin of an envelope may reach below the ground

}  // namespace detail

/// A figure-eight. Near the ground it rises and sinks over most of the heights that the model was trained at, as slowly
/// as its envelope asks for.
inline pinnquad::FigureEight<double> eight_for(const pinnquad::Airframe<double>& airframe, double ground_z_m,
                                               const std::optional<NearGround>& range) {
  pinnquad::FigureEight<double> eight;
  eight.center_m = {0, 0, -detail::far_above_ground_m};
  if (range) {
    const double lowest = std::max(range->lowest_m, detail::least_altitude_m);
    eight.center_m[2] = ground_z_m - (lowest + 0.45 * (range->highest_m - lowest));
    eight.half_height_m = 0.35 * (range->highest_m - lowest);
    eight.half_length_m = 1;
    eight.half_width_m = 0.5;
    eight.period_s = detail::least_period_s(*range, {eight.half_length_m, 2 * eight.half_width_m, eight.half_height_m});
  }
  eight.period_s = std::max(eight.period_s, detail::least_period_s(airframe, 4 * eight.half_width_m));
  return eight;
}

/// A level circle, near the ground in the middle of the heights.
inline pinnquad::Circle<double> circle_for(const pinnquad::Airframe<double>& airframe, double ground_z_m,
                                           const std::optional<NearGround>& range) {
  pinnquad::Circle<double> circle;
  circle.center_m = {0, 0, -detail::far_above_ground_m};
  if (range) {
    const double lowest = std::max(range->lowest_m, detail::least_altitude_m);
    circle.center_m[2] = ground_z_m - (lowest + 0.45 * (range->highest_m - lowest));
    circle.radius_m = 1;
    circle.period_s = detail::least_period_s(*range, {circle.radius_m, circle.radius_m, 0});
  }
  circle.period_s = std::max(circle.period_s, detail::least_period_s(airframe, circle.radius_m));
  return circle;
}

}  // namespace programs
