// SPDX-License-Identifier: MIT
// Prints features and commands of predict() as bits, its Status for good and bad inputs and the self-test's; on a
// Cortex-M also instructions and stack.
#include "board.hpp"
#include "samples.hpp"
#include "under_test.hpp"

namespace {

constexpr int states = 48, most_features = 32;

void fill(std::uint32_t seed, float (&raw)[16]) {
  if (pinnquad_wants_gentle_states()) {
    samples::fill_gentle_raw(seed, raw);
  } else {
    samples::fill_raw(seed, raw);
  }
}

void print_all(const char* name, const float* values, int count) {
  board::print(name);
  for (int i = 0; i < count; ++i) board::print_bits(values[i]);
  board::print("\n");
}

#if defined(__ARM_ARCH_7EM__)
__attribute__((naked, noinline)) unsigned char nothing(const float*, float*) { __asm__ volatile("bx lr"); }

using Function = unsigned char (*)(const float*, float*);

void print_counts(const char* name, const float* raw) {
  float commands[4];
  Function volatile measured = pinnquad_predict;
  Function volatile empty = nothing;
  board::print_line("instructions", name,
                    board::instructions([&] { measured(raw, commands); }, [&] { empty(raw, commands); }));
  board::print_line("stack", name, board::stack_bytes([&] { measured(raw, commands); }));
}
#endif

}  // namespace

extern "C" int board_main() {
  float raw[16], x[most_features], commands[4];
  for (int i = 0; i < states; ++i) {
    fill(static_cast<std::uint32_t>(i), raw);
    pinnquad_features(raw, x);
    print_all("features", x, 16);
    for (float& v : commands) v = -1.0F;
    board::print_line("status", "ordinary", pinnquad_predict(raw, commands));
    print_all("commands", commands, 4);
  }
  board::print_line("status", "self_test", pinnquad_self_test());
  fill(1, raw);
#if defined(__ARM_ARCH_7EM__)
  print_counts("ordinary", raw);
#endif
  raw[4] = __builtin_nanf("");
  board::print_line("status", "not_finite", pinnquad_predict(raw, commands));
#if defined(__ARM_ARCH_7EM__)
  print_counts("not_finite", raw);
#endif
  raw[4] = 1e6F;
  board::print_line("status", "outside_envelope", pinnquad_predict(raw, commands));
  return 0;
}
