// SPDX-License-Identifier: MIT
// A command of a program: how it stands in the command line, and what it does when it was chosen. Each is a translation
// unit of its own, `<room>/<name>_command.cpp`.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace programs {

struct Command {
  CLI::App* line = nullptr;  ///< owned by the program; it parsed something if the command was chosen
  std::function<int()> run;  ///< the exit code; what it throws is for run_program
};

}  // namespace programs
