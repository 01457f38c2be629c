// SPDX-License-Identifier: MIT
// The command `fly`: flies a simulated quadrotor on one of the paper's flights.
#pragma once

#include "command_line/command.hpp"

namespace programs {

Command fly_command(CLI::App& program);

}  // namespace programs
