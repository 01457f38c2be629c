// SPDX-License-Identifier: MIT
// Prints the bits of the network's outputs for all kinds of inputs; on a Cortex-M also instructions and stack of each.
#include "board.hpp"
#include "samples.hpp"
#include "under_test.hpp"

namespace {

constexpr int inputs = 16, outputs = 4, ordinary_samples = 64;

void print_outputs(const char* name, const float* x) {
  float y[outputs] = {};
  pinnquad_forward(x, y);
  board::print("bits ");
  board::print(name);
  for (const float v : y) board::print_bits(v);
  board::print("\n");
}

#if defined(__ARM_ARCH_7EM__)
/// A thousand instructions and a return: what the counter must say of it is known.
__attribute__((naked, noinline)) void thousand_and_one(const float*, float*) {
  __asm__ volatile(".rept 1000\n nop\n .endr\n bx lr");
}
__attribute__((naked, noinline)) void nothing(const float*, float*) { __asm__ volatile("bx lr"); }

using Function = void (*)(const float*, float*);

/// Through a volatile pointer: every function is called alike, and none is left out.
std::uint32_t instructions_of(Function function, const float* x) {
  float y[outputs];
  Function volatile measured = function;
  Function volatile empty = nothing;
  return board::instructions([&] { measured(x, y); }, [&] { empty(x, y); });
}

void print_counts(const char* name, const float* x) {
  float y[outputs];
  board::print_line("instructions", name, instructions_of(pinnquad_forward, x));
  board::print_line("stack", name, board::stack_bytes([&] { pinnquad_forward(x, y); }));
}
#endif

}  // namespace

extern "C" int board_main() {
  float x[inputs];
  for (int i = 0; i < ordinary_samples; ++i) {
    samples::fill(samples::kinds[0], static_cast<std::uint32_t>(i), x);
    print_outputs("ordinary", x);
  }
  for (const samples::Kind& kind : samples::kinds) {
    samples::fill(kind, 1, x);
    print_outputs(kind.name, x);
  }
#if defined(__ARM_ARCH_7EM__)
  board::print("workspace bytes ");
  board::print_number(pinnquad_workspace_bytes());
  board::print("\ncounter ");
  board::print_number(instructions_of(thousand_and_one, x));
  board::print("\n");
  for (const samples::Kind& kind : samples::kinds) {
    samples::fill(kind, 1, x);
    print_counts(kind.name, x);
  }
#endif
  return 0;
}
