// SPDX-License-Identifier: MIT
// The flown motion behind a low-pass: its step and its sine against the Butterworth's closed forms.
#include "pinnquad/control/filtered_motion.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

using namespace pinnquad;

namespace {

using Filtered = FilteredMotion<double>;
constexpr std::uint64_t tick_us = 500;
constexpr double tick_s = 5e-4;
constexpr double cutoff_rad_s = Filtered::usual_cutoff_rad_s;
constexpr double euler = 0.6 * cutoff_rad_s * tick_s;  ///< steps of the integration, relative
const double no_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("a step: 1 - exp(-a) (cos a + sin a), a = w t / sqrt 2, of velocity, rates and commands alike") {
  Filtered filtered;
  int compared = 0;
  for (int i = 0; i < 600; ++i) {
    const bool stepped = i > 200;
    State<double> state;
    if (stepped) state.velocity_m_s[0] = 1, state.body_rates_rad_s[2] = 0.5;
    Commands<double> commands{};
    if (stepped) commands.fill(0.7);
    const auto now_us = 1'000'000 + static_cast<std::uint64_t>(i) * tick_us;
    const bool settled = filtered.tick(now_us, true, state, commands);
    CHECK(settled == (i * tick_s * cutoff_rad_s >= 6 - 1e-9 || (settled && i >= 159)));
    if (!stepped) continue;
    REQUIRE(settled);
    ++compared;
    const double t = (i - 200) * tick_s, a = cutoff_rad_s * t / std::sqrt(2.0);
    const double expected = 1 - std::exp(-a) * (std::cos(a) + std::sin(a));
    const double slope = std::sqrt(2.0) * cutoff_rad_s * std::exp(-a) * std::sin(a);
    CHECK(std::abs(filtered.motion().velocity_m_s[0] - expected) <= euler);
    CHECK(std::abs(filtered.motion().body_rates_rad_s[2] - 0.5 * expected) <= euler);
    CHECK(std::abs(filtered.flown()[1] - 0.7 * expected) <= euler);
    CHECK(std::abs(filtered.motion().angular_acceleration_rad_s2[2] - 0.5 * slope) <= cutoff_rad_s * euler);
  }
  CHECK(compared == 399);
}

TEST_CASE("a sine's acceleration: gain 1 / sqrt(1 + (f / w)^4), late by atan2(sqrt 2 w f, w^2 - f^2)") {
  for (const double f : {5.0, 20.0, 75.0, 150.0}) {
    Filtered filtered;
    // what the acceleration has of sine and cosine, over whole turns
    const int turn_ticks = static_cast<int>(std::lround(6.283185307179586 / f / tick_s));
    const double tuned = 6.283185307179586 / (turn_ticks * tick_s);
    double in_phase = 0, across = 0, angular = 0, attitude_error = 0;
    for (int i = 0; i < 40 * turn_ticks; ++i) {
      const double t = i * tick_s;
      State<double> state;
      state.velocity_m_s[0] = std::sin(tuned * t) / tuned;  // an acceleration of 1 m/s^2
      state.body_rates_rad_s[0] = 0.001 * std::sin(tuned * t) / tuned;
      const auto now_us = 1'000'000 + static_cast<std::uint64_t>(i) * tick_us;
      const bool settled = filtered.tick(now_us, true, state, {});
      if (i < 20 * turn_ticks) continue;
      REQUIRE(settled);
      const double a = filtered.motion().linear_acceleration_m_s2[0];
      in_phase += a * std::cos(tuned * t) / (10 * turn_ticks);
      across += a * std::sin(tuned * t) / (10 * turn_ticks);
      angular += filtered.motion().angular_acceleration_rad_s2[0] * std::cos(tuned * t) / (10 * turn_ticks);
      attitude_error = std::max(attitude_error, std::abs(filtered.motion().attitude.w - 1));
    }
    const double ratio = tuned / cutoff_rad_s;
    const double gain = 1 / std::sqrt(1 + ratio * ratio * ratio * ratio);
    const double phase = std::atan2(std::sqrt(2.0) * ratio, 1 - ratio * ratio);
    CAPTURE(f);
    CHECK(std::hypot(in_phase, across) == doctest::Approx(gain).epsilon(2 * euler));
    CHECK(std::atan2(across, in_phase) == doctest::Approx(phase).epsilon(0.01 + euler));
    CHECK(angular == doctest::Approx(0.001 * in_phase).epsilon(1e-6));
    CHECK(attitude_error <= 1e-12);
  }
}

TEST_CASE("commands are behind the rotors' lag too") {
  constexpr double lag_s = 0.05;
  Filtered filtered(400.0, lag_s);  // a low-pass that is fast beside the lag
  for (int i = 0; i < 1000; ++i) {
    Commands<double> commands{};
    if (i > 200) commands.fill(1);
    const bool settled =
        filtered.tick(1'000'000 + static_cast<std::uint64_t>(i) * tick_us, true, State<double>{}, commands);
    if (i <= 240) continue;
    REQUIRE(settled);
    const double late_s = std::sqrt(2.0) / 400;
    CHECK(std::abs(filtered.flown()[0] - (1 - std::exp(-((i - 200) * tick_s - late_s) / lag_s))) <= 0.01);
  }
}

TEST_CASE("after a gap, a jump back, other commands or what is no number it settles anew; q and -q are one") {
  enum class Fault { gap, backwards, unknown, state, commands };
  for (const Fault fault : {Fault::gap, Fault::backwards, Fault::unknown, Fault::state, Fault::commands}) {
    CAPTURE(static_cast<int>(fault));
    Filtered filtered;
    std::uint64_t now_us = 1'000'000;
    int settled_after = 0;
    for (int i = 0; i < 1000; ++i) {
      now_us += tick_us;
      const bool here = i == 500;
      if (here && fault == Fault::gap) now_us += 50'000;
      if (here && fault == Fault::backwards) now_us -= 50'000;
      State<double> state;
      state.velocity_m_s[0] = i < 500 ? 0 : 3;  // a jump that it must not see as an acceleration
      if (i % 2 == 1) state.attitude = {-1, 0, 0, 0};
      if (here && fault == Fault::state) state.body_rates_rad_s[1] = no_number;
      Commands<double> commands{};
      if (here && fault == Fault::commands) commands[3] = no_number;
      if (here && fault == Fault::unknown) commands.fill(0.9);
      const bool settled = filtered.tick(now_us, !(here && fault == Fault::unknown), state, commands);
      if (i >= 500 && i < 655) CHECK_FALSE(settled);
      if (!settled) continue;
      settled_after += i > 500 ? 1 : 0;
      CHECK(filtered.motion().linear_acceleration_m_s2.norm() <= 1e-9);
      CHECK(std::abs(std::abs(filtered.motion().attitude.w) - 1) <= 1e-9);
    }
    CHECK(settled_after >= 330);
  }
}
