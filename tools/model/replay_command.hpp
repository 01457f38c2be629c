// SPDX-License-Identifier: MIT
// The command `replay`: runs a model, or a flight stack's core, over a log.
#pragma once

#include "command_line/command.hpp"

namespace programs {

Command replay_command(CLI::App& program);

}  // namespace programs
