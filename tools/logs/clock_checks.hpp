// SPDX-License-Identifier: MIT
// Findings of a topic's clock: time that jumps, a recording that starts again, a logger that was too slow or
// lost rows.
#pragma once

#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "logs/common_clock.hpp"
#include "logs/finding.hpp"

namespace programs {

namespace detail {
inline std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}
}  // namespace detail

/// A step of more than a second and 20 nominal periods is a jump; more than 5 % of the time in gaps is a logger that
/// lost rows; more than 1 % of rows with a time that another has, or none. `topic`: its name, "the log" for one table.
inline std::vector<Finding> check_clock(const std::string& topic, const ClockReport& report) {
  constexpr double jump_s = 1, jump_periods = 20, share_in_gaps = 0.05, share_of_rows = 0.01;
  std::vector<Finding> findings;
  const double period = report.nominal_period_s;
  if (report.restarts > 0) {
    findings.push_back({"time_restarts", report.largest_step_back_s, "s",
                        topic + ": time steps back by up to " + detail::short_number(report.largest_step_back_s) +
                            " s, " + std::to_string(report.restarts) +
                            " times: two recordings in one file, or a clock that was set in flight; cut it there"});
  }
  if (report.largest_step_s > jump_s && report.largest_step_s > jump_periods * period) {
    findings.push_back({"time_jump", report.largest_step_s, "s",
                        topic + ": time jumps by " + detail::short_number(report.largest_step_s) +
                            " s between rows that are " + detail::short_number(1e3 * period) +
                            " ms apart elsewhere; what lies on both sides is treated as two flights"});
  }
  const double rows = static_cast<double>(report.rows_kept);
  const double steady = report.time_in_gaps_s - (report.largest_step_s > jump_s ? report.largest_step_s : 0);
  if (period > 0 && steady > share_in_gaps * rows * period) {
    findings.push_back({"gaps", steady, "s",
                        topic + ": " + std::to_string(report.gaps) + " gaps, " + detail::short_number(steady) +
                            " s in sum: the logger lost rows; a faster card or fewer topics help"});
  }
  const double lost = static_cast<double>(report.same_time + report.not_a_time);
  if (lost > share_of_rows * static_cast<double>(report.rows_read)) {
    findings.push_back({"repeated_times", lost / static_cast<double>(report.rows_read), "1",
                        topic + ": " + std::to_string(report.same_time) + " rows have a time that another row has, " +
                            std::to_string(report.not_a_time) + " have none"});
  }
  return findings;
}

/// The least rate at which commands and body rates of a small multirotor are worth learning from: a motor settles in 50
/// ms.
inline constexpr double least_log_rate_Hz = 25;

/// Too slow to show what a motor does; `px4`: say which profile has it at full rate. number: the rate.
inline std::optional<Finding> check_log_rate(const std::string& topic, double period_s, bool px4) {
  if (!(period_s * least_log_rate_Hz > 1.0 + 1e-3)) return std::nullopt;
  std::string sentence = topic + " was logged at " + detail::short_number(1 / period_s) +
                         " Hz, too slow to see what the motors do (50 Hz or more is good)";
  if (px4) {
    sentence += ": set SDLOG_PROFILE to 25 (default 1, system identification 8 and high rate 16 together) and restart";
  }
  return Finding{"log_rate", 1 / period_s, "Hz", sentence};
}

}  // namespace programs
