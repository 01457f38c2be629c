// SPDX-License-Identifier: MIT
// ULog files, the logs of PX4: rows of the wanted topics, parameters, facts of the vehicle, what it said, dropouts. A
// field of characters is a text of its topic. Left out: padding, default values of parameters, long information ('M').
#pragma once

#include <string>
#include <string_view>

#include "pinnquad/logs/read_log.hpp"

namespace pinnquad::logs {

/// A ULog file that stands in memory; `name` is what messages call it.
FlightLog parse_ulog(std::string_view file, const std::string& name, const LogSelection& selection = {});

/// Reads the whole part of a log that a crash cut; `warnings` name the lost part, with the byte. Throws InputError, one
/// line with the byte: no ULog file, one that needs a newer reader, definitions that make no sense.
FlightLog read_ulog(const std::string& path, const LogSelection& selection = {});

}  // namespace pinnquad::logs
