// SPDX-License-Identifier: MIT
// Rows of a flight that nothing should be learned from: motors at their limits, the vehicle on the ground, values like
// none of their neighbours.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "logs/specific_force.hpp"
#include "pinnquad/data/plausibility.hpp"

namespace programs {

/// Per row of a flight: leave it out?
using RowMask = std::vector<bool>;

inline std::size_t count(const RowMask& rows) noexcept {
  return static_cast<std::size_t>(std::count(rows.begin(), rows.end(), true));
}

/// A command at `lowest` or `highest`, to a thousandth, or at its own extreme where that was held for `held_rows` rows
/// somewhere (a limit of the mapping or the mixer below 1): the motor may have been asked for more than the log shows.
/// To be asked of commands as they were logged: a mean over rows is hardly ever at the limit.
inline RowMask saturated_rows(const pinnquad::Flight& flight, double lowest = 0, double highest = 1,
                              std::size_t held_rows = 5) {
  constexpr double close = 1e-3;
  RowMask mask(flight.size(), false);
  for (std::size_t rotor = 0; rotor < pinnquad::rotor_count && !flight.empty(); ++rotor) {
    double least = flight[0].commands[rotor], most = least;
    for (const pinnquad::Sample& sample : flight) {
      least = std::min(least, sample.commands[rotor]);
      most = std::max(most, sample.commands[rotor]);
    }
    std::size_t at_least = 0, at_most = 0, longest_least = 0, longest_most = 0;
    for (const pinnquad::Sample& sample : flight) {
      at_least = sample.commands[rotor] <= least ? at_least + 1 : 0;
      at_most = sample.commands[rotor] >= most ? at_most + 1 : 0;
      longest_least = std::max(longest_least, at_least);
      longest_most = std::max(longest_most, at_most);
    }
    const bool moves = most > least;
    for (std::size_t row = 0; row < flight.size(); ++row) {
      const double u = flight[row].commands[rotor];
      if (u <= lowest + close || u >= highest - close || (moves && longest_least >= held_rows && u <= least) ||
          (moves && longest_most >= held_rows && u >= most)) {
        mask[row] = true;
      }
    }
  }
  return mask;
}

struct GroundRules {
  double held_share = 0.3;    ///< of the weight that the ground must bear at least
  double smoothing_s = 0.25;  ///< over which forces are averaged
  double margin_s = 0.5;      ///< before and after a contact
  double fastest_m_s = 1;     ///< on the ground, by an estimate that drifts; not looked at where velocity is absent (0)
  double shortest_air_s = 2;  ///< between two contacts; a shorter hop counts as ground
};

/// Rows where something else than the rotors bears the vehicle: the specific force along z is what the commands make in
/// the air (the median ratio of rows with 60 % or more of the usual high collective) and, on the ground, what it bears;
/// a vehicle that stands with idle motors reads the same 9.81 m/s^2 as one that hovers. There the whole force is the
/// weight, and the speed low: what air bears in a fast descent is neither. Needs no land detector and no height.
/// Limits: commands whose thrust is strongly curved (rotor speed) need `held_share` of 0.5; spool-up just before
/// lift-off is only covered by `margin_s`; a log of which less than a fiftieth is in the air has no usual collective.
inline RowMask grounded_rows(const pinnquad::Flight& flight, double period_s, const GroundRules& rules = {}) {
  constexpr double high = 0.98, share_of_high = 0.6;
  const std::size_t rows = flight.size();
  RowMask mask(rows, false);
  if (rows == 0) return mask;
  std::vector<double> collective(rows), upward(rows), force(rows), speed(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    for (const double u : flight[row].commands) collective[row] += u;
    const pinnquad::Vector3<double> measured = specific_force_m_s2(flight[row]);
    upward[row] = -measured[2];
    force[row] = measured.norm();
    speed[row] = flight[row].velocity_m_s.norm();
  }
  std::vector<double> sorted = collective;
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted[static_cast<std::size_t>(high * static_cast<double>(rows - 1))];
  std::vector<double> ratios;
  for (std::size_t row = 0; row < rows; ++row) {
    if (collective[row] >= share_of_high * usual && usual > 0) ratios.push_back(upward[row] / collective[row]);
  }
  if (ratios.empty()) return RowMask(rows, true);
  const double made = pinnquad::detail::median_of(ratios);
  const auto half = static_cast<std::size_t>(rules.smoothing_s / (2 * period_s));
  const auto averaged = [&](std::vector<double> series) {
    std::vector<double> sums(rows + 1, 0.0);
    for (std::size_t row = 0; row < rows; ++row) sums[row + 1] = sums[row] + series[row];
    for (std::size_t row = 0; row < rows; ++row) {
      const std::size_t begin = row > half ? row - half : 0, end = std::min(rows, row + half + 1);
      series[row] = (sums[end] - sums[begin]) / static_cast<double>(end - begin);
    }
    return series;
  };
  for (std::size_t row = 0; row < rows; ++row) upward[row] -= made * collective[row];
  const std::vector<double> borne = averaged(upward), whole = averaged(force), moving = averaged(speed);
  constexpr double weight = pinnquad::standard_gravity_m_s2<double>;
  for (std::size_t row = 0; row < rows; ++row) {
    mask[row] = borne[row] > rules.held_share * weight && std::abs(whole[row] - weight) < 0.3 * weight &&
                moving[row] < rules.fastest_m_s;
  }
  const auto margin = static_cast<std::size_t>(rules.margin_s / period_s);
  const auto shortest = static_cast<std::size_t>(rules.shortest_air_s / period_s);
  // from contact to contact
  std::size_t air = 0;
  bool contact_before = false;
  for (std::size_t row = 0; row <= rows; ++row) {
    if (row < rows && !mask[row]) {
      air += 1;
      continue;
    }
    const bool contact_after = row < rows;
    if (air > 0 && (contact_before || contact_after)) {
      const std::size_t begin = row - air;
      const bool hop = air < shortest && contact_before && contact_after;
      for (std::size_t i = begin; i < row; ++i) {
        const bool near_begin = contact_before && i - begin < margin, near_end = contact_after && row - i <= margin;
        if (hop || near_begin || near_end) mask[i] = true;
      }
    }
    air = 0;
    contact_before = true;
  }
  return mask;
}

namespace detail {
/// Columns of outlier_rows(): accelerations, velocity, rates, altitude, and the attitude as a quaternion whose sign
/// does not jump, for near a pitch of 90 degrees roll and yaw do; each with the deviation that counts at least.
struct JudgedColumn {
  std::vector<double> values;
  double smallest_scale;
};
inline std::vector<JudgedColumn> judged_columns(const pinnquad::Flight& flight) {
  constexpr double smallest_scale_of_q = 0.02;
  std::vector<JudgedColumn> columns;
  for (const std::size_t field : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u, 10u, 11u, 12u, 16u}) {
    columns.push_back(
        {pinnquad::detail::column_of(flight, field), pinnquad::column_plausibility[field].smallest_scale / 2});
  }
  const std::size_t first = columns.size();
  columns.resize(first + 4, {{}, smallest_scale_of_q});
  pinnquad::Quaternion<double> last;
  for (const pinnquad::Sample& sample : flight) {
    pinnquad::Quaternion<double> q = attitude(sample);
    if (q.w * last.w + q.x * last.x + q.y * last.y + q.z * last.z < 0) q = {-q.w, -q.x, -q.y, -q.z};
    last = q;
    const std::array<double, 4> parts = {q.w, q.x, q.y, q.z};
    for (std::size_t i = 0; i < parts.size(); ++i) columns[first + i].values.push_back(parts[i]);
  }
  return columns;
}
}  // namespace detail

