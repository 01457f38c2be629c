// SPDX-License-Identifier: MIT
// Checks that a flight can be one: per column its unit and physical range, a robust search for cells that fit no
// neighbour, and the mistakes that logs have: commands as pulse widths or percent, columns that the motion contradicts.
// A network trains on nonsense without complaint, and then flies it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/motion_checks.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/exported/model_agreement.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/io/file_error.hpp"

namespace pinnquad {

namespace detail {

/// The values that a column of `sample_field_names` may hold: all that any multirotor can reach.
struct ColumnPlausibility {
  const char* unit;
  double lowest;
  double highest;
  /// Least robust deviation, for a column that hardly varies. 0: no outliers are sought.
  double smallest_scale;
};

}  // namespace detail

/// Per column, in the order of `sample_field_names`. Angles may be unwrapped. Commands are 0 to 1, with a float's
/// rounding to spare.
// clang-format off
inline constexpr std::array<detail::ColumnPlausibility, sample_value_count> column_plausibility = {{
    {"s", -1e12, 1e12, 0},
    {"m/s^2", -1000, 1000, 1}, {"m/s^2", -1000, 1000, 1}, {"m/s^2", -1000, 1000, 1},
    {"rad/s^2", -1e5, 1e5, 20}, {"rad/s^2", -1e5, 1e5, 20}, {"rad/s^2", -1e5, 1e5, 20},
    {"m/s", -200, 200, 0.1}, {"m/s", -200, 200, 0.1}, {"m/s", -200, 200, 0.1},
    {"rad/s", -100, 100, 0.2}, {"rad/s", -100, 100, 0.2}, {"rad/s", -100, 100, 0.2},
    {"rad", -1e4, 1e4, 0.25}, {"rad", -1e4, 1e4, 0.25}, {"rad", -1e4, 1e4, 0.25},
    {"m", -1000, 20000, 0.1},
    {"1", -1e-6, 1 + 1e-6, 0}, {"1", -1e-6, 1 + 1e-6, 0}, {"1", -1e-6, 1 + 1e-6, 0}, {"1", -1e-6, 1 + 1e-6, 0}}};
// clang-format on

/// A cell further than this many robust deviations from its column's median, both of whose neighbours in time are not
/// half as far, is no measurement: motion lasts longer than a row. The paper's pilots, an independent simulator and
/// real logs stay below 8, an angle that wraps round below 26.
inline constexpr double most_robust_deviations = 30;

namespace detail {

inline constexpr std::size_t first_command_field = 17;

inline std::vector<double> column_of(const Flight& flight, std::size_t field) {
  std::vector<double> column;
  column.reserve(flight.size());
  for (const Sample& sample : flight) column.push_back(to_values(sample)[field]);
  return column;
}

/// The upper median of a series that is not empty.
inline double median_of(std::vector<double> series) {
  const auto middle = series.begin() + static_cast<std::ptrdiff_t>(series.size() / 2);
  std::nth_element(series.begin(), middle, series.end());
  return *middle;
}

/// The likely unit of commands outside 0..1, and how to convert them; empty if unknown. Nine cells in ten decide: a
/// single wrong cell does not hide the rest.
inline std::string command_mistake(const Flight& flight) {
  std::vector<double> cells;
  for (const Sample& sample : flight) cells.insert(cells.end(), sample.commands.begin(), sample.commands.end());
  const std::size_t cut = cells.size() / 20;
  std::sort(cells.begin(), cells.end());
  const double low = cells[cut], high = cells[cells.size() - 1 - cut];
  if (low >= 0 && high <= 1) return "";
  if (low >= 800 && high <= 2200) return "pulse widths of 1000 to 2000 us? Then write (u - 1000) / 1000";
  if (low >= -1 && high <= 0) return "negated? Then write -u";
  if (low >= 0 && high <= 100) return "percent? Then write u / 100";
  if (low >= 0 && high <= 255) return "counts of 8 bits? Then write u / 255";
  if (low >= 0 && high <= 65535) return "counts of 16 bits? Then write u / 65535";
  return "";
}

inline std::string range_text(const ColumnPlausibility& column) {
  return number_text(column.lowest) + " to " + number_text(column.highest) + " " + column.unit;
}

inline std::string column_text(std::size_t field) { return "in column " + std::string(sample_field_names[field]); }

/// The first cell of a command outside 0..1.
inline std::optional<Implausible> find_implausible_command(const Flight& flight) {
  for (std::size_t row = 0; row < flight.size(); ++row) {
    for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
      const double u = flight[row].commands[rotor];
      const std::size_t field = first_command_field + rotor;
      if (u >= column_plausibility[field].lowest && u <= column_plausibility[field].highest) continue;
      const std::string mistake = command_mistake(flight);
      return Implausible{row, field, "a command of 0 to 1 " + column_text(field),
                         number_text(u) + (mistake.empty() ? "" : " (" + mistake + ")")};
    }
  }
  return std::nullopt;
}

/// The first cell outside its column's physical range; NaN and infinity are outside every range, as is what no float
/// holds.
inline std::optional<Implausible> find_out_of_range(const Flight& flight) {
  for (std::size_t row = 0; row < flight.size(); ++row) {
    const Sample::Values values = to_values(flight[row]);
    for (std::size_t field = 0; field < values.size(); ++field) {
      const ColumnPlausibility& column = column_plausibility[field];
      if (values[field] >= column.lowest && values[field] <= column.highest) continue;
      return Implausible{row, field, range_text(column) + " " + column_text(field), number_text(values[field])};
    }
  }
  return std::nullopt;
}

inline double row_period_s(const Flight& flight) {
  RowSet all;
  all.add(flight, {0, flight.size()});
  return sample_period_s(all);
}

/// The cell of a column that is furthest from its median and has no neighbour like it. Beside a gap nothing is known of
/// a neighbour: a knock whose next row was dropped is no wrong cell.
inline std::optional<Implausible> find_outlier(const Flight& flight, std::size_t field, double period_s) {
  const ColumnPlausibility& column = column_plausibility[field];
  if (!(column.smallest_scale > 0) || flight.empty()) return std::nullopt;
  constexpr double normal = 1.4826;  // standard deviation of a normal column over its median absolute deviation
  const std::vector<double> values = column_of(flight, field);
  const double median = median_of(values);
  std::vector<double> distance;
  distance.reserve(values.size());
  for (const double value : values) distance.push_back(std::abs(value - median));
  const double scale = std::max(normal * median_of(distance), column.smallest_scale);
  std::optional<Implausible> worst;
  double furthest = most_robust_deviations * scale;
  for (std::size_t row = 0; row < distance.size(); ++row) {
    if (!(distance[row] > furthest)) continue;
    constexpr double gap = 1.5;  // periods
    const auto parted = [&](std::size_t at) {
      return at + 1 < flight.size() && !(flight[at + 1].time_s - flight[at].time_s <= gap * period_s);
    };
    if ((row > 0 && parted(row - 1)) || parted(row)) continue;
    const double before = row > 0 ? distance[row - 1] : 0;
    const double after = row + 1 < distance.size() ? distance[row + 1] : 0;
    if (std::max(before, after) > distance[row] / 2) continue;
    furthest = distance[row];
    worst = Implausible{row, field, "a value like its neighbours " + column_text(field),
                        number_text(values[row]) + ", " + std::to_string(static_cast<long long>(furthest / scale)) +
                            " robust deviations from the median " + number_text(median)};
  }
  return worst;
}

/// Rows further apart than those of any flight: a clock of another unit.
inline std::optional<Implausible> find_other_clock(const Flight& flight) {
  const double period_s = row_period_s(flight);
  if (is_clock_time(period_s)) return std::nullopt;
  return Implausible{1, 0, "rows at most " + number_text(longest_clock_s) + " s apart " + column_text(0),
                     number_text(period_s) + " (milliseconds? Then write t / 1000)"};
}

/// InputError at the value of a flight that was read from `path`; without the file, at its place in one of ours.
inline InputError implausible_in_file(const std::string& path, const Implausible& found) {
  constexpr std::size_t lines_before_rows = 1;
  std::size_t rows = 0, in_line = found.row + lines_before_rows + 1, in_column = found.field + 1;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return {path, in_line, in_column, found.expected, found.found};
  for_each_csv_row(path, {std::string(sample_field_names[found.field])}, 1,
                   [&](const std::vector<double>&, std::size_t line, const std::vector<std::size_t>& fields) {
                     if (rows++ != found.row) return;
                     in_line = line;
                     in_column = fields[0] + 1;
                   });
  return InputError(path, in_line, in_column, found.expected, found.found);
}

}  // namespace detail

