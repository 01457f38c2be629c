// SPDX-License-Identifier: MIT
// The command `certify`: what is proven of a model's response to an angular acceleration, or an example against it.
#pragma once

#include "command_line/command.hpp"

namespace programs {

Command certify_command(CLI::App& program);

}  // namespace programs
