// SPDX-License-Identifier: MIT
// The command `block`: writes an exported header as a model block, without compiling.
#pragma once

#include "command_line/command.hpp"

namespace programs {

Command block_command(CLI::App& program);

}  // namespace programs
