// SPDX-License-Identifier: MIT
#include "logs/row_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "logs/specific_force.hpp"
#include "pinnquad/data/plausibility.hpp"

namespace pinnquad::logs {
namespace {

/// Columns of outlier_rows(): accelerations, velocity, rates, altitude, and the attitude as a quaternion whose sign
/// does not jump, for near a pitch of 90 degrees roll and yaw do.
constexpr std::array<std::size_t, 13> judged_fields = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 16};
using JudgedRow = std::array<double, judged_fields.size() + 4>;

/// The deviation that counts at least.
double smallest_scale_of(std::size_t column) {
  constexpr double of_q = 0.02;
  return column < judged_fields.size() ? column_plausibility[judged_fields[column]].smallest_scale / 2 : of_q;
}

std::vector<JudgedRow> judged_rows(const Flight& flight) {
  std::vector<JudgedRow> rows;
  rows.reserve(flight.size());
  Quaternion<double> last;
  for (const Sample& sample : flight) {
    Quaternion<double> q = attitude(sample);
    if (q.w * last.w + q.x * last.x + q.y * last.y + q.z * last.z < 0) q = {-q.w, -q.x, -q.y, -q.z};
    last = q;
    const Sample::Values values = to_values(sample);
    JudgedRow row{};
    for (std::size_t i = 0; i < judged_fields.size(); ++i) row[i] = values[judged_fields[i]];
    std::copy_n(std::array<double, 4>{q.w, q.x, q.y, q.z}.begin(), 4, row.begin() + judged_fields.size());
    rows.push_back(row);
  }
  return rows;
}

/// Columns that step far from a row to both sides, as an outlier does.
std::array<bool, std::tuple_size<JudgedRow>::value> stepping_columns(const std::vector<JudgedRow>& rows,
                                                                     double deviations) {
  std::array<bool, std::tuple_size<JudgedRow>::value> found{}, before;
  before.fill(true);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t k = 0; k < found.size(); ++k) {
      const bool after =
          row + 1 == rows.size() || std::abs(rows[row + 1][k] - rows[row][k]) > deviations / 2 * smallest_scale_of(k);
      found[k] = found[k] || (before[k] && after);
      before[k] = after;
    }
  }
  return found;
}

/// The flight without its rows.
Flight emptied(const Flight& flight) {
  Flight empty;
  empty.name = flight.name;
  empty.trajectory = flight.trajectory;
  empty.weight = flight.weight;
  for (const ExtraColumn& column : flight.columns()) {
    ExtraColumn none;
    none.name = column.name;
    none.unit = column.unit;
    empty.add_column(std::move(none));
  }
  return empty;
}

void append(Flight& to, const Flight& from, std::size_t row) {
  std::vector<double> extras;
  for (const ExtraColumn& column : from.columns()) extras.push_back(column.values[row]);
  to.push_back(from[row], extras.data(), extras.size());
}

}  // namespace

Flight first_rows(const Flight& flight, std::size_t count) {
  Flight first = emptied(flight);
  count = std::min(count, flight.size());
  first.reserve(count);
  for (std::size_t row = 0; row < count; ++row) append(first, flight, row);
  return first;
}

RowMask saturated_rows(const Flight& flight, double lowest, double highest) {
  constexpr double close = 1e-3;
  constexpr std::size_t held_rows = 5;
  RowMask mask(flight.size(), false);
  for (std::size_t rotor = 0; rotor < rotor_count && !flight.empty(); ++rotor) {
    const std::vector<double> commands = detail::column_of(flight, detail::first_command_field + rotor);
    const auto [least_at, most_at] = std::minmax_element(commands.begin(), commands.end());
    const double least = *least_at, most = *most_at;
    std::size_t at_least = 0, at_most = 0, longest_least = 0, longest_most = 0;
    for (const double u : commands) {
      at_least = u <= least ? at_least + 1 : 0;
      at_most = u >= most ? at_most + 1 : 0;
      longest_least = std::max(longest_least, at_least);
      longest_most = std::max(longest_most, at_most);
    }
    const bool moves = most > least;
    for (std::size_t row = 0; row < flight.size(); ++row) {
      const double u = commands[row];
      if (u <= lowest + close || u >= highest - close || (moves && longest_least >= held_rows && u <= least) ||
          (moves && longest_most >= held_rows && u >= most)) {
        mask[row] = true;
      }
    }
  }
  return mask;
}

