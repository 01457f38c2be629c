// SPDX-License-Identifier: MIT
// Common to all fuzzers: a rule whose breach stops it, and how often its inputs were accepted.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

namespace pinnquad_test {

/// A finding: said and stopped at, so that libFuzzer keeps the input.
inline void expect(bool holds, const char* rule) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", rule);
  std::abort();
}

/// A refusal or a warning is one line that a terminal can show.
inline void expect_one_line(const std::string& what) {
  expect(std::all_of(what.begin(), what.end(), [](char c) { return static_cast<unsigned char>(c) >= ' '; }),
         "what is told is one line");
}

/// How often the inputs came to what, told at the end: a fuzzer whose inputs are all refused tests little.
struct Tally {
  std::map<std::string, unsigned long> count;
  ~Tally() {
    for (const auto& [outcome, times] : count) std::fprintf(stderr, "tally: %lu times %s\n", times, outcome.c_str());
  }
};

}  // namespace pinnquad_test
