// SPDX-License-Identifier: MIT
// The flown motion of two periods: its closed form, one instant for motion and commands, gaps and broken samples.
#include "pinnquad/control/flown_motion.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "pinnquad/core/random.hpp"

using namespace pinnquad;

namespace {

using Flown = FlownMotion<double>;

constexpr std::uint64_t period_us = 25'000, tick_us = 2'500;
constexpr double period_s = 0.025, tick_s = 0.0025;
constexpr double rounding = 1e-9;
const double no_number = std::numeric_limits<double>::quiet_NaN();

double seconds(std::uint64_t us) { return 1e-6 * static_cast<double>(us); }

/// A motion that turns, swings and climbs.
State<double> swinging(double t) {
  State<double> state;
  state.velocity_m_s = {2 * std::sin(7 * t), std::cos(5 * t), -0.5 * t};
  state.body_rates_rad_s = {0.3 * std::sin(11 * t), 0.2 * std::cos(9 * t), 0.1};
  state.attitude = {std::cos(0.4 * t), std::sin(0.4 * t), 0, 0};
  return state;
}

/// Commands that follow from the state at once.
Commands<double> following(const State<double>& state) {
  const auto& v = state.velocity_m_s;
  return {0.5 + 0.01 * v[0], 0.5 + 0.02 * v[1], 0.5 - 0.03 * v[2], 0.5 + 0.1 * state.body_rates_rad_s[0]};
}

/// One tick with samples of the same instant. True if a motion is complete.
bool tell(Flown& flown, std::uint64_t now_us, const State<double>& state, const Commands<double>& commands,
          bool known = true) {
  const bool complete = flown.tick(now_us, known, state, commands);
  flown.velocity(now_us, state.velocity_m_s);
  flown.body_rates(now_us, state.body_rates_rad_s);
  return complete;
}

Vector3<double> world_velocity(const Flown& flown) {
  return body_to_world<double>(flown.motion().attitude, flown.motion().velocity_m_s);
}
Vector3<double> world_acceleration_of(const Flown& flown) {
  State<double> state;
  state.attitude = flown.motion().attitude;
  state.velocity_m_s = world_velocity(flown);
  state.body_rates_rad_s = flown.motion().body_rates_rad_s;
  return world_acceleration<double>(state, flown.motion().linear_acceleration_m_s2);
}

/// As long as commands follow the state, their means do.
void check_pair(const Flown& flown) {
  const Vector3<double> v = world_velocity(flown);
  CHECK(std::abs(flown.flown()[0] - 0.5 - 0.01 * v[0]) <= rounding);
  CHECK(std::abs(flown.flown()[1] - 0.5 - 0.02 * v[1]) <= rounding);
  CHECK(std::abs(flown.flown()[2] - 0.5 + 0.03 * v[2]) <= rounding);
  CHECK(std::abs(flown.flown()[3] - 0.5 - 0.1 * flown.motion().body_rates_rad_s[0]) <= rounding);
}

}  // namespace

TEST_CASE("a sine: state and acceleration are those of the border, times the kernels of the weights") {
  // n samples a period: their mean is D of the sine in its middle, D = sin(n w h / 2) / (n sin(w h / 2)); of the
  // triangle over two periods it is D^2 at the border. The acceleration's samples lie half a tick before it.
  for (const double w : {1.0, 9.0, 40.0}) {
    Flown flown;
    int motions = 0;
    for (std::uint64_t now_us = 1'000'000; now_us <= 3'000'000; now_us += tick_us) {
      State<double> state;
      state.velocity_m_s = {2 * std::sin(w * seconds(now_us)), 0, 0};
      state.body_rates_rad_s = {0, 0.3 * std::sin(w * seconds(now_us)), 0};
      if (!tell(flown, now_us, state, {})) continue;
      ++motions;
      const double border_s = seconds(now_us - period_us), n = period_s / tick_s;
      const double kernel = std::sin(n * w * tick_s / 2) / (n * std::sin(w * tick_s / 2));
      const double mean = kernel * kernel * std::sin(w * border_s);
      const double slope = 2 / period_s * std::sin(w * period_s / 2) * kernel * std::cos(w * (border_s - 0.5 * tick_s));
      CHECK(std::abs(world_velocity(flown)[0] - 2 * mean) <= rounding);
      CHECK(std::abs(flown.motion().body_rates_rad_s[1] - 0.3 * mean) <= rounding);
      CHECK(std::abs(world_acceleration_of(flown)[0] - 2 * slope) <= 1e3 * rounding);
      CHECK(std::abs(flown.motion().angular_acceleration_rad_s2[1] - 0.3 * slope) <= 1e3 * rounding);
    }
    CHECK(motions == 78);  // of 80 periods: nobody knows what flew before the first tick, and the second has no other
  }
}

