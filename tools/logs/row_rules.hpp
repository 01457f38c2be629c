// SPDX-License-Identifier: MIT
// Rows that say nothing of how the vehicle flies: on the ground, with idle motors, with a motor at its limit.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "logs/derived_motion.hpp"
#include "logs/mapping.hpp"
#include "logs/row_checks.hpp"

namespace programs {

/// True where the vehicle stands on the ground: the log says landed, it is lower than the mapping says, or something
/// else than the rotors bears it.
inline RowMask on_the_ground(const LogRows& rows, const Mapping& mapping, double period_s) {
  const pinnquad::Flight& flight = rows.flight;
  RowMask out(flight.size(), false);
  if (mapping.ground_by_contact && !flight.empty()) out = grounded_rows(flight, period_s);
  for (std::size_t row = 0; row < flight.size(); ++row) {
    const bool low = rows.has_altitude && mapping.least_height_m > 0 && flight[row].altitude_m < mapping.least_height_m;
    out[row] = out[row] || low || (!rows.landed.empty() && rows.landed[row]);
  }
  return out;
}

inline bool is_idle(const pinnquad::Sample& sample, const Mapping& mapping) {
  return std::all_of(sample.commands.begin(), sample.commands.end(), [&](double u) { return u < mapping.idle_below; });
}

/// A flight of that name and those extra columns, without rows.
inline pinnquad::Flight emptied(const pinnquad::Flight& flight) {
  pinnquad::Flight empty;
  empty.name = flight.name;
  empty.trajectory = flight.trajectory;
  for (const pinnquad::ExtraColumn& column : flight.columns()) {
    pinnquad::ExtraColumn none;
    none.name = column.name;
    none.unit = column.unit;
    empty.add_column(std::move(none));
  }
  return empty;
}

inline void append(pinnquad::Flight& to, const pinnquad::Flight& from, std::size_t row) {
  std::vector<double> extras;
  for (const pinnquad::ExtraColumn& column : from.columns()) extras.push_back(column.values[row]);
  to.push_back(from[row], extras.data(), extras.size());
}

/// The rows that stay.
inline pinnquad::Flight without(pinnquad::Flight flight, const RowMask& out) {
  flight.keep_rows([&out](std::size_t row) { return !out[row]; });
  return flight;
}

/// Parts at steps in time longer than `gap_s`.
inline std::vector<pinnquad::Flight> split_at_gaps(pinnquad::Flight flight, double gap_s) {
  std::vector<std::size_t> begins;
  for (std::size_t row = 0; row < flight.size(); ++row) {
    if (row == 0 || flight[row].time_s - flight[row - 1].time_s > gap_s) begins.push_back(row);
  }
  std::vector<pinnquad::Flight> parts;
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

/// One after the other, which is in time's order.
inline pinnquad::Flight joined(std::vector<pinnquad::Flight> parts) {
  if (parts.empty()) return {};
  if (parts.size() == 1) return std::move(parts.front());
  std::size_t rows = 0;
  for (const pinnquad::Flight& part : parts) rows += part.size();
  pinnquad::Flight whole = emptied(parts.front());
  whole.reserve(rows);
  for (pinnquad::Flight& part : parts) {
    for (std::size_t row = 0; row < part.size(); ++row) append(whole, part, row);
    part = {};
  }
  return whole;
}

}  // namespace programs
