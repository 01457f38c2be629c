// SPDX-License-Identifier: MIT
// Runs an inner loop at 1 kHz over two seconds of a hover, all samples new in each tick, and prints each Status,
// commands and bias as bits; on a Cortex-M also the instructions of the longest tick, of those in which the bias learns
// and those between, and the stack of the deepest. Then a motion that no training saw: the analytic inverse answers.
#include "board.hpp"
#include "inner_loop.hpp"
#include "samples.hpp"

// BLOCK_FILE: the model's block, in flash.
__asm__(".section .rodata.board_block,\"a\"\n .balign 64\n .global board_block\nboard_block:\n .incbin \"" BLOCK_FILE
        "\"\n .global board_block_end\nboard_block_end:\n .byte 0\n .balign 4\n .text\n");
extern "C" const unsigned char board_block[], board_block_end[];

namespace {

constexpr std::uint32_t ticks = 2000, far_ticks = 60, tick_us = 1000, period_us = 25'000, begin_us = 1'000'000;

/// A hover with the noise of an estimator, near a place that it is to go to.
LoopSample sample_of(std::uint32_t tick, float north_m_s) {
  samples::Numbers numbers(tick);
  LoopSample sample{};
  for (float& x : sample.position_m) x = 0.01F * numbers.next();
  for (float& v : sample.velocity_m_s) v = 0.04F * numbers.next();
  for (float& w : sample.body_rates_rad_s) w = 0.04F * numbers.next();
  sample.velocity_m_s[0] += north_m_s;
  float sum = 1.0F;
  sample.attitude[0] = 1.0F;
  for (int i = 1; i < 4; ++i) {
    sample.attitude[i] = 0.004F * numbers.next();
    const float square = sample.attitude[i] * sample.attitude[i];
    sum += square;
  }
  const float norm = __builtin_sqrtf(sum);
  for (float& q : sample.attitude) q /= norm;
  sample.wanted_position_m[0] = 0.05F;
  sample.wanted_velocity_m_s[0] = north_m_s;
  return sample;
}

void print_numbers(const char* name, const float* values) {
  board::print(name);
  for (int i = 0; i < 4; ++i) board::print_bits(values[i]);
  board::print("\n");
}

}  // namespace

extern "C" int board_main() {
  const auto length = static_cast<std::size_t>(board_block_end - board_block);
  board::print_line("status", "start", pinnquad_loop_start(board_block, length));
  float commands[4] = {}, sums[4] = {};
  std::uint32_t learning = 0, between = 0, far = 0;
  [[maybe_unused]] std::uint32_t stack = 0;  // of the target alone
  for (std::uint32_t tick = 0; tick < ticks + far_ticks; ++tick) {
    const bool is_far = tick >= ticks;
    const std::uint32_t now_us = begin_us + tick * tick_us;
    const LoopSample sample = sample_of(tick, is_far ? 80.0F : 0.0F);
    unsigned char status = 0;
    const auto call = [&] { status = pinnquad_loop_tick(now_us, &sample, commands); };
    const bool learns = now_us / period_us != (now_us - tick_us) / period_us;
#if defined(__ARM_ARCH_7EM__)
    if (learns && tick % 3 == 0) {  // stack and instructions are of different calls
      const std::uint32_t bytes = board::stack_bytes(call);
      if (bytes > stack) stack = bytes;
    } else
#endif
    {
      std::uint32_t& most = is_far ? far : (learns ? learning : between);
      const std::uint32_t count = board::once(call);
      if (count > most) most = count;
    }
    if (tick % 50 == 0) {
      board::print_line("status", is_far ? "far" : "near", status);
      print_numbers("commands", commands);
    }
    if (tick + 1 == ticks) {
      board::print_line("status", "bias", pinnquad_loop_bias(sums));
      print_numbers("sums", sums);
    }
  }
#if defined(__ARM_ARCH_7EM__)
  board::print_line("instructions", "learning", learning);
  board::print_line("instructions", "between", between);
  board::print_line("instructions", "far", far);
  board::print_line("stack", "tick", stack);
#endif
  return 0;
}
