// SPDX-License-Identifier: MIT
// `import`: flight logs to one dataset.
#pragma once

#include "command_line/command.hpp"

namespace programs {

Command import_command(CLI::App& program);

}  // namespace programs
