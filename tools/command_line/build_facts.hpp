// SPDX-License-Identifier: MIT
// Compiler and processor of this program, for reports of measured figures; its file, for what is kept between its runs.
#pragma once

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "pinnquad/core/fnv1a.hpp"

namespace programs {

inline std::string compiler_name() {
#if defined(__clang__)
  return "clang " __clang_version__;
#elif defined(__GNUC__)
  return "gcc " __VERSION__;
#else
  return "unknown";
#endif
}

/// The build's flags where it states them (PINNQUAD_BUILD_FLAGS), and what the compiler tells by its macros.
inline std::string compiler_flags() {
  std::string flags;
#if defined(PINNQUAD_BUILD_FLAGS)
  flags = PINNQUAD_BUILD_FLAGS;
  if (!flags.empty()) flags += "; ";
#endif
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
  return flags;
}

/// Of this program's kernels: trained weights depend on it in their last bits.
inline std::string instruction_set() {
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

/// As Linux names it; "unknown" elsewhere.
inline std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.compare(0, 10, "model name") == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

/// Another number for another program, by size and time of its file.
inline std::uint64_t program_hash() {
  pinnquad::detail::Fnv1a fnv;
  std::error_code ignored;
  const std::filesystem::path program = "/proc/self/exe";
  const auto size = std::filesystem::file_size(program, ignored);
  fnv.absorb_word(ignored ? 0 : size);
  const auto time = std::filesystem::last_write_time(program, ignored);
  fnv.absorb_word(ignored ? 0 : static_cast<std::uint64_t>(time.time_since_epoch().count()));
  return fnv.hash;
}

/// "2026-11-21T13:05:00Z"
inline std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm fields{};
  char text[32] = "";
  if (gmtime_r(&now, &fields) != nullptr) std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &fields);
  return text;
}

}  // namespace programs
