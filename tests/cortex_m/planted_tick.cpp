// SPDX-License-Identifier: MIT
// Linked around a tick of the inner loop (--wrap): PLANTED_INSTRUCTIONS more.
#include "inner_loop.hpp"

extern "C" unsigned char __real_pinnquad_loop_tick(std::uint32_t now_us, const LoopSample* sample, float* commands);
extern "C" unsigned char __wrap_pinnquad_loop_tick(std::uint32_t now_us, const LoopSample* sample, float* commands) {
  for (int i = 0; i < PLANTED_INSTRUCTIONS / 100; ++i) __asm__ volatile(".rept 96\n nop\n .endr");
  return __real_pinnquad_loop_tick(now_us, sample, commands);
}
