// SPDX-License-Identifier: MIT
// The command `convert`: a network that was trained elsewhere as a model, and a model as a network for elsewhere.
#pragma once

#include "command_line/command.hpp"

namespace programs {

Command convert_command(CLI::App& program);

}  // namespace programs
