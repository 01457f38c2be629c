// SPDX-License-Identifier: MIT
// What the three benchmark programs share: the run's context, checks before the first timing, and main's last lines.
#pragma once

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace pinnquad::bench {

/// Ends the program: a benchmark of wrong numbers is worth nothing. Writes to stderr, so that JSON on stdout stays whole.
inline void require_close(const char* name, double expected, double actual, double tolerance) {
  if (std::abs(expected - actual) <= tolerance) return;  // false for NaN
  std::fprintf(stderr, "%s computes something else: %.9g instead of %.9g (tolerance %.1g)\n", name, actual, expected,
               tolerance);
  std::exit(1);
}

/// What the compiler was asked for, as it tells itself by its predefined macros.
inline std::string compiler_flags() {
  std::string flags;
#if defined(__OPTIMIZE__)
  flags += "optimised";
#else
  flags += "not optimised";
#endif
#if defined(NDEBUG)
  flags += ", NDEBUG";
#else
  flags += ", assertions on";
#endif
#if defined(__FAST_MATH__)
  flags += ", fast-math";
#endif
#if defined(PINNQUAD_BENCH_FLAGS)
  flags += "; " PINNQUAD_BENCH_FLAGS;
#endif
  return flags;
}

inline const char* instruction_set() {
#if defined(__AVX512F__)
  return "AVX-512";
#elif defined(__AVX2__) && defined(__FMA__)
  return "AVX2 + FMA";
#elif defined(__SSE2__)
  return "baseline x86-64 (SSE2)";
#else
  return "portable";
#endif
}

inline const char* compiler() {
#if defined(__clang__)
  return "clang " __clang_version__;
#elif defined(__GNUC__)
  return "gcc " __VERSION__;
#else
  return "unknown";
#endif
}

/// Parses the command line, states the context, runs what was registered.
inline int run_benchmarks(int argc, char** argv) {
  benchmark::AddCustomContext("compiler", compiler());
  benchmark::AddCustomContext("flags", compiler_flags());
  benchmark::AddCustomContext("instruction_set", instruction_set());
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace pinnquad::bench
