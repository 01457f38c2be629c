// SPDX-License-Identifier: MIT
// A log whatever its file is: ULog, a folder that ulog2csv wrote, a CSV table.
#pragma once

#include <string>

#include "logs/flight_log.hpp"
#include "logs/log_selection.hpp"

namespace programs {

enum class LogKind { ulog, ulog2csv_folder, csv };

/// By its first bytes, or by being a folder. Throws pinnquad::InputError for what is none of them.
LogKind kind_of_log(const std::string& path);

/// Throws pinnquad::InputError, one line, for what cannot be read at all; what is lost of the rest is in `warnings`.
FlightLog read_log(const std::string& path, const LogSelection& selection = {});

}  // namespace programs
