// SPDX-License-Identifier: MIT
// The machine as a measurement needs it: text to the host, instructions executed, stack used. On a Cortex-M by
// semihosting, SysTick and a painted stack, without a C library; on the host only the text.
#pragma once

#include <cstdint>

#if !defined(__ARM_ARCH_7EM__)
#include <cstdio>
#endif

namespace board {

#if defined(__ARM_ARCH_7EM__)

inline void print(const char* text) {
  register std::uint32_t operation __asm__("r0") = 4;  // SYS_WRITE0
  register const char* argument __asm__("r1") = text;
  __asm__ volatile("bkpt 0xab" : "+r"(operation) : "r"(argument) : "memory");
}

/// Counts down at 25 MHz of QEMU's clock. Under `-icount shift=0` an instruction takes 1 ns: one tick is 40
/// instructions.
struct SysTick {
  volatile std::uint32_t control, reload, value;
};
inline constexpr std::uint32_t systick_range = 0xffffff;
inline constexpr std::uint32_t instructions_per_tick = 40;
inline SysTick& systick() { return *reinterpret_cast<SysTick*>(0xe000e010u); }

/// Calls in a row, so that a tick's remainder is a fraction of an instruction per call.
inline constexpr std::uint32_t calls = 400;

/// Starts the timer on the processor's clock; returns its value.
__attribute__((always_inline)) inline std::uint32_t started(SysTick& timer) {
  timer.control = 0;
  timer.reload = systick_range;
  timer.value = 0;
  timer.control = 5;  // processor clock, running
  return timer.value;
}

/// Ticks that `calls` calls take.
template <class Function>
__attribute__((noinline)) std::uint32_t ticks(Function function) {
  SysTick& timer = systick();
  const std::uint32_t begin = started(timer);
  for (std::uint32_t i = 0; i < calls; ++i) function();
  return (begin - timer.value) & systick_range;
}

/// Instructions that one call executes, its return included: `nothing` is called as `function` is, and returns at once.
template <class Function, class Nothing>
std::uint32_t instructions(Function function, Nothing nothing) {
  const std::uint32_t own = (ticks(function) - ticks(nothing)) * instructions_per_tick;
  return (own + calls / 2) / calls + 1;
}

/// Bytes of stack that one call touches below its caller's frame. A painted window that is used up says more than it
/// holds.
template <class Function>
__attribute__((noinline)) std::uint32_t stack_bytes(Function function) {
  constexpr std::uint32_t window = 16384, paint = 0xa5c3965a;
  std::uint32_t top;
  __asm__ volatile("mov %0, sp" : "=r"(top));
  for (std::uint32_t at = top - window; at < top; at += 4) *reinterpret_cast<volatile std::uint32_t*>(at) = paint;
  function();
  std::uint32_t lowest = top - window;
  while (lowest < top && *reinterpret_cast<volatile std::uint32_t*>(lowest) == paint) lowest += 4;
  return top - lowest;
}

#else

inline void print(const char* text) { std::fputs(text, stdout); }

#endif

inline void print_number(std::uint32_t value) {
  char text[12];
  char* at = text + 11;
  *at = 0;
  do {
    *--at = static_cast<char>('0' + value % 10);
    value /= 10;
  } while (value != 0);
  print(at);
}

/// The bits of a float as eight hexadecimal digits; "nan" for every NaN, whose payload is the processor's own.
inline void print_bits(float value) {
  std::uint32_t bits;
  __builtin_memcpy(&bits, &value, sizeof bits);
  if ((bits & 0x7fffffffu) > 0x7f800000u) {
    print(" nan");
    return;
  }
  char text[10] = " ";
  for (int digit = 0; digit < 8; ++digit) text[1 + digit] = "0123456789abcdef"[(bits >> (28 - 4 * digit)) & 15u];
  text[9] = 0;
  print(text);
}

/// "<kind> <name> <number>".
inline void print_line(const char* kind, const char* name, std::uint32_t number) {
  print(kind);
  print(" ");
  print(name);
  print(" ");
  print_number(number);
  print("\n");
}

/// Instructions of one call, to 40 of them; 0 on the host.
template <class Function>
std::uint32_t once(const Function& function) {
#if defined(__ARM_ARCH_7EM__)
  SysTick& timer = systick();
  const std::uint32_t begin = started(timer);
  function();
  return ((begin - timer.value) & systick_range) * instructions_per_tick;
#else
  function();
  return 0;
#endif
}

}  // namespace board

/// A measurement.
extern "C" int board_main();

#if !defined(__ARM_ARCH_7EM__)
int main() { return board_main(); }
#endif
