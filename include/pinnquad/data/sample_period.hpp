// SPDX-License-Identifier: MIT
// How far apart in time the rows of flights are: what an exported model says of its clock.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "pinnquad/data/row_set.hpp"

namespace pinnquad {

/// Times that an exported model can state of its clock: a sample period, a lag that was removed.
inline constexpr double longest_clock_s = 4;
inline bool is_clock_time(double seconds) noexcept { return seconds >= 0 && seconds <= longest_clock_s; }

/// Median time between a row and the next of the same piece, s. 0 where no piece has two rows, or where the medians of two
/// pieces differ by more than `tolerance` of the first: then there is no one period. To the nanosecond, as a block holds it:
/// times are sums of steps.
inline double sample_period_s(const RowSet& rows, double tolerance = 0.01) {
  double period = 0;
  for (const FlightRows& piece : rows.pieces()) {
    std::vector<double> steps;
    for (std::size_t row = piece.rows.begin + 1; row < piece.rows.end; ++row) {
      steps.push_back((*piece.flight)[row].time_s - (*piece.flight)[row - 1].time_s);
    }
    if (steps.empty()) continue;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    if (period > 0 && !(std::abs(*middle - period) <= tolerance * period)) return 0;
    if (!(period > 0)) period = *middle;
  }
  return std::round(period * 1e9) / 1e9;
}

}  // namespace pinnquad
