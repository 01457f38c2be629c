// SPDX-License-Identifier: MIT
// Writes the report of a study into its folder.
//   pinnquad-study report DIR
#include "report/report_command.hpp"

#include <memory>
#include <string>

#include "command_line/options.hpp"
#include "report/report.hpp"

programs::Command programs::report_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand(
      "report", "Writes DIR/report.html, report.json, table3.csv, comparisons.csv and claims.csv of a study");
  const auto folder = std::make_shared<std::string>();
  add_path(*line, "dir", *folder, "DIR", "folder of a study")->required();
  line->footer(
      "Examples:\n"
      "  pinnquad-study paper --seeds 20 --out study && pinnquad-study report study\n"
      "Exit codes: 0 written, whatever its verdicts; 2 bad input or a file that can't be read or written; 130 "
      "interrupted, nothing written.");
  return {line, [folder] {
            report_study(*folder);
            return 0;
          }};
}
