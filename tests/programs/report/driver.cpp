// SPDX-License-Identifier: MIT
// Writes the report of a study, as paper_study does:  report_driver DIR
#include <cstdio>
#include <exception>

#include "study_report.hpp"

int main(int argument_count, char** arguments) {
  if (argument_count != 2) return 2;
  try {
    programs::write_study_report(arguments[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "report: %s\n", error.what());
    return 2;
  }
}
