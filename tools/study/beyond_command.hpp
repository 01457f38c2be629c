// SPDX-License-Identifier: MIT
// `pinnquad-study beyond` on the command line.
#pragma once

#include "command_line/command.hpp"

namespace programs {

Command beyond_command(CLI::App& program);

}  // namespace programs
