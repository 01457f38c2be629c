// SPDX-License-Identifier: MIT
// The command `loop` of the study: controllers compared in the loop.
#pragma once

#include "command_line/command.hpp"

namespace study {

programs::Command loop_command(CLI::App& program);

}  // namespace study
