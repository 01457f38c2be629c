// SPDX-License-Identifier: MIT
// The command `study`: the paper's campaign and the ablation: run, and joined of their parts.
#pragma once

#include "command_line/command.hpp"

namespace programs {

Command study_command(CLI::App& program);

}  // namespace programs
