// SPDX-License-Identifier: MIT
// All quantities of a log on one clock: the table's own rows where the log is one table of even steps, else a uniform
// clock onto which every topic is resampled. NaN where a quantity has none.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "logs/bound_log.hpp"

namespace pinnquad::logs {

struct CommonRows {
  double period_s = 0;
  bool own_rows = false;  ///< of a table; else resampled
  std::vector<double> time_s;
  std::array<std::vector<double>, 4> attitude, commands;  ///< wxyz; front right, rear left, front left, rear right
  /// Empty where the log has none.
  std::array<std::vector<double>, 3> body_rates, angular_acceleration, specific_force, acceleration, velocity, position;
  std::vector<double> altitude, landed;
  std::vector<std::vector<double>> extras;  ///< by BoundLog::extras

  std::size_t rows() const noexcept { return time_s.size(); }
};

/// Step of the log's slowest of commands, body rates and force; 0 for none.
double own_rows_period_s(const BoundLog& log);

/// The values of the log's signals are gone afterwards.
CommonRows common_rows(BoundLog& log, const std::optional<double>& period_s, bool hold_commands);

}  // namespace pinnquad::logs
