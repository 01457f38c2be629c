// SPDX-License-Identifier: MIT
// The command `loop`: flies a model from its block, in a closed loop in the simulator.
#pragma once

#include "command_line/command.hpp"

namespace programs {

Command loop_command(CLI::App& program);

}  // namespace programs
