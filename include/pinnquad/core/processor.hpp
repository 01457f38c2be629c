// SPDX-License-Identifier: MIT
// Whether this processor, under this operating system, runs code compiled for an instruction set. A program that holds
// several asks once, at its start; flight code does not.
#pragma once

#include <string_view>

#include "pinnquad/core/instruction_set.hpp"

#if defined(__x86_64__) || defined(__i386__)
#include <cpuid.h>
#endif

namespace pinnquad {
namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// A name of core/instruction_set.hpp in parts.
struct InstructionSetName {
  std::string_view family, letters;
  constexpr explicit InstructionSetName(std::string_view name) noexcept {
    constexpr std::string_view math = "fast_math";
    if (name.size() >= math.size() && name.substr(name.size() - math.size()) == math) name.remove_suffix(math.size());
    const auto end = name.rfind('_') + 1;  // npos + 1 is 0: no family
    family = name.substr(0, end);
    letters = name.substr(end);
  }
};

#if defined(__x86_64__) || defined(__i386__)

/// The bit of an extension in the answers of the instruction cpuid.
struct CpuidBit {
  enum Register : unsigned char { eax, ebx, ecx, edx };
  char letter;
  unsigned leaf, subleaf;
  Register place;
  unsigned char bit;
};
inline constexpr CpuidBit letters_of_x86[] = {
    {'3', 1, 0, CpuidBit::ecx, 0},           {'s', 1, 0, CpuidBit::ecx, 9},
    {'5', 1, 0, CpuidBit::ecx, 20},          {'p', 1, 0, CpuidBit::ecx, 23},
    {'m', 1, 0, CpuidBit::ecx, 22},          {'6', 1, 0, CpuidBit::ecx, 29},
    {'8', 1, 0, CpuidBit::ecx, 12},          {'1', 7, 0, CpuidBit::ebx, 3},
    {'2', 7, 0, CpuidBit::ebx, 8},           {'7', 7, 0, CpuidBit::ebx, 5},
    {'q', 7, 0, CpuidBit::ebx, 17},          {'i', 7, 0, CpuidBit::ebx, 21},
    {'c', 7, 0, CpuidBit::ebx, 28},          {'w', 7, 0, CpuidBit::ebx, 30},
    {'v', 7, 0, CpuidBit::ebx, 31},          {'b', 7, 0, CpuidBit::ecx, 1},
    {'d', 7, 0, CpuidBit::ecx, 6},           {'f', 7, 0, CpuidBit::ecx, 8},
    {'n', 7, 0, CpuidBit::ecx, 11},          {'g', 7, 0, CpuidBit::ecx, 12},
    {'t', 7, 0, CpuidBit::ecx, 14},          {'h', 7, 0, CpuidBit::edx, 23},
    {'y', 7, 1, CpuidBit::eax, 4},           {'o', 7, 1, CpuidBit::eax, 5},
    {'l', 0x80000001, 0, CpuidBit::ecx, 5},  {'e', 0x80000001, 0, CpuidBit::ecx, 6},
    {'k', 0x80000001, 0, CpuidBit::ecx, 11}, {'4', 0x80000001, 0, CpuidBit::ecx, 16},
    {'u', 0x80000001, 0, CpuidBit::ecx, 21}};
inline constexpr CpuidBit sse4_1{0, 1, 0, CpuidBit::ecx, 19}, os_saves{0, 1, 0, CpuidBit::ecx, 27},
    avx{0, 1, 0, CpuidBit::ecx, 28}, avx512f{0, 7, 0, CpuidBit::ebx, 16};

inline bool processor_has(const CpuidBit& which) noexcept {
  unsigned values[4] = {};
  if (__get_cpuid_count(which.leaf, which.subleaf, &values[0], &values[1], &values[2], &values[3]) == 0) return false;
  return (values[which.place] >> which.bit & 1u) != 0;
}

/// True if the operating system keeps all of these registers when it switches threads; bits of XCR0.
inline bool system_saves(unsigned registers) noexcept {
  if (!processor_has(os_saves)) return false;
  unsigned low = 0, high = 0;
  __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  return (low & registers) == registers;
}

inline bool runs_family(std::string_view family) noexcept {
  constexpr unsigned avx_registers = 0x06, avx512_registers = 0xe6;
  if (family == "avx512_") return processor_has(avx512f) && system_saves(avx512_registers);
  if (family == "avx2_" || family == "avx_" || family == "portable_fma_")
    return processor_has(avx) && system_saves(avx_registers);
  if (family == "sse4_") return processor_has(sse4_1);
  return family == "sse2_" || family == "portable_";
}

inline bool runs_letter(char letter) noexcept {
  for (const CpuidBit& known : letters_of_x86) {
    if (known.letter == letter) return processor_has(known);
  }
  return false;  // an unknown letter
}

#endif

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// True if code whose namespace has this name (core/instruction_set.hpp) runs here. On x86 every letter of the name is
/// looked up; elsewhere only the instruction set of the caller is known to run.
inline bool runs_on_this_processor(std::string_view instruction_set) noexcept {
  if (instruction_set == detail::instruction_set) return true;
#if defined(__x86_64__) || defined(__i386__)
  const detail::InstructionSetName name(instruction_set);
  bool runs = detail::runs_family(name.family);
  for (const char letter : name.letters) runs = runs && detail::runs_letter(letter);
  return runs;
#else
  return false;
#endif
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