RowMask grounded_rows(const Flight& flight, double period_s) {
  constexpr double high = 0.98, share_of_high = 0.6;
  constexpr double held_share = 0.3;    // of the weight that the ground must bear at least
  constexpr double smoothing_s = 0.25;  // over which forces are averaged
  constexpr double margin_s = 0.5;      // before and after a contact
  constexpr double fastest_m_s = 1;     // on the ground, by an estimate that drifts; 0 where velocity is absent
  constexpr double shortest_air_s = 2;  // between two contacts; a shorter hop counts as ground
  const std::size_t rows = flight.size();
  RowMask mask(rows, false);
  if (rows == 0) return mask;
  std::vector<double> collective(rows), upward(rows), force(rows), speed(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    for (const double u : flight[row].commands) collective[row] += u;
    const Vector3<double> measured = specific_force_m_s2(flight[row]);
    upward[row] = -measured[2];
    force[row] = measured.norm();
    speed[row] = flight[row].velocity_m_s.norm();
  }
  std::vector<double> sorted = collective;
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(high * static_cast<double>(rows - 1));
  std::nth_element(sorted.begin(), at, sorted.end());
  const double usual = *at;
  std::vector<double> ratios;
  for (std::size_t row = 0; row < rows; ++row) {
    if (collective[row] >= share_of_high * usual && usual > 0) ratios.push_back(upward[row] / collective[row]);
  }
  if (ratios.empty()) return RowMask(rows, true);
  const double made = detail::median_of(ratios);
  const auto half = static_cast<std::size_t>(smoothing_s / (2 * period_s));
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
  constexpr double weight = standard_gravity_m_s2<double>;
  for (std::size_t row = 0; row < rows; ++row) {
    mask[row] =
        borne[row] > held_share * weight && std::abs(whole[row] - weight) < 0.3 * weight && moving[row] < fastest_m_s;
  }
  const auto margin = static_cast<std::size_t>(margin_s / period_s);
  const auto shortest = static_cast<std::size_t>(shortest_air_s / period_s);
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

RowMask outlier_rows(const Flight& flight) {
  constexpr std::size_t around = 3;
  constexpr double normal = 1.4826, deviations = 12;
  RowMask mask(flight.size(), false);
  if (flight.size() < 2 * around + 1) return mask;
  const std::vector<JudgedRow> rows = judged_rows(flight);
  const auto steps = stepping_columns(rows, deviations);
  for (std::size_t column = 0; column < steps.size(); ++column) {
    if (!steps[column]) continue;
    std::vector<double> values;
    values.reserve(rows.size());
    for (const JudgedRow& row : rows) values.push_back(row[column]);
    std::vector<double> distance(values.size(), 0.0);
    for (std::size_t row = 0; row < values.size(); ++row) {
      const std::size_t begin = std::min(row > around ? row - around : 0, values.size() - (2 * around + 1));
      std::array<double, 2 * around + 1> near;
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(begin), near.size(), near.begin());
      std::nth_element(near.begin(), near.begin() + around, near.end());
      distance[row] = std::abs(values[row] - near[around]);
    }
    const double scale = std::max(normal * detail::median_of(distance), smallest_scale_of(column));
    for (std::size_t row = 0; row < values.size(); ++row) {
      if (!(distance[row] > deviations * scale)) continue;
      const double before = row > 0 ? std::abs(values[row - 1] - values[row]) : distance[row];
      const double after = row + 1 < values.size() ? std::abs(values[row + 1] - values[row]) : distance[row];
      if (std::min(before, after) > distance[row] / 2) mask[row] = true;
    }
  }
  return mask;
}

RowMask on_the_ground(const LogRows& rows, const Mapping& mapping, double period_s) {
  const Flight& flight = rows.flight;
  RowMask out(flight.size(), false);
  if (mapping.ground_by_contact && !flight.empty()) out = grounded_rows(flight, period_s);
  for (std::size_t row = 0; row < flight.size(); ++row) {
    const bool low = rows.has_altitude && mapping.least_height_m > 0 && flight[row].altitude_m < mapping.least_height_m;
    out[row] = out[row] || low || (!rows.landed.empty() && rows.landed[row]);
  }
  return out;
}

bool is_idle(const Sample& sample, const Mapping& mapping) {
  return std::all_of(sample.commands.begin(), sample.commands.end(), [&](double u) { return u < mapping.idle_below; });
}

Flight without(Flight flight, const RowMask& out) {
  flight.keep_rows([&out](std::size_t row) { return !out[row]; });
  return flight;
}

namespace {

/// At the rows at which another part begins; the first is 0.
std::vector<Flight> split(Flight flight, const std::vector<std::size_t>& begins) {
  std::vector<Flight> parts;
  if (begins.size() == 1) {
    parts.push_back(std::move(flight));
    return parts;
  }
  for (std::size_t i = 0; i < begins.size(); ++i) {
    const std::size_t end = i + 1 < begins.size() ? begins[i + 1] : flight.size();
    parts.push_back(emptied(flight));
    parts.back().reserve(end - begins[i]);
    for (std::size_t row = begins[i]; row < end; ++row) append(parts.back(), flight, row);
  }
  return parts;
}

}  // namespace

std::vector<Flight> split_at_gaps(Flight flight, double gap_s) {
  std::vector<std::size_t> begins;
  for (std::size_t row = 0; row < flight.size(); ++row) {
    if (row == 0 || flight[row].time_s - flight[row - 1].time_s > gap_s) begins.push_back(row);
  }
  return split(std::move(flight), begins);
}

std::vector<Flight> cut(Flight flight, double part_s) {
  const double begin_s = flight[0].time_s, length_s = flight.back().time_s - begin_s;
  const double parts = std::max(1.0, std::round(length_s / part_s));
  std::vector<std::size_t> begins = {0};
  double done = 1;
  for (std::size_t row = 1; row < flight.size(); ++row) {
    const auto is_behind = [&] { return done < parts && flight[row].time_s - begin_s >= length_s * done / parts; };
    if (is_behind()) begins.push_back(row);
    while (is_behind()) ++done;  // a pause may hold whole parts
  }
  return split(std::move(flight), begins);
}

Flight joined(std::vector<Flight> parts) {
  if (parts.empty()) return {};
  if (parts.size() == 1) return std::move(parts.front());
  std::size_t rows = 0;
  for (const Flight& part : parts) rows += part.size();
  Flight whole = emptied(parts.front());
  whole.reserve(rows);
  for (Flight& part : parts) {
    for (std::size_t row = 0; row < part.size(); ++row) append(whole, part, row);
    part = {};
  }
  return whole;
}

}  // namespace pinnquad::logs
