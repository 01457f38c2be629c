// SPDX-License-Identifier: MIT
#include "logs/derived_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "logs/savitzky_golay.hpp"
#include "pinnquad/data/plausibility.hpp"
#include "pinnquad/dynamics/airframe.hpp"

namespace pinnquad::logs {
namespace {

using Series3 = std::array<std::vector<double>, 3>;

bool present(const Series3& series) { return !series[0].empty(); }

/// Runs of rows with a value and without a gap.
std::vector<IndexRange> finite_runs(const CommonRows& rows, const std::vector<double>& values) {
  std::vector<IndexRange> runs;
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    if (!std::isfinite(values[row])) continue;
    const bool follows =
        !runs.empty() && runs.back().end == row && rows.time_s[row] - rows.time_s[row - 1] <= 1.5 * rows.period_s;
    if (!follows) runs.push_back({row, row});
    runs.back().end = row + 1;
  }
  return runs;
}

/// The derivative of each axis by Savitzky-Golay; NaN where the window reaches beyond a run of rows.
Series3 derivative(const CommonRows& rows, const Series3& series, int order, const std::string& what, LogRows& result) {
  Series3 derived;
  std::string told = what + " by Savitzky-Golay, rows (order):";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<IndexRange> runs = finite_runs(rows, series[axis]);
    const SavitzkyGolay filter = choose_savitzky_golay(series[axis], runs, rows.period_s, order).filter;
    derived[axis] = savitzky_golay(series[axis], runs, rows.period_s, filter, order);
    const std::size_t edge = edge_rows(filter);
    for (const IndexRange& run : runs) {
      for (std::size_t row = run.begin; row < run.end; ++row) {
        if (row - run.begin < edge || run.end - row <= edge) derived[axis][row] = std::nan("");
      }
    }
    told += (axis > 0 ? ", " : " ") + std::to_string(2 * filter.half_window + 1) + " (" + std::to_string(filter.order) +
            ")";
  }
  result.told.push_back(told);
  return derived;
}

Quaternion<double> attitude_at(const CommonRows& rows, std::size_t row) {
  const auto& q = rows.attitude;
  return normalized(Quaternion<double>{q[0][row], q[1][row], q[2][row], q[3][row]});
}

Vector3<double> at(const Series3& series, std::size_t row) { return {series[0][row], series[1][row], series[2][row]}; }

/// Each row turned by `turn(attitude, vector)`.
template <class Turn>
Series3 turned(const CommonRows& rows, const Series3& series, const Turn& turn) {
  Series3 result;
  for (std::vector<double>& axis : result) axis.resize(rows.rows());
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    const Vector3<double> v = turn(attitude_at(rows, row), at(series, row));
    for (std::size_t axis = 0; axis < 3; ++axis) result[axis][row] = v[static_cast<Eigen::Index>(axis)];
  }
  return result;
}

Series3 in_body(const CommonRows& rows, const Series3& world) {
  return turned(rows, world, [](const auto& q, const auto& v) { return world_to_body<double>(q, v); });
}

Series3 in_world(const CommonRows& rows, const Series3& body) {
  return turned(rows, body, [](const auto& q, const auto& v) { return body_to_world<double>(q, v); });
}

/// Gravity in the body's axes, R^T g.
Vector3<double> gravity(const Quaternion<double>& attitude) {
  return world_down_axis(attitude) * standard_gravity_m_s2<double>;
}

/// a - R^T g of a kinematic acceleration in the body's axes.
Series3 force_of(const CommonRows& rows, const Series3& acceleration_body) {
  return turned(rows, acceleration_body, [](const auto& q, const auto& a) { return Vector3<double>(a - gravity(q)); });
}

Axes axes_of(const BoundLog& log, Quantity quantity) { return log.of(quantity).source->axes; }

}  // namespace

double ground_height(const CommonRows& rows, const std::vector<double>& height, const Mapping& mapping,
                     LogRows& result) {
  if (!mapping.ground_from_log) return mapping.ground_m;
  std::vector<double> before;
  bool flew = false;
  for (std::size_t row = 0; row < rows.rows() && !flew; ++row) {
    if (!std::isfinite(height[row])) continue;
    flew = rows.landed.empty() || !(rows.landed[row] > 0.5);
    if (!flew) before.push_back(height[row]);
  }
  if (!before.empty()) {
    const double ground = detail::median_of(before);
    result.told.push_back("ground at " + number_text(std::round(ground * 1000) / 1000) +
                          " m of the log's heights, as before take-off");
    return ground;
  }
  double lowest = std::numeric_limits<double>::infinity();
  for (const double h : height) {
    if (std::isfinite(h)) lowest = std::min(lowest, h);
  }
  result.told.push_back("ground at the lowest height of the log, which has no row on the ground before take-off");
  return std::isfinite(lowest) ? lowest : 0;
}