TEST_CASE("commands are behind the rotors' lag: a step's closed form under the triangle") {
  // 1 - exp(-t / lag) under a triangle of two periods that begins with the step
  for (const double lag_s : {0.005, 0.02, 0.05}) {
    constexpr std::uint64_t fine_us = 100;
    Flown flown(period_us, lag_s, 0.0);
    int motions = 0;
    for (std::uint64_t now_us = 950'000; now_us <= 1'050'000; now_us += fine_us) {
      Commands<double> commands{};
      if (now_us > 1'000'000) commands.fill(1);
      if (!tell(flown, now_us, State<double>{}, commands) || now_us < 1'050'000) continue;
      ++motions;
      const double x = period_s / lag_s;
      const double expected = 1 - std::exp(-x) * 2 * (std::cosh(x) - 1) / (x * x);
      CHECK(std::abs(flown.flown()[2] - expected) <= seconds(fine_us) / lag_s);  // Euler's steps
    }
    CHECK(motions == 1);
  }
}

TEST_CASE("a state that comes late is paired with the commands of its own time") {
  for (const std::uint64_t delay_us : {0u, 5'000u, 20'000u, 40'000u}) {
    Flown flown(period_us, 0.0, seconds(delay_us));
    int motions = 0;
    for (std::uint64_t now_us = 1'000'000; now_us <= 3'000'000; now_us += tick_us) {
      const Commands<double> commands = following(swinging(seconds(now_us)));
      if (!tell(flown, now_us, swinging(seconds(now_us - delay_us)), commands)) continue;
      ++motions;
      check_pair(flown);
    }
    // the first is of commands from before there were any
    CHECK(motions >= 76);
  }
  // what is not said is not aligned
  Flown flown;
  double worst = 0;
  for (std::uint64_t now_us = 1'000'000; now_us <= 3'000'000; now_us += tick_us) {
    if (tell(flown, now_us, swinging(seconds(now_us) - 0.02), following(swinging(seconds(now_us))))) {
      worst = std::max(worst, std::abs(flown.flown()[0] - 0.5 - 0.01 * world_velocity(flown)[0]));
    }
  }
  CHECK(worst > 1e-3);
}

TEST_CASE("between the ticks of a delay the commands kept are no further away than their spacing") {
  // 3.7 ms ticks and 40 ms: neither is a multiple of the other, and what is kept is spaced by 1.8 ms at least
  constexpr std::uint64_t odd_us = 3'700;
  Flown flown(50'000, 0.0, 0.04);
  int motions = 0;
  for (std::uint64_t now_us = 1'000'000; now_us <= 3'000'000; now_us += odd_us) {
    const double t = seconds(now_us);
    State<double> state;
    state.velocity_m_s = {t - 0.04, 0, 0};
    if (!tell(flown, now_us, state, {t, t, t, t})) continue;
    ++motions;
    const double late_s = world_velocity(flown)[0] - flown.flown()[0];
    CHECK(late_s >= -rounding);
    CHECK(late_s <= seconds(odd_us));
  }
  CHECK(motions >= 37);
}

TEST_CASE("samples that are irregular and rare: a constant acceleration is found exactly") {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> jitter_us(-3'000, 3'000);
  const Vector3<double> acceleration(0.7, -1.1, 2.0);
  Flown flown;
  int motions = 0;
  std::uint64_t next_velocity_us = 1'000'000, grid_us = next_velocity_us;
  for (std::uint64_t now_us = 1'000'000; now_us <= 4'000'000; now_us += 2'000) {
    const double t = seconds(now_us);
    State<double> state;
    state.velocity_m_s = acceleration * t;
    if (flown.tick(now_us, true, state, {})) {
      ++motions;
      CHECK((world_acceleration_of(flown) - acceleration).norm() <= 1e3 * rounding);
    }
    if (now_us >= next_velocity_us) {  // 50 Hz, taken a little before it is told
      flown.velocity(next_velocity_us, acceleration * seconds(next_velocity_us));
      grid_us += 20'000;
      next_velocity_us = grid_us + static_cast<std::uint64_t>(3'000 + jitter_us(random));
    }
    flown.body_rates(now_us, Vector3<double>::Zero());
  }
  CHECK(motions >= 110);  // of 120; a sample that comes after its period's end is not taken
}

TEST_CASE("noise of the velocity cancels in the sum of the accelerations") {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 0.05);
  Flown flown;
  double sum = 0, worst_sum = 0, worst = 0;
  int motions = 0;
  for (std::uint64_t now_us = 1'000'000; now_us <= 31'000'000; now_us += tick_us) {
    State<double> state;
    state.velocity_m_s = {noise(random), 0, 0};
    if (!tell(flown, now_us, state, {})) continue;
    ++motions;
    const double a = world_acceleration_of(flown)[0];
    sum += a * period_s;
    worst_sum = std::max(worst_sum, std::abs(sum));
    worst = std::max(worst, std::abs(a) * period_s);
  }
  CHECK(motions >= 1190);
  // two means of ten samples are left of 1200 periods; a sum of independent ones would be 0.8 m/s
  CHECK(worst_sum <= 2 * worst);
  CHECK(worst_sum <= 8 * 0.05 / std::sqrt(10.0));
}

TEST_CASE(
    "a gap, a state that is no number, time that runs backwards or jumps: the periods that saw it have no motion") {
  struct Fault {
    const char* name;
    std::uint64_t jump_us;
    bool backwards, known, finite;
  };
  const Fault faults[] = {{"none", 0, false, true, true},
                          {"gap of 15 ms", 15'000, false, true, true},
                          {"gap of 1 s", 1'000'000, false, true, true},
                          {"backwards", 500'000, true, true, true},
                          {"other commands", 0, false, false, true},
                          {"no number", 0, false, true, false}};
  for (const Fault& fault : faults) {
    CAPTURE(fault.name);
    Flown flown;
    std::uint64_t now_us = 1'000'000;
    int motions = 0;
    for (int i = 0; i < 400; ++i) {
      now_us += tick_us;
      const bool here = i == 203;
      if (here) now_us += fault.backwards ? -fault.jump_us : fault.jump_us;
      State<double> state = swinging(seconds(now_us));
      if (here && !fault.finite) state.velocity_m_s[1] = no_number;
      if (!tell(flown, now_us, state, following(swinging(seconds(now_us))), fault.known || !here)) continue;
      ++motions;
      check_pair(flown);
      CHECK(all_finite(flown.motion().linear_acceleration_m_s2));
      CHECK(all_finite(flown.motion().angular_acceleration_rad_s2));
    }
    const bool whole = fault.jump_us == 0 && fault.known && fault.finite;
    if (whole) CHECK(motions == 38);
    if (!whole) CHECK(motions >= 34);
    if (!whole) CHECK(motions <= 36);  // each tick is of two motions
  }
}

TEST_CASE("commands and rates that are no numbers give no motion, and are gone two periods later") {
  for (const bool in_commands : {true, false}) {
    Flown flown;
    int motions = 0, after = 0;
    for (int i = 0; i < 400; ++i) {
      const std::uint64_t now_us = 1'000'000 + static_cast<std::uint64_t>(i) * tick_us;
      State<double> state = swinging(seconds(now_us));
      Commands<double> commands = following(state);
      if (i == 203) (in_commands ? commands[2] : state.body_rates_rad_s[1]) = no_number;
      if (!tell(flown, now_us, state, commands)) continue;
      ++motions;
      after += i > 240 ? 1 : 0;
      check_pair(flown);
    }
    CHECK(motions >= 34);
    CHECK(motions <= 36);
    CHECK(after >= 15);
  }
}

TEST_CASE("an attitude and its negative are one") {
  Flown plain, turning;
  int motions = 0;
  for (int i = 0; i < 400; ++i) {
    const std::uint64_t now_us = 1'000'000 + static_cast<std::uint64_t>(i) * tick_us;
    const State<double> state = swinging(seconds(now_us));
    State<double> other = state;
    const auto& q = state.attitude;
    if (i % 3 == 1 || (i > 100 && i < 200)) other.attitude = {-q.w, -q.x, -q.y, -q.z};
    const bool complete = tell(plain, now_us, state, following(state));
    REQUIRE(tell(turning, now_us, other, following(state)) == complete);
    if (!complete) continue;
    ++motions;
    const auto &a = plain.motion(), &b = turning.motion();
    CHECK((a.linear_acceleration_m_s2 - b.linear_acceleration_m_s2).norm() <= rounding);
    CHECK((a.velocity_m_s - b.velocity_m_s).norm() <= rounding);
  }
  CHECK(motions >= 37);
}

TEST_CASE("a replay that begins in the middle has the same motions, to the bit") {
  Flown whole, part;
  int compared = 0;
  for (int i = 0; i < 800; ++i) {
    const std::uint64_t now_us =
        1'000'000 + static_cast<std::uint64_t>(i) * tick_us + static_cast<std::uint64_t>(i % 3) * 100;
    const State<double> state = swinging(seconds(now_us));
    const bool complete = tell(whole, now_us, state, following(state));
    if (i < 333) continue;
    if (!tell(part, now_us, state, following(state))) continue;
    REQUIRE(complete);
    ++compared;
    CHECK(part.flown() == whole.flown());
    CHECK(part.motion().linear_acceleration_m_s2 == whole.motion().linear_acceleration_m_s2);
    CHECK(part.motion().angular_acceleration_rad_s2 == whole.motion().angular_acceleration_rad_s2);
    CHECK(part.motion().velocity_m_s == whole.motion().velocity_m_s);
  }
  CHECK(compared >= 43);
}

TEST_CASE("the noise of a sample cancels from motion to motion, at any rate of samples") {
  for (const int sample_every : {1, 7, 10, 25}) {  // 25: each on the border of two periods
    pinnquad::FlownMotion<double> motion;
    pinnquad::State<double> state;
    std::mt19937_64 engine(1);
    double sum = 0;
    int motions = 0;
    for (int ms = 1; ms < 40000; ++ms) {
      const auto now_us = static_cast<std::uint64_t>(1'000'000 + 1000 * ms);
      if (ms % sample_every == 0) {
        state.velocity_m_s[0] = 0.02 * pinnquad::standard_normal(engine);
        motion.velocity(now_us, state.velocity_m_s);
      }
      motion.body_rates(now_us, state.body_rates_rad_s);
      if (motion.tick(now_us, true, state, {0.5, 0.5, 0.5, 0.5})) {
        sum += motion.motion().linear_acceleration_m_s2[0] * period_s;
        ++motions;
      }
    }
    CHECK(motions > 1500);
    CHECK(std::abs(sum) < 0.08);  // the difference of two means of 0.02 m/s, not of 1500 of them
  }
}
