// SPDX-License-Identifier: MIT
// Trajectories of a closed loop that an airframe can fly and a model answers: far above the ground, or near it where a
// model was trained there. A range of motions has `std::optional<double> speed_m_s(axis)`, the largest along a body
// axis, `std::optional<std::pair<double, double>> altitude_m()`, and `bool holds(motion)`.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <random>
#include <utility>

#include "pinnquad/control/flatness.hpp"
#include "pinnquad/control/trajectory.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/features/features.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace programs {

/// Any trajectory behind one type: one loop is compiled.
struct AnyTrajectory {
  std::function<pinnquad::TrajectoryPoint<double>(double)> point;
  pinnquad::TrajectoryPoint<double> sample(double time_s) const noexcept { return point(time_s); }
};

/// Sums of three sines along each axis and of the heading, whose multiples of one period and phases are drawn. Starts
/// at rest.
struct RandomPath {
  pinnquad::Vector3<double> center_m = pinnquad::Vector3<double>::Zero();  ///< NED
  std::array<double, 4> half_size = {4, 4, 0.5, 0.4};                      ///< m; of the heading rad
  std::array<std::array<double, 3>, 4> multiple{}, offset_rad{};
  double period_s = 20, ramp_s = 4;

  explicit RandomPath(std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    for (std::size_t axis = 0; axis < 4; ++axis) {
      for (std::size_t i = 0; i < 3; ++i) {
        multiple[axis][i] = 1 + static_cast<double>(i + pinnquad::uniform_index(engine, 2));
        offset_rad[axis][i] = pinnquad::uniform(engine, 0, 6.283185307179586);
      }
    }
  }
  pinnquad::TrajectoryPoint<double> sample(double time_s) const noexcept {
    const auto phase = pinnquad::detail::smooth_phase(time_s, period_s, ramp_s);
    std::array<pinnquad::detail::Derivatives<double>, 4> sums{};
    for (std::size_t axis = 0; axis < 4; ++axis) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto part =
            pinnquad::detail::harmonic(phase, half_size[axis] / 3, multiple[axis][i], offset_rad[axis][i]);
        for (std::size_t order = 0; order < part.size(); ++order) sums[axis][order] += part[order];
      }
    }
    return pinnquad::detail::assembled(center_m, sums[0], sums[1], sums[2], sums[3]);
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

constexpr double far_above_ground_m = 20;
constexpr double least_altitude_m = 0.1;  ///< the margin of an envelope may reach below the ground
constexpr double longest_period_s = 60;

/// True where the range holds every motion along the trajectory, to a fiftieth of a period.
template <class Trajectory, class Range>
bool is_held(const Trajectory& trajectory, double ground_z_m, const Range& range) {
  for (double time_s = 0; time_s < trajectory.ramp_s + trajectory.period_s; time_s += 0.02 * trajectory.period_s) {
    const auto point = trajectory.sample(time_s);
    pinnquad::FlatMotion<double> flat;
    if (pinnquad::flat_motion(point, pinnquad::standard_gravity_m_s2<double>, flat) != pinnquad::Status::ok) {
      return false;
    }
    pinnquad::MotionInputsWithAltitude<double> motion;
    motion.attitude = flat.attitude;
    motion.body_rates_rad_s = flat.body_rates_rad_s;
    motion.angular_acceleration_rad_s2 = flat.angular_acceleration_rad_s2;
    motion.velocity_m_s = pinnquad::world_to_body(flat.attitude, point.velocity_m_s);
    motion.linear_acceleration_m_s2 = pinnquad::world_to_body(flat.attitude, point.acceleration_m_s2) -
                                      pinnquad::cross<double>(flat.body_rates_rad_s, motion.velocity_m_s);
    motion.altitude_m = ground_z_m - point.position_m[2];
    if (!range.holds(motion)) return false;
  }
  return true;
}

/// The fastest from its period on that the range holds. False if not even a slow one is.
template <class Trajectory, class Range>
bool slow_down(Trajectory& trajectory, double ground_z_m, const Range& range) {
  constexpr double slower = 1.05;
  for (; trajectory.period_s < longest_period_s; trajectory.period_s *= slower) {
    if (is_held(trajectory, ground_z_m, range)) return true;
  }
  return false;
}

