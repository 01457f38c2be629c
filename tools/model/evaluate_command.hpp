// SPDX-License-Identifier: MIT
// The command `evaluate`: judges a model block on flights, without compiling.
#pragma once

#include "command_line/command.hpp"

namespace programs {

Command evaluate_command(CLI::App& program);

}  // namespace programs
