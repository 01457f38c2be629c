// SPDX-License-Identifier: MIT
// Recorded flights whose commands do not stand beside the motion that they make: a link's or a filter's latency, found
// as `import` finds the lag of logs, and taken out in whole rows. The lag of the rotors stays: it is the airframe's.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "logs/command_lag.hpp"
#include "logs/row_checks.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/logs/read_dataset.hpp"

namespace programs {

namespace detail {

inline double slowest_rotor_s(const pinnquad::Airframe<double>& airframe) {
  double slowest = 0;
  for (std::size_t i = 0; i < pinnquad::rotor_count; ++i) {
    slowest = std::max({slowest, airframe.rise_time_constant_s(i), airframe.fall_time_constant_s(i)});
  }
  return slowest;
}

/// The part of a lag that no rotor explains: all below 0, and what is above the slowest one's.
inline double latency_s(double lag_s, double rotor_s) { return lag_s < 0 ? lag_s : std::max(lag_s - rotor_s, 0.0); }

inline std::string milliseconds(double seconds) {
  return pinnquad::number_text(std::round(seconds * 1e4) / 10) + " ms";
}

}  // namespace detail

/// Moves the commands by `given`, or by the whole rows of latency that the flights show where it is known; what was
/// done becomes a step of the dataset. Flights without latency stay as they are, to the bit.
inline void remove_latency(pinnquad::logs::ImportedDataset& dataset, const pinnquad::Airframe<double>& airframe,
                           const std::optional<double>& given) {
  const double period_s = dataset.sample_period_s;
  if (!(period_s > 0)) return;  // no one clock
  std::string told = "as given";
  double lag_s = given.value_or(0);
  std::vector<std::vector<pinnquad::Flight>> parts;
  std::vector<pinnquad::Flight> all;
  for (const pinnquad::Flight& flight : dataset.flights.flights()) {
    parts.push_back(pinnquad::logs::split_at_gaps(flight, 1.5 * period_s));
    all.insert(all.end(), parts.back().begin(), parts.back().end());
  }
  if (!given) {
    const pinnquad::logs::CommandLag lag = pinnquad::logs::estimate_command_lag(all, period_s);
    if (!lag.likely()) return;
    const double rotor_s = detail::slowest_rotor_s(airframe);
    lag_s = period_s * std::round(detail::latency_s(lag.lag_s, rotor_s) / period_s);
    told = "whole rows of " + detail::milliseconds(lag.lag_s) + ", estimated, less the rotors' " +
           detail::milliseconds(rotor_s);
    if (lag.lag_s < 0) told = "whole rows of " + detail::milliseconds(lag.lag_s) + ", estimated";
  }
  if (!(std::abs(lag_s) > 0)) return;
  pinnquad::Dataset moved;
  for (std::vector<pinnquad::Flight>& of_flight : parts) {
    for (pinnquad::Flight& part : of_flight) part = pinnquad::logs::remove_lag(std::move(part), period_s, lag_s);
    moved.add(pinnquad::logs::joined(std::move(of_flight)));
  }
  dataset.lag_removed_s = lag_s;
  dataset.steps.push_back({"lag", dataset.flights.rows(), moved.rows(),
                           detail::milliseconds(lag_s) + " from command to motion removed: " + told});
  dataset.flights = std::move(moved);
}

}  // namespace programs