/// The middle of a trajectory, NED: far above the ground, or near it in the middle of the range's heights.
template <class Range>
pinnquad::Vector3<double> center_for(double ground_z_m, const Range& range) {
  double down_m = -far_above_ground_m;
  if (const auto altitude = range.altitude_m()) {
    const double lowest = std::max(altitude->first, least_altitude_m);
    down_m = ground_z_m - (lowest + 0.45 * (altitude->second - lowest));
  }
  return {0, 0, down_m};
}
/// How far it may rise and sink about that middle.
inline double half_height_m(const std::pair<double, double>& altitude_m) {
  return 0.35 * (altitude_m.second - std::max(altitude_m.first, least_altitude_m));
}

/// As large beside the usual trajectory as the range's speed along that axis beside 4 m/s.
template <class Range>
double size_along(const Range& range, std::size_t axis) {
  constexpr double usual_m_s = 4;
  return std::clamp(range.speed_m_s(axis).value_or(usual_m_s) / usual_m_s, 0.05, 1.0);
}

}  // namespace detail

/// A figure-eight, the fastest from `shortest_s` on. Near the ground it rises and sinks over most of the heights of the
/// range. None if the range holds none, however slow.
template <class Range>
std::optional<pinnquad::FigureEight<double>> eight_for(const pinnquad::Airframe<double>& airframe, double ground_z_m,
                                                       const Range& range, std::optional<double> shortest_s = {}) {
  pinnquad::FigureEight<double> eight;
  eight.center_m = detail::center_for(ground_z_m, range);
  const double size = detail::size_along(range, 0);
  eight.half_length_m *= size;
  eight.half_width_m *= detail::size_along(range, 1);
  eight.half_height_m *= detail::size_along(range, 2);
  eight.period_s = shortest_s.value_or(eight.period_s * std::sqrt(size));
  if (const auto altitude = range.altitude_m()) {
    eight.half_height_m = detail::half_height_m(*altitude);
    eight.half_length_m = std::min(eight.half_length_m, 1.0);
    eight.half_width_m = std::min(eight.half_width_m, 0.5);
    eight.period_s = 4;
  }
  eight.period_s = std::max(eight.period_s, detail::least_period_s(airframe, 4 * eight.half_width_m));
  if (!detail::slow_down(eight, ground_z_m, range)) return {};
  return eight;
}

/// One in 14/15 of the time, whose nose swings by 0.5 rad.
inline pinnquad::FigureEight<double> with_yaw(pinnquad::FigureEight<double> eight) {
  eight.yaw_amplitude_rad = 0.5;
  eight.period_s *= 14.0 / 15.0;
  return eight;
}

/// A level circle, near the ground in the middle of the heights.
template <class Range>
std::optional<pinnquad::Circle<double>> circle_for(const pinnquad::Airframe<double>& airframe, double ground_z_m,
                                                   const Range& range) {
  pinnquad::Circle<double> circle;
  circle.center_m = detail::center_for(ground_z_m, range);
  const double size = std::min(detail::size_along(range, 0), detail::size_along(range, 1));
  circle.radius_m *= size;
  circle.period_s *= std::sqrt(size);
  if (range.altitude_m()) {
    circle.radius_m = std::min(circle.radius_m, 1.0);
    circle.period_s = 4;
  }
  circle.period_s = std::max(circle.period_s, detail::least_period_s(airframe, circle.radius_m));
  if (!detail::slow_down(circle, ground_z_m, range)) return {};
  return circle;
}

/// A random path by its seed, near the ground in the middle of the heights.
template <class Range>
std::optional<RandomPath> random_path_for(const pinnquad::Airframe<double>& airframe, double ground_z_m,
                                          const Range& range, std::uint64_t seed) {
  RandomPath path(seed);
  path.center_m = detail::center_for(ground_z_m, range);
  for (std::size_t axis = 0; axis < 3; ++axis) path.half_size[axis] *= detail::size_along(range, axis);
  if (const auto altitude = range.altitude_m()) path.half_size = {1, 1, detail::half_height_m(*altitude), 0.4};
  path.period_s = std::max(path.period_s, detail::least_period_s(airframe, 9 * path.half_size[0]));
  if (!detail::slow_down(path, ground_z_m, range)) return {};
  return path;
}

}  // namespace programs
