// SPDX-License-Identifier: MIT
// The command `new`: a small project whose training is edited as types, for what no option of `train` chooses.
#pragma once

#include "command_line/command.hpp"

namespace programs {

Command new_command(CLI::App& program);

}  // namespace programs
