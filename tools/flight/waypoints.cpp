// SPDX-License-Identifier: MIT
#include "flight/waypoints.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "command_line/in_words.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace programs {

namespace {

using Eight = Eigen::Matrix<double, 8, 8>;
using Points = std::vector<std::array<std::array<double, WaypointPath::orders>, WaypointPath::axes>>;

/// k (k - 1) ...: the factor of the derivative of this order of x^k.
double falling(int k, int order) {
  double factor = 1;
  for (int i = 0; i < order; ++i) factor *= k - i;
  return factor;
}

/// Coefficients in x = 0..1 of the value and three derivatives at both ends: the lower four by the first end, the
/// others by what the second end lacks.
const Eight& from_ends() noexcept {
  static const Eight inverse = [] {
    Eigen::Matrix4d lower = Eigen::Matrix4d::Zero(), at_end, of_others;
    for (int order = 0; order < 4; ++order) {
      lower(order, order) = 1 / falling(order, order);
      for (int k = 0; k < 4; ++k) {
        at_end(order, k) = k >= order ? falling(k, order) : 0;
        of_others(order, k) = falling(k + 4, order);
      }
    }
    const Eigen::Matrix4d others = of_others.inverse(), carried = at_end.lazyProduct(lower);
    Eight all = Eight::Zero();
    all.topLeftCorner<4, 4>() = lower;
    all.bottomLeftCorner<4, 4>() = -others.lazyProduct(carried);
    all.bottomRightCorner<4, 4>() = others;
    return all;
  }();
  return inverse;
}

/// Squared snap over x = 0..1 as a quadratic form of the values at both ends.
const Eight& snap_of_ends() noexcept {
  static const Eight cost = [] {
    Eight q = Eight::Zero();
    for (int k = 4; k < 8; ++k) {
      for (int l = 4; l < 8; ++l) q(k, l) = falling(k, 4) * falling(l, 4) / (k + l - 7);
    }
    const Eight product = q.lazyProduct(from_ends());
    return Eight(from_ends().transpose().lazyProduct(product));
  }();
  return cost;
}

Eigen::Matrix<double, 8, 1> ends(const Points& points, std::size_t axis, std::size_t leg, double length_s) noexcept {
  Eigen::Matrix<double, 8, 1> ends;
  double scale = 1;
  for (std::size_t order = 0; order < WaypointPath::orders; ++order, scale *= length_s) {
    ends[static_cast<int>(order)] = scale * points[leg][axis][order];
    ends[static_cast<int>(WaypointPath::orders + order)] = scale * points[leg + 1][axis][order];
  }
  return ends;
}

WaypointPath read_waypoints(const std::string& path) {
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

}  // namespace

pinnquad::TrajectoryPoint<double> WaypointPath::sample(double time_s) const noexcept {
  const double time = std::clamp(time_s, 0.0, duration_s());
  const auto after = std::upper_bound(time_s_.begin() + 1, time_s_.end() - 1, time);
  const auto leg = static_cast<std::size_t>(after - time_s_.begin()) - 1;
  const double length_s = time_s_[leg + 1] - time_s_[leg], x = (time - time_s_[leg]) / length_s;
  std::array<pinnquad::detail::Derivatives<double>, axes> at{};
  for (std::size_t axis = 0; axis < axes; ++axis) {
    const Eigen::Matrix<double, 8, 1> c = from_ends().lazyProduct(ends(points_, axis, leg, length_s));
    for (int order = 0; order < 5; ++order) {
      double sum = 0;
      for (int k = 7; k >= order; --k) sum = sum * x + falling(k, order) * c[k];
      at[axis][static_cast<std::size_t>(order)] = sum / std::pow(length_s, order);
    }
  }
  if (time != time_s) {  // it waits there
    for (auto& derivatives : at) std::fill(derivatives.begin() + 1, derivatives.end(), 0.0);
  }
  return pinnquad::detail::assembled(center_m, at[0], at[1], at[2], at[3]);
}

/// The three derivatives at each point between the ends that make the squared snap least: a sparse linear system, in
/// times over the mean leg.
void WaypointPath::solve(std::size_t axis, const std::vector<Values>& values) {
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

WaypointPath waypoints_for(const std::string& path, const pinnquad::Vector3<double>& center_m, double ground_z_m,
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
