// SPDX-License-Identifier: MIT
// Common to the three benchmark programs: the run's context, checks before the first timing, and main's last lines.
#pragma once

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "command_line/build_facts.hpp"

namespace pinnquad::bench {

/// Ends the program: a benchmark of wrong numbers is worth nothing. Writes to stderr, so that JSON on stdout stays
/// whole.
inline void require_close(const char* name, double expected, double actual, double tolerance) {
  if (std::abs(expected - actual) <= tolerance) return;  // false for NaN
  std::fprintf(stderr, "%s computes something else: %.9g instead of %.9g (tolerance %.1g)\n", name, actual, expected,
               tolerance);
  std::exit(1);
}

/// Parses the command line, states the context, runs what was registered.
inline int run_benchmarks(int argc, char** argv) {
  benchmark::AddCustomContext("compiler", programs::compiler_name());
  benchmark::AddCustomContext("flags", programs::compiler_flags());
  benchmark::AddCustomContext("instruction_set", programs::instruction_set());
  benchmark::AddCustomContext("cpu", programs::cpu_name());
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace pinnquad::bench
