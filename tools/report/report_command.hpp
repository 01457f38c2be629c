// SPDX-License-Identifier: MIT
// The command `report`: writes the report of a study.
#pragma once

#include "command_line/command.hpp"

namespace programs {

Command report_command(CLI::App& program);

}  // namespace programs