/// Rows with a value of a measured column that none of its neighbours comes near: further from the median of seven rows
/// than `deviations` robust deviations of such distances (and of half of what plausibility.hpp calls the smallest
/// scale), with both neighbours not half as far. Time and commands, which may jump, are not judged. Limits: two wrong
/// rows in succession are taken for motion.
inline RowMask outlier_rows(const pinnquad::Flight& flight, double deviations = 12) {
  constexpr std::size_t around = 3;
  constexpr double normal = 1.4826;
  RowMask mask(flight.size(), false);
  if (flight.size() < 2 * around + 1) return mask;
  for (const detail::JudgedColumn& column : detail::judged_columns(flight)) {
    const std::vector<double>& values = column.values;
    std::vector<double> distance(values.size(), 0.0);
    for (std::size_t row = 0; row < values.size(); ++row) {
      const std::size_t begin = std::min(row > around ? row - around : 0, values.size() - (2 * around + 1));
      const auto from = values.begin() + static_cast<std::ptrdiff_t>(begin);
      distance[row] = std::abs(values[row] - pinnquad::detail::median_of({from, from + (2 * around + 1)}));
    }
    const double scale = std::max(normal * pinnquad::detail::median_of(distance), column.smallest_scale);
    for (std::size_t row = 0; row < values.size(); ++row) {
      if (!(distance[row] > deviations * scale)) continue;
      const double before = row > 0 ? std::abs(values[row - 1] - values[row]) : distance[row];
      const double after = row + 1 < values.size() ? std::abs(values[row + 1] - values[row]) : distance[row];
      if (std::min(before, after) > distance[row] / 2) mask[row] = true;
    }
  }
  return mask;
}

}  // namespace programs