/// The first reason, in this order, why a network must not learn from these rows: commands outside 0..1, a clock of
/// another unit, an attitude that does not turn by the body rates, a cell outside its column's range or like none of
/// its neighbours, accelerations that are not the derivatives of rates and velocity, an altitude that goes against it.
/// None for a flight.
inline std::optional<detail::Implausible> find_implausible(const Flight& flight) {
  if (auto found = detail::find_implausible_command(flight)) return found;
  if (auto found = detail::find_other_clock(flight)) return found;
  if (auto found = find_turning_mistake(flight)) return found;
  if (auto found = detail::find_out_of_range(flight)) return found;
  const double period_s = detail::row_period_s(flight);
  for (std::size_t field = 0; field < sample_value_count; ++field) {
    if (auto found = detail::find_outlier(flight, field, period_s)) return found;
  }
  return find_acceleration_mistake(flight);
}

/// The columns whose axis and sign the motion of a flight doesn't confirm, "w_x, w_z, v_bx": too little of it.
inline std::string motion_not_checked(const Flight& flight) {
  using namespace detail;
  std::string columns;
  const auto say = [&columns](const MotionBlocks& sums, std::size_t first_field) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (!sums.confirms(axis)) columns += (columns.empty() ? "" : ", ") + field_name(first_field, axis);
    }
  };
  say(turning_pair(flight, {}).sums(turning_step_s), rates_field);
  const bool has_velocity = std::any_of(flight.begin(), flight.end(),
                                        [](const Sample& sample) { return sample.velocity_m_s.squaredNorm() > 0; });
  if (has_velocity) say(world_velocity_pair(flight).sums(turning_step_s), velocity_field);
  return columns;
}

