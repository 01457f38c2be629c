// SPDX-License-Identifier: MIT
// A trajectory of one's own: the smoothest path through points of a CSV file, at rest at both ends.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "command_line/in_words.hpp"
#include "pinnquad/control/trajectory.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

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
  pinnquad::TrajectoryPoint<double> sample(double time_s) const noexcept {
    const double time = std::clamp(time_s, 0.0, duration_s());
    const auto after = std::upper_bound(time_s_.begin() + 1, time_s_.end() - 1, time);
    const auto leg = static_cast<std::size_t>(after - time_s_.begin()) - 1;
    const double length_s = time_s_[leg + 1] - time_s_[leg], x = (time - time_s_[leg]) / length_s;
    std::array<pinnquad::detail::Derivatives<double>, axes> at{};
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const Eigen::Matrix<double, 8, 1> c = from_ends() * ends(axis, leg, length_s);
      for (int order = 0; order < 5; ++order) {
        double sum = 0;
        for (int k = 7; k >= order; --k) {
          double factor = 1;
          for (int i = 0; i < order; ++i) factor *= k - i;
          sum = sum * x + factor * c[k];
        }
        at[axis][static_cast<std::size_t>(order)] = sum / std::pow(length_s, order);
      }
    }
    if (time != time_s) {  // it waits there
      for (auto& derivatives : at) std::fill(derivatives.begin() + 1, derivatives.end(), 0.0);
    }
    return pinnquad::detail::assembled(center_m, at[0], at[1], at[2], at[3]);
  }

  pinnquad::Vector3<double> center_m = pinnquad::Vector3<double>::Zero();  ///< NED, where the file has 0, 0, 0

 private:
  using Eight = Eigen::Matrix<double, 8, 8>;

  /// Coefficients in x = 0..1 of the value and three derivatives at both ends.
  static const Eight& from_ends() noexcept {
    static const Eight inverse = [] {
      Eight ends = Eight::Zero();
      for (int order = 0; order < 4; ++order) {
        for (int k = order; k < 8; ++k) {
          double factor = 1;
          for (int i = 0; i < order; ++i) factor *= k - i;
          if (k == order) ends(order, k) = factor;
          ends(4 + order, k) = factor;
        }
      }
      return Eight(ends.inverse());
    }();
    return inverse;
  }

  /// Squared snap over x = 0..1 as a quadratic form of the values at both ends.
  static const Eight& snap_of_ends() noexcept {
    static const Eight cost = [] {
      Eight q = Eight::Zero();
      for (int k = 4; k < 8; ++k) {
        for (int l = 4; l < 8; ++l) {
          const auto falling = [](int n) { return static_cast<double>(n * (n - 1) * (n - 2) * (n - 3)); };
          q(k, l) = falling(k) * falling(l) / (k + l - 7);
        }
      }
      return Eight(from_ends().transpose() * q * from_ends());
    }();
    return cost;
  }

  Eigen::Matrix<double, 8, 1> ends(std::size_t axis, std::size_t leg, double length_s) const noexcept {
    Eigen::Matrix<double, 8, 1> ends;
    double scale = 1;
    for (std::size_t order = 0; order < orders; ++order, scale *= length_s) {
      ends[static_cast<int>(order)] = scale * points_[leg][axis][order];
      ends[static_cast<int>(orders + order)] = scale * points_[leg + 1][axis][order];
    }
    return ends;
  }

  /// The three derivatives at each point between the ends that make the squared snap least: a sparse linear system, in
  /// times over the mean leg.
  void solve(std::size_t axis, const std::vector<Values>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) points_[i][axis][0] = values[i][axis];
    const int inner = static_cast<int>(values.size()) - 2;
    if (inner == 0) return;
    const double mean_s = duration_s() / (inner + 1);
    std::vector<Eigen::Triplet<double>> cost;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(3 * inner);
    for (int leg = 0; leg <= inner; ++leg) {
      const auto at = static_cast<std::size_t>(leg);
      const double length = (time_s_[at + 1] - time_s_[at]) / mean_s;
      const auto unknown = [&](int i) { return i % 4 == 0 ? -1 : 3 * (leg - 1 + i / 4) + i % 4 - 1; };
      const auto is_free = [&](int i) { return unknown(i) >= 0 && unknown(i) < 3 * inner && leg - 1 + i / 4 >= 0; };
      for (int i = 0; i < 8; ++i) {
        if (!is_free(i)) continue;
        for (int j = 0; j < 8; ++j) {
          const double weight = snap_of_ends()(i, j) * std::pow(length, i % 4 + j % 4 - 7);
          if (is_free(j)) cost.emplace_back(unknown(i), unknown(j), weight);
          if (j % 4 == 0) right[unknown(i)] -= weight * values[at + static_cast<std::size_t>(j / 4)][axis];
        }
      }
    }
    Eigen::SparseMatrix<double> matrix(3 * inner, 3 * inner);
    matrix.setFromTriplets(cost.begin(), cost.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    const Eigen::VectorXd found = solver.solve(right);
    if (solver.info() != Eigen::Success || !found.allFinite()) {
      throw std::invalid_argument("no smooth path leads through these points: legs of more alike durations");
    }
    for (int i = 0; i < inner; ++i) {
      double scale = 1;
      for (int order = 1; order < 4; ++order) {
        scale *= mean_s;
        points_[static_cast<std::size_t>(i + 1)][axis][static_cast<std::size_t>(order)] =
            found[3 * i + order - 1] / scale;
      }
    }
  }

  std::vector<double> time_s_;
  std::vector<std::array<std::array<double, orders>, axes>> points_;
};

