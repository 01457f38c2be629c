// SPDX-License-Identifier: MIT
// Makes a synthetic study, and writes the report of a study as pinnquad-study report does:
//   report_driver make DIR SEEDS
//   report_driver report DIR
//   report_driver interrupt DIR       the same, and Ctrl-C comes before the first row is read
#include <csignal>
#include <stdexcept>
#include <string>

#include "command_line/console.hpp"
#include "command_line/interrupt.hpp"
#include "report/report.hpp"
#include "synthetic_study.hpp"

int main(int argument_count, char** arguments) {
  return programs::run_program("report", [&] {
    const std::string command = argument_count > 2 ? arguments[1] : "";
    if (command == "make" && argument_count == 4) {
      synthetic::write_study(arguments[2], std::stoull(arguments[3]));
      return 0;
    }
    if (command != "report" && command != "interrupt") {
      throw std::invalid_argument("report_driver make DIR SEEDS | report DIR | interrupt DIR");
    }
    programs::catch_interrupt();
    if (command == "interrupt") std::raise(SIGINT);
    programs::report_study(arguments[2]);
    return 0;
  });
}
