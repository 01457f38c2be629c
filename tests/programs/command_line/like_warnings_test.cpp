// SPDX-License-Identifier: MIT
// Warnings of one kind as one line.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "command_line/like_warnings.hpp"

TEST_CASE("warnings of one kind are one line: the first, how many, where the next ones are") {
  std::vector<std::string> warnings = {"log1: 0.39 s of tumbling at 80.9 s left out", "lag not known: too calm"};
  CHECK(programs::collapsed(warnings, "all") == warnings);
  for (const char* name : {"log2", "log3", "log4", "log5"}) {
    warnings.push_back(std::string(name) + ": 1.5e-3 s of tumbling at 7 s left out");
  }
  warnings.emplace_back("import: calm: no lag");
  warnings.emplace_back("import: windy: no lag");
  warnings.emplace_back("the roll slope is low: noise");
  warnings.emplace_back("the yaw slope is low: noise");
  CHECK(
      programs::collapsed(warnings, "--json prints all") ==
      std::vector<std::string>{
          "log1: 0.39 s of tumbling at 80.9 s left out (and 4 more like it: log2, log3, log4, ...; --json prints all)",
          "lag not known: too calm", "import: calm: no lag (and 1 more like it: windy; --json prints all)",
          "the roll slope is low: noise (and 1 more like it: the yaw slope is low; --json prints all)"});
}
