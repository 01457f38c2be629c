// SPDX-License-Identifier: MIT
// A log that is one CSV table (pinnquad/logs/read_log.hpp).
#pragma once

#include <string>

#include "pinnquad/logs/read_log.hpp"

namespace pinnquad::logs {

/// A log of one topic without name; numbers in rows of keys and values above the table are its parameters. A last row
/// without a line end, whose last cell may be cut, is left out with a warning.
FlightLog read_csv_log(const std::string& path, const LogSelection& selection = {});

}  // namespace pinnquad::logs
