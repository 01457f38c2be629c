// SPDX-License-Identifier: MIT
// Makes a synthetic study, and writes the report of a study as pinnquad report does:
//   report_driver make DIR SEEDS
//   report_driver report DIR
//   report_driver interrupt DIR       the same, and Ctrl-C comes before the first row is read
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>

#include "command_line/interrupt.hpp"
#include "report/report.hpp"
#include "synthetic_study.hpp"

int main(int argument_count, char** arguments) {
  constexpr int bad_input = 2;
  const std::string command = argument_count > 2 ? arguments[1] : "";
  try {
    if (command == "make" && argument_count == 4) {
      synthetic::write_study(arguments[2], std::stoull(arguments[3]));
      return 0;
    }
    if (command == "report" || command == "interrupt") {
      programs::catch_interrupt();
      if (command == "interrupt") std::raise(SIGINT);
      return programs::report_study(arguments[2]);
    }
    std::fprintf(stderr, "report_driver make DIR SEEDS | report DIR | interrupt DIR\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "report: %s\n", error.what());
  }
  return bad_input;
}
