// SPDX-License-Identifier: MIT
// The program pinnquad: fly, train, judge, prove, export. Each command is a translation unit of its own in its room.
#include <optional>
#include <string>
#include <vector>

#include "command_line/best_build.hpp"
#include "command_line/commands.hpp"
#include "command_line/interrupt.hpp"

namespace programs {  // <name>_command.cpp in the rooms

Command fly_command(CLI::App& program);
Command import_command(CLI::App& program);
Command identify_command(CLI::App& program);
Command train_command(CLI::App& program);
Command evaluate_command(CLI::App& program);
Command benchmark_command(CLI::App& program);
Command certify_command(CLI::App& program);
Command replay_command(CLI::App& program);
Command loop_command(CLI::App& program);
Command block_command(CLI::App& program);
Command convert_command(CLI::App& program);
Command airframe_command(CLI::App& program);

}  // namespace programs

namespace {

int run(int argument_count, char** arguments, std::string& name) {
  CLI::App program("Learns a quadrotor's inverse dynamics from flights and exports a C++ header that may fly", name);
  program.fallthrough();  // --config may stand anywhere
  const std::vector<programs::Command> commands = {
      programs::fly_command(program),     programs::import_command(program),   programs::identify_command(program),
      programs::train_command(program),   programs::evaluate_command(program), programs::certify_command(program),
      programs::replay_command(program),  programs::loop_command(program),     programs::block_command(program),
      programs::convert_command(program), programs::airframe_command(program), programs::benchmark_command(program)};
  program.footer(
      "Examples:\n"
      "  pinnquad fly d1 --seed 1 --out d1.csv                    a simulated flight\n"
      "  pinnquad train d1.csv --out my_model                     my_model/model.hpp flies\n"
      "  pinnquad --config options.toml train                     options from a file\n"
      "pinnquad COMMAND --help says more.\n"
      "Exit codes: 0 success; 1 the result is negative (not exported, refuted, lost); 2 bad input or a file that can't "
      "be read or written; 3 undecided; 70 an internal error: please report it; 130 interrupted. Each command says "
      "which of the others it "
      "has.");
  const std::optional<int> code = programs::choose_command(program, argument_count, arguments, name,
                                                           "; the paper's study is the program pinnquad-study");
  if (code) return *code;
  return programs::run_chosen(commands);
}

}  // namespace

int main(int argument_count, char** arguments) {
  programs::catch_interrupt();
  std::string name = "pinnquad";
  return programs::run_program(name, [&] {
    programs::become_best_build(arguments);
    return run(argument_count, arguments, name);
  });
}
