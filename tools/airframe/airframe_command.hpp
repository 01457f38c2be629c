// SPDX-License-Identifier: MIT
// The command `airframe`: lists, checks and converts airframes.
#pragma once

#include "command_line/command.hpp"

namespace programs {

Command airframe_command(CLI::App& program);

}  // namespace programs
