// SPDX-License-Identifier: MIT
// The command `identify`: the vehicle of flights or logs, number by number with intervals, and as an airframe file.
#pragma once

#include "command_line/command.hpp"

namespace programs {

Command identify_command(CLI::App& program);

}  // namespace programs
