// SPDX-License-Identifier: MIT
// A trajectory of one's own: the smoothest path through points of a CSV file, at rest at both ends.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/control/trajectory.hpp"
#include "pinnquad/dynamics/airframe.hpp"

namespace programs {

/// True for a trajectory that is a file's name.
inline bool is_waypoint_file(const std::string& trajectory) {
  constexpr std::size_t ending = 4;
  return trajectory.size() > ending && trajectory.compare(trajectory.size() - ending, ending, ".csv") == 0;
}

/// Position and yaw through points at given times: polynomials of degree 7 whose integral of squared snap is least, so
/// six derivatives are continuous (minimum snap: Mellinger and Kumar, ICRA 2011). At rest before the first and after
/// the last point. Immutable.
class WaypointPath {
 public:
  static constexpr std::size_t axes = 4;    ///< north, east, down, m; yaw, rad
  static constexpr std::size_t orders = 4;  ///< value, first, second, third derivative at a point
  using Values = std::array<double, axes>;

  /// `time_s` rises from 0; as many values as times, two at least.
  WaypointPath(std::vector<double> time_s, const std::vector<Values>& values)
      : time_s_(std::move(time_s)), points_(values.size()) {
    for (std::size_t axis = 0; axis < axes; ++axis) solve(axis, values);
  }

  double duration_s() const noexcept { return time_s_.back(); }
  const std::vector<double>& times_s() const noexcept { return time_s_; }

  /// The point at a time, NED about `center_m`.
  pinnquad::TrajectoryPoint<double> sample(double time_s) const noexcept;

  pinnquad::Vector3<double> center_m = pinnquad::Vector3<double>::Zero();  ///< NED, where the file has 0, 0, 0

 private:
  void solve(std::size_t axis, const std::vector<Values>& values);

  std::vector<double> time_s_;
  std::vector<std::array<std::array<double, orders>, axes>> points_;
};

/// Reads columns t (s, rising), x, y, z (m: north, east, down) and, where there is one, yaw (rad): at most 10,000 rows
/// and ten minutes; the path about `center_m`. Throws InputError, also where it meets the ground or asks for more than
/// the rotors lift: at the row to which it then flies.
WaypointPath waypoints_for(const std::string& path, const pinnquad::Vector3<double>& center_m, double ground_z_m,
                           const pinnquad::Airframe<double>& airframe);

}  // namespace programs
