// SPDX-License-Identifier: MIT
// A log that is one CSV table (pinnquad/logs/read_log.hpp).
#pragma once

#include <string>
#include <string_view>

#include "pinnquad/logs/read_log.hpp"

namespace pinnquad::logs {

/// A cell as a number: NaN of an empty one, and nan and inf as programs write them. False for text.
bool cell_number(std::string_view cell, double& value);

/// A log of one topic without name.
FlightLog read_csv_log(const std::string& path, const LogSelection& selection = {});

}  // namespace pinnquad::logs
