// SPDX-License-Identifier: MIT
// A program or a module that is shipped in several builds, one per instruction set (PINNQUAD_INSTRUCTION_SETS): the
// best that runs here is taken. PINNQUAD_INSTRUCTION_SET of the environment names another.
#pragma once

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

#include <unistd.h>
#if defined(__x86_64__)
#include <cpuid.h>
#endif

#include "command_line/listed.hpp"

namespace programs {

/// A level of x86-64 as -march names it, and the bits that say it is there (x86-64 psABI, table 3.1): of cpuid, and of
/// the registers that the operating system keeps when it switches threads.
struct InstructionSetLevel {
  const char* name;
  unsigned leaf_1_ecx, leaf_7_ebx, leaf_80000001_ecx, saved;
};
inline constexpr InstructionSetLevel levels_above_baseline[] = {
    {"x86-64-v4", 0x38d8'3201, 0xd003'0128, 0x21, 0xe6},  // v3, AVX-512 F, DQ, CD, BW, VL
    // SSE3 to SSE4.2, FMA, CMPXCHG16B, MOVBE, POPCNT, OSXSAVE, AVX, F16C; BMI1, AVX2, BMI2; LAHF, LZCNT
    {"x86-64-v3", 0x38d8'3201, 0x0000'0128, 0x21, 0x06}};

inline bool runs_here([[maybe_unused]] const InstructionSetLevel& level) {
#if defined(__x86_64__)
  unsigned a = 0, b = 0, c = 0, d = 0;
  if (__get_cpuid(1, &a, &b, &c, &d) == 0 || (c & level.leaf_1_ecx) != level.leaf_1_ecx) return false;
  if (__get_cpuid_count(7, 0, &a, &b, &c, &d) == 0 || (b & level.leaf_7_ebx) != level.leaf_7_ebx) return false;
  if (__get_cpuid(0x80000001, &a, &b, &c, &d) == 0) return false;
  if ((c & level.leaf_80000001_ecx) != level.leaf_80000001_ecx) return false;
  __asm__ volatile("xgetbv" : "=a"(a), "=d"(d) : "c"(0));  // OSXSAVE, of leaf 1, says that it may be asked
  return (a & level.saved) == level.saved;
#else
  return false;
#endif
}

/// The best build that is there and runs here: `stem`-x86-64-v4`ending`, `stem`-x86-64-v3`ending`, or `baseline`.
/// Throws std::invalid_argument where PINNQUAD_INSTRUCTION_SET names none of these.
inline std::string best_build(const std::string& stem, const std::string& ending, const std::string& baseline) {
  const char* const given = std::getenv("PINNQUAD_INSTRUCTION_SET");
  const std::string wanted = given == nullptr ? "" : given;
  std::string known;
  for (const InstructionSetLevel& level : levels_above_baseline) {
    const std::string file = stem + "-" + level.name + ending;
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored) || !runs_here(level)) continue;
    if (wanted.empty() || wanted == level.name) return file;
    add_to_list(known, level.name);
  }
  if (wanted.empty() || wanted == "x86-64") return baseline;
  add_to_list(known, "x86-64");
  throw std::invalid_argument("PINNQUAD_INSTRUCTION_SET is '" + wanted + "'; here run: " + known);
}

/// Goes on as the best build of this program, which stands in libexec beside the program's own folder; returns where
/// that is this one.
inline void become_best_build(char** arguments) {
  std::error_code none;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", none);
  if (none) return;
  const std::filesystem::path stem = program.parent_path().parent_path() / "libexec" / program.filename();
  const std::string best = best_build(stem.string(), {}, program.string());
  if (best == program.string()) return;
  ::unsetenv("PINNQUAD_INSTRUCTION_SET");  // it has been heard
  ::execv(best.c_str(), arguments);
  throw std::system_error(errno, std::generic_category(), best);
}

}  // namespace programs
