// SPDX-License-Identifier: MIT
// The command `wrench`: the residual wrench of a vehicle, from flights to a block and a header.
#pragma once

#include "command_line/command.hpp"

namespace study {

programs::Command wrench_command(CLI::App& program);

}  // namespace study
