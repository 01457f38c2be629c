// SPDX-License-Identifier: MIT
// Checks of a log, each an observation and its remedy in a sentence for the pilot, or nothing: time that jumps, a
// recording that starts again, a logger that was too slow or lost rows, a signal that stands still while its last value
// is still written.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "logs/clock.hpp"
#include "pinnquad/regression/block_regression.hpp"

namespace pinnquad::logs {

/// "37 %" of 0.37.
std::string percent(double share);

/// Three digits: "80.2".
std::string short_number(double value);

/// "5 flights, a, b ... e" of three names or more.
std::string many_flights(const std::vector<std::string>& names);

/// "80.2 rad/s^2 (78 to 82.4)"
std::string with_interval(const Estimate& estimate, const char* unit);

/// A step of more than a second and 20 nominal periods is a jump; more than 5 % of the time in gaps is a logger that
/// lost rows; more than 1 % of rows with a time that another has, or none. `topic`: its name, "the log" for one table.
std::vector<std::string> check_clock(const std::string& topic, const ClockReport& report);

/// The least rate at which commands and body rates of a small multirotor are worth learning from: a motor settles in 50
/// ms.
inline constexpr double least_log_rate_Hz = 25;

/// Too slow to show what a motor does; `px4`: say which profile has it at full rate. number: the rate.
std::optional<std::string> check_log_rate(const std::string& topic, double period_s, bool px4);

/// Of a signal that is measured and in motion: body rates, specific force, attitude in the air. Not of commands (they
/// saturate), battery voltage (it is coarse), nor of rows on the ground. number: seconds that are frozen.
/// Limits: a signal of few digits that hardly moves looks frozen; one that is held longer than it is measured (a topic
/// copied at a higher rate) does so only from `longest_s` on.
std::optional<std::string> check_frozen(const std::string& name, const std::vector<double>& time_s,
                                        const std::vector<double>& values, double longest_s = 0.3);

}  // namespace pinnquad::logs
