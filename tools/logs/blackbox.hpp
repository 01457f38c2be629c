// SPDX-License-Identifier: MIT
// Blackbox logs of Betaflight, INAV and their like (.bbl, .bfl, .txt), as the firmware wrote them. The main frames are
// one table, whose columns have the names and units that blackbox_decode gives them with --unit-rotation deg/s
// --unit-acceleration m/s2: "time (us)", "gyroADC[0] (deg/s)", "accSmooth[0] (m/s/s)", "vbatLatest (V)", the rest as it
// stands. GPS and slow frames are the topics "gps" and "slow". Numbers of header lines are parameters.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "pinnquad/logs/read_log.hpp"

namespace pinnquad::logs {

/// Whether a file's first bytes hold a blackbox log: flash that was read out may have others before it.
bool is_blackbox_log(std::string_view begin);

/// The byte at which each flight's log of a file begins.
std::vector<std::size_t> blackbox_flights(std::string_view file);

/// The flight `selection.flight` of a file that stands in memory; `name` is what messages call it.
///
/// Frames are decoded as the loggers define them: a frame that is damaged, and the P frames behind it up to the next I
/// frame, are left out, and `warnings` say how many. A log without an attitude of its own gets "roll", "pitch" and
/// "heading" in degrees, of gyroscope and accelerometer (integrated_attitude.hpp). "motorOutput[0]" and
/// "motorOutput[1]" are parameters of every log: what a motor is sent when it idles and at most.
///
/// Throws InputError, one line with the byte: no such flight, a head that makes no sense.
FlightLog parse_blackbox(std::string_view file, const std::string& name, const LogSelection& selection = {});

}  // namespace pinnquad::logs