/// Reads columns t (s, rising), x, y, z (m: north, east, down) and, where there is one, yaw (rad): at most 10,000 rows
/// and ten minutes. Throws InputError.
inline WaypointPath read_waypoints(const std::string& path) {
  constexpr double longest_s = 600, farthest_m = 1e4, half_turn_rad = 3.2;
  constexpr std::size_t most_rows = 10'000;
  std::vector<std::string> columns = {"t", "x", "y", "z"};
  const std::vector<std::string> header = pinnquad::detail::csv_header(path);
  const bool has_yaw = std::find(header.begin(), header.end(), "yaw") != header.end();
  if (has_yaw) columns.push_back("yaw");
  std::vector<double> time_s;
  std::vector<WaypointPath::Values> values;
  double begin_s = 0;
  pinnquad::detail::for_each_csv_row(path, columns, 2, [&](const auto& row, std::size_t line, const auto& fields) {
    const auto require = [&](bool good, std::size_t column, const std::string& expected) {
      if (good) return;
      throw pinnquad::InputError(path, line, fields[column] + 1, expected, in_words("%g", row[column]));
    };
    if (time_s.empty()) begin_s = row[0];
    const double since_s = row[0] - begin_s;
    require(time_s.empty() || since_s > time_s.back(), 0, "a time in s after that of the row before");
    require(since_s <= longest_s, 0, in_words("a time in s, at most %g after the first", longest_s));
    require(values.size() < most_rows, 0, in_words("at most %zu rows", most_rows));
    for (std::size_t i = 1; i < 4; ++i) require(std::abs(row[i]) <= farthest_m, i, "m, at most 10 km");
    const double yaw_rad = has_yaw ? row[4] : 0;
    const double before_rad = values.empty() ? yaw_rad : values.back()[3];
    if (has_yaw) require(std::abs(yaw_rad - before_rad) <= half_turn_rad, 4, "rad, at most half a turn a row");
    time_s.push_back(since_s);
    values.push_back({row[1], row[2], row[3], yaw_rad});
  });
  return WaypointPath(std::move(time_s), values);
}

/// The file's path about `center_m`. Throws InputError where it meets the ground or asks for more than the rotors lift:
/// at the row to which it then flies.
inline WaypointPath waypoints_for(const std::string& path, const pinnquad::Vector3<double>& center_m, double ground_z_m,
                                  const pinnquad::Airframe<double>& airframe) {
  constexpr double step_s = 0.01;
  const double gravity = pinnquad::standard_gravity_m_s2<double>, most = airframe.thrust_to_weight();
  WaypointPath read = read_waypoints(path);
  read.center_m = center_m;
  for (double time_s = 0; time_s <= read.duration_s(); time_s += step_s) {
    const pinnquad::TrajectoryPoint<double> point = read.sample(time_s);
    const auto& times = read.times_s();
    const auto next = std::upper_bound(times.begin(), times.end() - 1, time_s);
    const std::size_t line = static_cast<std::size_t>(next - times.begin()) + 2;  // the header is 1
    if (point.position_m[2] >= ground_z_m) {
      throw pinnquad::InputError(path, line, 0,
                                 in_words("a path above the ground, which is at z = %.4g m", ground_z_m - center_m[2]),
                                 in_words("z = %.4g m", point.position_m[2] - center_m[2]));
    }
    pinnquad::Vector3<double> force = point.acceleration_m_s2;
    force[2] -= gravity;
    if (force.norm() > most * gravity) {
      throw pinnquad::InputError(
          path, line, 0, in_words("a path for which rotors lift %.2g times the weight", most),
          in_words("one that asks for %.3g times on the way to this row: give it more time", force.norm() / gravity));
    }
  }
  return read;
}

}  // namespace programs
