// SPDX-License-Identifier: MIT
// OnboardInverse at 500 Hz for twelve seconds: commands of sines and noise, four axes that answer them as an unknown
// vehicle does. Prints the slopes that it finds as bits; on a Cortex-M also the instructions of the longest tick by
// kind, those of a second, and the stack of the deepest tick.
#include <new>

#include "board.hpp"
#include "pinnquad/control/onboard/onboard_inverse.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "samples.hpp"

namespace {

using namespace pinnquad;
using Learner = OnboardInverse<float>;

constexpr std::uint32_t ticks = 6000, tick_us = 2000, begin_us = 1'000'000, ticks_per_second = 500;

/// A learner and four axes: angular accelerations and specific force that the sums make behind a lag of 20 ms.
struct Flight {
  Learner learner{airframe_value<PaperQuadrotor, float>()};
  State<float> state{};
  Commands<float> commands{};
  float turn_rad_s2[3] = {}, climb_m_s2 = 0;

  void step(samples::Numbers& noise) {
    constexpr float slopes[3] = {75.0F, 58.0F, 7.0F}, share = 1.0F / 11.0F, step_s = 0.002F;
    const Commands<float>& u = commands;
    const float sums[3] = {-u[0] + u[1] + u[2] - u[3], u[0] - u[1] + u[2] - u[3], u[0] + u[1] - u[2] - u[3]};
    for (int i = 0; i < 3; ++i) {
      float& rate_rad_s = state.body_rates_rad_s[i];
      turn_rad_s2[i] += share * (slopes[i] * sums[i] - 2.0F * rate_rad_s - turn_rad_s2[i]);
      rate_rad_s += step_s * turn_rad_s2[i] + 0.002F * noise.next();
    }
    climb_m_s2 += share * (9.8F - 5.6F * (u[0] + u[1] + u[2] + u[3]) - climb_m_s2);
    state.velocity_m_s[2] += step_s * climb_m_s2 + 0.001F * noise.next();
  }
};

/// Triangle waves of 0.6 to 1.6 Hz on each sum, which no C library's sine makes: the same bits everywhere.
void command(std::uint32_t tick, samples::Numbers& noise, Commands<float>& commands) {
  constexpr std::uint32_t periods[4] = {310, 430, 370, 830};
  constexpr float most[4] = {0.05F, 0.02F, 0.02F, 0.03F};
  constexpr float signs[4][4] = {{1, 1, 1, 1}, {-1, 1, 1, -1}, {1, -1, 1, -1}, {1, 1, -1, -1}};
  commands = {0.437F, 0.437F, 0.437F, 0.437F};
  for (int k = 0; k < 4; ++k) {
    const float along = static_cast<float>(tick % periods[k]) / static_cast<float>(periods[k]);
    const float wave = along < 0.5F ? 4.0F * along - 1.0F : 3.0F - 4.0F * along;
    for (std::size_t i = 0; i < 4; ++i) commands[i] += signs[k][i] * (most[k] * wave + 0.002F * noise.next());
  }
}

alignas(Flight) unsigned char memory[sizeof(Flight)];
Flight* flight = nullptr;
std::uint64_t now_us = begin_us;

void learn() { flight->learner.learn(now_us, true, flight->state, flight->commands); }
void ask() {
  Accelerations<float> wanted;
  wanted.linear_m_s2[2] = 0.1F;
  Commands<float> answer{};
  static_cast<void>(flight->learner(flight->state, wanted, now_us, answer));
}

}  // namespace

extern "C" int board_main() {
  flight = new (static_cast<void*>(memory)) Flight;
  flight->learner.excite(true);
  samples::Numbers noise(7);
  std::uint32_t row = 0, proposal = 0, between = 0, asked = 0, second = 0, most_of_second = 0, before = 0;
  [[maybe_unused]] std::uint32_t stack = 0;
  for (std::uint32_t tick = 1; tick <= ticks; ++tick) {
    now_us = begin_us + tick * tick_us;
    command(tick, noise, flight->commands);
    flight->step(noise);
    const std::uint32_t of_question = board::once(ask);
    if (of_question > asked) asked = of_question;
#if defined(__ARM_ARCH_7EM__)
    if (tick % 53 == 0) {  // stack and instructions are of different calls
      const std::uint32_t bytes = board::stack_bytes(learn);
      if (bytes > stack) stack = bytes;
      before = flight->learner.rows();
      continue;
    }
#endif
    const std::uint32_t count = board::once(learn);
    second += count;
    if (tick % ticks_per_second == 0) {
      if (second > most_of_second) most_of_second = second;
      second = 0;
    }
    const std::uint32_t rows = flight->learner.rows();
    std::uint32_t& most = rows == before ? between : (rows % 50 == 0 ? proposal : row);
    if (count > most) most = count;
    before = rows;
  }
  board::print_line("rows", "learnt", flight->learner.rows());
  board::print("slopes");
  for (const auto& sum : flight->learner.candidate()) board::print_bits(sum.forward.slope());
  board::print("\n");
  board::print_line("bytes", "learner", sizeof(Learner));
#if defined(__ARM_ARCH_7EM__)
  board::print_line("instructions", "row", row);
  board::print_line("instructions", "proposal", proposal);
  board::print_line("instructions", "between", between);
  board::print_line("instructions", "asked", asked);
  board::print_line("second", "learnt", most_of_second);
  board::print_line("stack", "tick", stack);
#endif
  return 0;
}
