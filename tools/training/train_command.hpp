// SPDX-License-Identifier: MIT
// The command `train`: trains networks on recorded flights, judges them, exports the best.
#pragma once

#include "command_line/command.hpp"

namespace programs {

Command train_command(CLI::App& program);

}  // namespace programs
