// SPDX-License-Identifier: MIT
// Makes a synthetic study, and writes the report of a study as pinnquad report does:
//   report_driver make DIR SEEDS
//   report_driver report DIR
#include <cstdio>
#include <exception>
#include <string>

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
    if (command == "report") {
      return programs::write_study_report(arguments[2]) ? 0 : 1;
    }
    std::fprintf(stderr, "report_driver make DIR SEEDS | report DIR\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "report: %s\n", error.what());
  }
  return bad_input;
}
