// SPDX-License-Identifier: MIT
// A program as pinnquad is shipped: says which of its builds it is, by what name it was called and with what.
#include <cstdio>
#include <cstdlib>

#include "command_line/best_build.hpp"
#include "command_line/build_facts.hpp"
#include "command_line/console.hpp"

int main(int count, char** arguments) {
  return programs::run_program("driver", [&] {
    programs::become_best_build(arguments);
    std::printf("%s\n%s\n", programs::instruction_set().c_str(), arguments[0]);
    for (int i = 1; i < count; ++i) std::printf("%s\n", arguments[i]);
    return std::getenv("PINNQUAD_INSTRUCTION_SET") == nullptr ? 0 : 3;
  });
}
