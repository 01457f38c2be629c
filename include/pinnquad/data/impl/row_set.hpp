// SPDX-License-Identifier: MIT
// Bodies of row_set.hpp.
#pragma once

#include "pinnquad/data/row_set.hpp"

namespace pinnquad {

PINNQUAD_BODY double sample_period_s(const RowSet& rows) {
  constexpr double tolerance = 0.01;
  constexpr double rounding_s = 0.5e-6;  // of a step between seconds since 1970, twice
  double period = 0, beyond = 0, alike = 0;
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
    for (const double step : steps) {
      if (!(std::abs(step - period) <= rounding_s)) continue;
      beyond += step - period;
      ++alike;
    }
  }
  return std::round((alike > 0 ? period + beyond / alike : period) * 1e9) / 1e9;
}

}  // namespace pinnquad
