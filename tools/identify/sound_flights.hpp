// SPDX-License-Identifier: MIT
// Flights that a vehicle can be identified from: in the air, in motion, commands within their limits. What is not is
// refused with file, column and evidence.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "logs/log_checks.hpp"
#include "logs/row_checks.hpp"
#include "pinnquad/data/plausibility.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/logs/read_dataset.hpp"

namespace programs {

namespace detail {

inline std::size_t count(const pinnquad::logs::RowMask& mask) {
  return static_cast<std::size_t>(std::count(mask.begin(), mask.end(), true));
}

inline void require_motion(const std::string& file, const pinnquad::Flight& flight) {
  using pinnquad::detail::column_of, pinnquad::detail::rates_field;
  const std::vector<double> time_s = column_of(flight, 0);
  for (std::size_t field = rates_field; field < rates_field + 3; ++field) {
    const std::string column(pinnquad::sample_field_names[field]);
    if (const auto finding = pinnquad::logs::check_frozen(column, time_s, column_of(flight, field))) {
      throw pinnquad::InputError(file, 0, 0, "a body rate that is measured in column " + column, *finding);
    }
  }
}

/// On the ground throughout no row is unlike the others, and grounded_rows() finds none.
inline void require_flight(const std::string& file, const pinnquad::Flight& flight) {
  constexpr double still_rad_s = 0.03, still_m_s2 = 0.5, most = 0.5;
  std::size_t still = 0;
  for (const pinnquad::Sample& sample : flight) {
    const bool rests =
        sample.body_rates_rad_s.norm() < still_rad_s && sample.linear_acceleration_m_s2.norm() < still_m_s2;
    still += rests ? 1 : 0;
  }
  const double share = static_cast<double>(still) / static_cast<double>(flight.size());
  if (share <= most) return;
  throw pinnquad::InputError(file, 0, 0, "a vehicle that moves in the air in columns w_x to w_z and vdot_bx to vdot_bz",
                             "rest in " + pinnquad::logs::percent(share) + " of the rows");
}

inline void require_free_commands(const std::string& file, const pinnquad::Flight& flight) {
  constexpr double edge = 1e-3, most = 0.5;
  for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
    std::size_t held = 0;
    for (const pinnquad::Sample& sample : flight) {
      held += sample.commands[motor] <= edge || sample.commands[motor] >= 1 - edge ? 1 : 0;
    }
    if (static_cast<double>(held) <= most * static_cast<double>(flight.size())) continue;
    throw pinnquad::InputError(
        file, 0, 0, "a motor that is free to move in column u" + std::to_string(motor + 1),
        "0 or 1 in " + pinnquad::logs::percent(static_cast<double>(held) / static_cast<double>(flight.size())) +
            " of the rows");
  }
}

}  // namespace detail

/// The flights of a dataset without their rows on the ground. Throws InputError, one line.
inline std::vector<pinnquad::Flight> sound_flights(const pinnquad::logs::ImportedDataset& dataset) {
  constexpr double most_grounded = 0.5;
  std::vector<pinnquad::Flight> flights;
  const double period_s = pinnquad::sample_period_s(pinnquad::all_rows(dataset.flights.flights()));
  if (!(period_s > 0)) {
    throw pinnquad::InputError(dataset.sources.front(), 0, 0, "rows of one period in all flights",
                               "several, or a single row");
  }
  for (std::size_t i = 0; i < dataset.flights.size(); ++i) {
    const pinnquad::Flight& flight = dataset.flights[i];
    const std::string& file = dataset.sources[i];
    detail::require_motion(file, flight);
    detail::require_flight(file, flight);
    detail::require_free_commands(file, flight);
    const pinnquad::logs::RowMask grounded = pinnquad::logs::grounded_rows(flight, period_s);
    const double share = static_cast<double>(detail::count(grounded)) / static_cast<double>(flight.size());
    if (share > most_grounded) {
      throw pinnquad::InputError(
          file, 0, 0, "a vehicle in the air in columns vdot_bz and u1 to u4",
          "something else than the rotors bears it in " + pinnquad::logs::percent(share) + " of the rows");
    }
    flights.push_back(pinnquad::logs::without(flight, grounded));
  }
  return flights;
}

}  // namespace programs
