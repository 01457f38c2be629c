// SPDX-License-Identifier: MIT
// Bodies of plausibility.hpp.
#pragma once

#include "pinnquad/data/plausibility.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY std::vector<double> column_of(const Flight& flight, std::size_t field) {
  constexpr std::array<Vector3<double> Sample::*, 4> vectors = {&Sample::linear_acceleration_m_s2,
                                                                &Sample::angular_acceleration_rad_s2,
                                                                &Sample::velocity_m_s, &Sample::body_rates_rad_s};
  constexpr std::array<double Sample::*, 4> numbers = {&Sample::roll_rad, &Sample::pitch_rad, &Sample::yaw_rad,
                                                       &Sample::altitude_m};
  std::vector<double> column;
  column.reserve(flight.size());
  const auto fill = [&](const auto& of) {
    for (const Sample& sample : flight) column.push_back(of(sample));
    return std::move(column);
  };
  if (field >= first_command_field)
    return fill([&](const Sample& s) { return s.commands[field - first_command_field]; });
  if (field >= angles_field) return fill([of = numbers[field - angles_field]](const Sample& s) { return s.*of; });
  if (field < linear_field) return fill([](const Sample& s) { return s.time_s; });
  const auto axis = static_cast<Eigen::Index>((field - linear_field) % 3);
  return fill([of = vectors[(field - linear_field) / 3], axis](const Sample& s) { return (s.*of)[axis]; });
}

PINNQUAD_BODY double median_of(std::vector<double> series) {
  const auto middle = series.begin() + static_cast<std::ptrdiff_t>(series.size() / 2);
  std::nth_element(series.begin(), middle, series.end());
  return *middle;
}

/// The likely unit of commands outside 0..1, and how to convert them; empty if unknown. Nine cells in ten decide: a
/// single wrong cell does not hide the rest.
PINNQUAD_BODY std::string command_mistake(const Flight& flight) {
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

PINNQUAD_BODY std::string range_text(const ColumnPlausibility& column) {
  return number_text(column.lowest) + " to " + number_text(column.highest) + " " + column.unit;
}

/// The first cell of a command outside 0..1.
PINNQUAD_BODY std::optional<Implausible> find_implausible_command(const Flight& flight) {
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

/// Least and greatest value of each column.
using Ranges = std::array<std::pair<double, double>, sample_value_count>;

/// The first cell outside its column's physical range; NaN and infinity are outside every range, as is what no float
/// holds.
PINNQUAD_BODY std::optional<Implausible> find_out_of_range(const Flight& flight, Ranges& ranges) {
  for (std::size_t row = 0; row < flight.size(); ++row) {
    const Sample::Values values = to_values(flight[row]);
    for (std::size_t field = 0; field < values.size(); ++field) {
      const ColumnPlausibility& column = column_plausibility[field];
      auto& [least, most] = ranges[field];
      least = row > 0 ? std::min(least, values[field]) : values[field];
      most = row > 0 ? std::max(most, values[field]) : values[field];
      if (values[field] >= column.lowest && values[field] <= column.highest) continue;
      return Implausible{row, field, range_text(column) + " " + column_text(field), number_text(values[field])};
    }
  }
  return std::nullopt;
}

PINNQUAD_BODY double row_period_s(const Flight& flight) {
  RowSet all;
  all.add(flight, {0, flight.size()});
  return sample_period_s(all);
}

/// The cell of a column that is furthest from its median and has no neighbour like it. Beside a gap nothing is known of
/// a neighbour: a knock whose next row was dropped is no wrong cell.
PINNQUAD_BODY std::optional<Implausible> find_outlier(const Flight& flight, std::size_t field, const Ranges& ranges,
                                                      double period_s) {
  const ColumnPlausibility& column = column_plausibility[field];
  if (!(column.smallest_scale > 0) || flight.empty()) return std::nullopt;
  constexpr double normal = 1.4826;  // standard deviation of a normal column over its median absolute deviation
  const double nearest = most_robust_deviations * column.smallest_scale;  // that an outlier is to its median
  const auto& [least, most] = ranges[field];
  if (most - least <= nearest) return std::nullopt;
  const std::vector<double> values = column_of(flight, field);
  const double median = median_of(values);
  if (most - median <= nearest && median - least <= nearest) return std::nullopt;
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
PINNQUAD_BODY std::optional<Implausible> find_other_clock(const Flight& flight) {
  const double period_s = row_period_s(flight);
  if (is_clock_time(period_s)) return std::nullopt;
  return Implausible{1, 0, "rows at most " + number_text(longest_clock_s) + " s apart " + column_text(0),
                     number_text(period_s) + " (milliseconds? Then write t / 1000)"};
}

/// InputError at the value of a flight that was read from `path`; without the file, at its place in one of ours.
PINNQUAD_BODY InputError implausible_in_file(const std::string& path, const Implausible& found) {
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

PINNQUAD_BODY std::optional<detail::Implausible> find_implausible(const Flight& flight) {
  if (auto found = detail::find_implausible_command(flight)) return found;
  if (auto found = detail::find_other_clock(flight)) return found;
  const std::vector<Quaternion<double>> attitude = detail::attitudes_of(flight);
  if (auto found = detail::find_turning_mistake(flight, attitude)) return found;
  detail::Ranges ranges{};
  if (auto found = detail::find_out_of_range(flight, ranges)) return found;
  const double period_s = detail::row_period_s(flight);
  for (std::size_t field = 0; field < sample_value_count; ++field) {
    if (auto found = detail::find_outlier(flight, field, ranges, period_s)) return found;
  }
  return detail::find_acceleration_mistake(flight, attitude);
}

PINNQUAD_BODY std::string motion_not_checked(const Flight& flight) {
  using namespace detail;
  std::string columns;
  const auto say = [&columns](const MotionBlocks& sums, std::size_t first_field) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (!sums.confirms(axis)) columns += (columns.empty() ? "" : ", ") + field_name(first_field, axis);
    }
  };
  const std::vector<Quaternion<double>> attitude = attitudes_of(flight);
  say(turning_sums(flight, attitude), rates_field);
  const bool has_velocity = std::any_of(flight.begin(), flight.end(),
                                        [](const Sample& sample) { return sample.velocity_m_s.squaredNorm() > 0; });
  if (has_velocity) say(world_velocity_sums(flight, attitude), velocity_field);
  return columns;
}

PINNQUAD_BODY void require_plausible(const std::string& path, const Flight& flight) {
  if (const auto found = find_implausible(flight)) throw detail::implausible_in_file(path, *found);
}

PINNQUAD_BODY void require_varied_commands(const std::string& path, const Flight& flight, const IndexRange& block,
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
