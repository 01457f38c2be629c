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

#include "command_line/listed.hpp"
#include "pinnquad/core/processor.hpp"

namespace programs {

/// A level of x86-64 as -march names it, and the name of what is compiled for it (core/instruction_set.hpp).
struct InstructionSetLevel {
  const char *name, *code;
};
inline constexpr InstructionSetLevel levels_above_baseline[] = {{"x86-64-v4", "avx512_vqwc7812lpm65s3"},
                                                                {"x86-64-v3", "avx2_7812lpm65s3"}};

/// The best build that is there and runs here: `stem`-x86-64-v4`ending`, `stem`-x86-64-v3`ending`, or `baseline`.
/// Throws std::invalid_argument where PINNQUAD_INSTRUCTION_SET names none of these.
inline std::string best_build(const std::string& stem, const std::string& ending, const std::string& baseline) {
  const char* const given = std::getenv("PINNQUAD_INSTRUCTION_SET");
  const std::string wanted = given == nullptr ? "" : given;
  std::string known;
  for (const InstructionSetLevel& level : levels_above_baseline) {
    const std::string file = stem + "-" + level.name + ending;
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored) || !pinnquad::runs_on_this_processor(level.code)) continue;
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
