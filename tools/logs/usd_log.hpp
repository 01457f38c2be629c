// SPDX-License-Identifier: MIT
// A Crazyflie's log on its uSD card: events, each with named variables, as its firmware's deck driver says and its own
// reader reads (versions 1 and 2). Times are those of the firmware's clock.
#pragma once

#include <string>
#include <string_view>

#include "pinnquad/logs/flight_log.hpp"

namespace pinnquad::logs {

/// Whether a file begins as a uSD log; its first bytes tell.
bool is_usd_log(std::string_view begin);

/// A topic for each kind of event. What is whole of a log that ends early is read, and `warnings` say so. Throws
/// InputError, one line, for what is no such file.
FlightLog read_usd_log(const std::string& path);

}  // namespace pinnquad::logs