/// Throws InputError where find_implausible() finds something in a flight that was read from `path`:
///   flight.csv:17:5: expected -1000 to 1000 m/s^2 in column vdot_bx, found 1e+39
inline void require_plausible(const std::string& path, const Flight& flight) {
  if (const auto found = find_implausible(flight)) throw detail::implausible_in_file(path, *found);
}

/// Throws InputError where a command stands still in a block of a flight that was read from `path`: it teaches nothing.
/// `block_name`: "training".
inline void require_varied_commands(const std::string& path, const Flight& flight, const IndexRange& block,
                                    const std::string& block_name) {
  constexpr double smallest_range = 1e-6;  // a float's rounding
  for (std::size_t rotor = 0; rotor < rotor_count && !block.empty(); ++rotor) {
    double low = flight[block.begin].commands[rotor], high = low;
    for (std::size_t row = block.begin; row < block.end; ++row) {
      low = std::min(low, flight[row].commands[rotor]);
      high = std::max(high, flight[row].commands[rotor]);
    }
    if (high - low > smallest_range) continue;
    const std::size_t field = detail::first_command_field + rotor;
    throw detail::implausible_in_file(
        path, {block.begin, field, "commands that change " + detail::column_text(field),
               number_text(low) + " in all " + std::to_string(block.size()) + " " + block_name + " rows"});
  }
}

}  // namespace pinnquad
