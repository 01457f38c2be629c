// SPDX-License-Identifier: MIT
// The random pilot as a policy: bounded, smooth, turned back at the borders, repeatable.
#include "pinnquad/simulation/random_pilot.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using namespace pinnquad;
using Pilot = RandomPilot<std::mt19937_64>;

constexpr double tick_s = 0.002;

}  // namespace

static_assert(is_pilot<Pilot> && is_pilot<SteadyPilot> && !is_pilot<int>);

TEST_CASE("set points are bounded and smooth") {
  const PilotStyle style;
  Pilot pilot(std::mt19937_64(1), style);
  State<double> state;
  state.position_m[2] = -35;
  SetPoint<double> before;
  double fastest_m_s = 0;
  for (int i = 0; i < 100000; ++i) {
    const SetPoint<double> now = pilot(state, i * tick_s);
    CHECK(now.velocity_m_s.norm() <= style.max_speed_m_s);
    CHECK(std::abs(now.yaw_rate_rad_s) <= style.max_yaw_rate_rad_s);
    // a first-order lag: no faster than twice the limit per lag
    CHECK((now.velocity_m_s - before.velocity_m_s).norm() <= 2 * style.max_speed_m_s * tick_s / style.velocity_lag_s);
    fastest_m_s = std::max(fastest_m_s, now.velocity_m_s.norm());
    before = now;
  }
  CHECK(fastest_m_s > 0.9 * style.max_speed_m_s);
}

TEST_CASE("sticks: the standard deviation of each axis and the memory") {
  Pilot pilot(std::mt19937_64(2));
  constexpr double spreads_rad_s[3] = {0.21, 0.21, 0.062};  // the yaw of four rotors has little torque
  const double memory = std::exp(-0.004 * 14);              // from frame to frame, at a bandwidth of 14 rad/s
  Vector3<double> square = Vector3<double>::Zero(), product = square, before = square;
  int frames = 0;
  bool held = true;
  for (int i = 0; i < 400000; ++i) {
    const Vector3<double> stick = pilot(State<double>{}, i * tick_s).stick_rad_s;
    if (i % 2 != 0) {  // a frame every 4 ms
      held = held && stick == before;
      continue;
    }
    square += stick.cwiseProduct(stick);
    product += stick.cwiseProduct(before);
    before = stick;
    ++frames;
  }
  CHECK(held);
  constexpr double sampling_error = 0.05;  // 800 s hold some 5,000 independent values
  for (int axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    CHECK(std::abs(std::sqrt(square[axis] / frames) / spreads_rad_s[axis] - 1) <= sampling_error);
    CHECK(std::abs((1 - product[axis] / square[axis]) / (1 - memory) - 1) <= sampling_error);
  }
}

TEST_CASE("outside the box every target leads back") {
  const PilotStyle style;
  struct Place {
    Vector3<double> position_m;
    int axis;
    double back;
  };
  const Place places[] = {{Vector3<double>(0, 0, -style.lowest_m), 2, -1},
                          {Vector3<double>(0, 0, -style.highest_m), 2, 1},
                          {Vector3<double>(style.farthest_m, 0, -35), 0, -1},
                          {Vector3<double>(0, -style.farthest_m, -35), 1, 1}};
  for (const Place& place : places) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      Pilot pilot(std::mt19937_64(seed), style);
      State<double> state;
      state.position_m = place.position_m;
      SetPoint<double> wanted;
      for (int i = 0; i < 300; ++i) wanted = pilot(state, i * tick_s);
      CHECK(wanted.velocity_m_s[place.axis] * place.back >= 0);
    }
  }
}

TEST_CASE("past the easing speed less velocity is asked for, at the greatest speed none") {
  const PilotStyle style;
  const double easing_m_s = style.easing_share * style.max_speed_m_s;
  const auto asked_at = [&](double speed_m_s) {
    Pilot pilot(std::mt19937_64(1), style);
    State<double> state;
    state.position_m[2] = -35;
    constexpr int ticks = 390;  // 0.78 s: within the first hold
    for (int i = 0; i < ticks; ++i) pilot(state, i * tick_s);
    state.velocity_m_s[0] = speed_m_s;
    return pilot(state, ticks * tick_s);
  };
  const SetPoint<double> full = asked_at(easing_m_s);
  REQUIRE(full.velocity_m_s.norm() > 1);
  CHECK((asked_at(3).velocity_m_s - full.velocity_m_s).norm() == 0);
  CHECK((asked_at((easing_m_s + style.max_speed_m_s) / 2).velocity_m_s - full.velocity_m_s / 2).norm() < 1e-9);
  CHECK(asked_at(style.max_speed_m_s).velocity_m_s.norm() == doctest::Approx(0));
  CHECK(asked_at(20).velocity_m_s.norm() == 0);
  CHECK((asked_at(20).stick_rad_s - full.stick_rad_s).norm() == 0);
  CHECK(asked_at(20).yaw_rate_rad_s == full.yaw_rate_rad_s);
}