LogRows rows_of_log(CommonRows rows, const BoundLog& log, const Mapping& mapping, const std::string& source) {
  using namespace detail;
  LogRows result;
  const bool derived_turning = !present(rows.angular_acceleration);
  if (derived_turning) {
    rows.angular_acceleration = derivative(rows, rows.body_rates, 1, "angular acceleration of body rates", result);
  }
  Series3 velocity_world;
  if (present(rows.velocity)) {
    if (axes_of(log, Quantity::velocity) == Axes::world) {
      velocity_world = rows.velocity;
      rows.velocity = in_body(rows, rows.velocity);
    }
  } else if (present(rows.position)) {
    velocity_world = derivative(rows, rows.position, 1, "velocity of positions", result);
    rows.velocity = in_body(rows, velocity_world);
  }
  result.has_velocity = present(rows.velocity);
  if (!present(rows.specific_force)) {
    Series3 acceleration;
    if (present(rows.acceleration)) {
      const bool world = axes_of(log, Quantity::acceleration) == Axes::world;
      acceleration = world ? in_body(rows, rows.acceleration) : rows.acceleration;
    } else if (result.has_velocity) {
      result.force_of_velocity = true;
      if (!present(velocity_world)) velocity_world = in_world(rows, rows.velocity);
      acceleration = in_body(rows, derivative(rows, velocity_world, 1, "acceleration of velocities", result));
    } else {
      throw InputError(mapping.file, 1, 1, "[specific_force], [acceleration], [velocity] or [position] in " + source,
                       "none of them");
    }
    rows.specific_force = force_of(rows, acceleration);
  }
  std::vector<double> height = rows.altitude;
  if (height.empty() && present(rows.position)) {
    for (const double z : rows.position[2]) height.push_back(-z);
  }
  result.has_altitude = !height.empty();
  velocity_world = {};  // of a long log nothing is held longer than it is read
  rows.position = {};
  const double ground_m = result.has_altitude ? ground_height(rows, height, mapping, result) : 0;

  std::vector<ExtraColumn> extras;
  for (const BoundExtra& extra : log.extras) {
    ExtraColumn column;
    column.name = extra.extra->name;
    column.unit = extra.extra->unit;
    extras.push_back(column);
  }
  for (ExtraColumn& column : extras) result.flight.add_column(std::move(column));
  result.flight.reserve(rows.rows());
  std::vector<double> extra_values(rows.extras.size());
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    bool whole = std::isfinite(rows.time_s[row]);
    const auto check = [&whole, row](const auto& series) {
      for (const std::vector<double>& one : series) whole = whole && (one.empty() || std::isfinite(one[row]));
    };
    check(rows.attitude);
    check(rows.commands);
    check(rows.body_rates);
    check(rows.specific_force);
    check(rows.velocity);
    check(rows.extras);
    whole = whole && (height.empty() || std::isfinite(height[row]));
    const bool before_windows = whole;
    check(rows.angular_acceleration);
    if (!whole) {
      ++(before_windows && derived_turning ? result.window_ends : result.incomplete);
      continue;
    }
    const Quaternion<double> q = attitude_at(rows, row);
    const EulerAngles<double> angles = to_euler(q);
    Sample sample;
    sample.time_s = rows.time_s[row];
    sample.body_rates_rad_s = at(rows.body_rates, row);
    sample.angular_acceleration_rad_s2 = at(rows.angular_acceleration, row);
    if (result.has_velocity) sample.velocity_m_s = at(rows.velocity, row);
    sample.linear_acceleration_m_s2 =
        at(rows.specific_force, row) + gravity(q) - cross<double>(sample.body_rates_rad_s, sample.velocity_m_s);
    sample.roll_rad = angles.roll_rad;
    sample.pitch_rad = angles.pitch_rad;
    sample.yaw_rad = angles.yaw_rad;
    if (result.has_altitude) sample.altitude_m = height[row] - ground_m;
    for (std::size_t i = 0; i < sample.commands.size(); ++i)
      sample.commands[i] = std::clamp(rows.commands[i][row], 0.0, 1.0);
    for (std::size_t i = 0; i < extra_values.size(); ++i) extra_values[i] = rows.extras[i][row];
    result.flight.push_back(sample, extra_values.data(), extra_values.size());
    if (!rows.landed.empty()) result.landed.push_back(rows.landed[row] > 0.5);
  }
  return result;
}

}  // namespace pinnquad::logs
