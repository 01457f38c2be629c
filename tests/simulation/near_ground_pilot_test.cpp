// SPDX-License-Identifier: MIT
// The near-ground pilot as a policy: bounded, smooth in height, turned back at the borders, repeatable, all phases
// flown.
#include "pinnquad/simulation/near_ground_pilot.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace {

using Phase = pinnquad::NearGroundPilot<std::mt19937_64>::Phase;
using namespace pinnquad;
using Pilot = NearGroundPilot<std::mt19937_64>;

constexpr double tick_s = 0.002;
constexpr double ground_z_m = 0.877;

/// A vehicle that flies exactly what it is asked for.
struct IdealVehicle {
  State<double> state;

  IdealVehicle() { state.position_m[2] = ground_z_m - 0.2; }
  double height_m() const { return ground_z_m - state.position_m[2]; }
  void fly(const SetPoint<double>& asked) {
    state.velocity_m_s = asked.velocity_m_s;
    state.position_m += asked.velocity_m_s * tick_s;
  }
};

}  // namespace

static_assert(is_pilot<Pilot>);

TEST_CASE("an ideal vehicle keeps within the heights of the style, through all phases") {
  NearGroundStyle style;
  style.lead_s = 0;  // an ideal vehicle needs none
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    Pilot pilot(std::mt19937_64(seed), style, ground_z_m);
    IdealVehicle vehicle;
    std::array<int, 5> ticks{};
    double lowest_m = 9, highest_m = 0, farthest_m = 0;
    for (int i = 0; i < 150000; ++i) {
      const SetPoint<double> asked = pilot(vehicle.state, i * tick_s);
      vehicle.fly(asked);
      ++ticks[static_cast<std::size_t>(pilot.phase())];
      lowest_m = std::min(lowest_m, vehicle.height_m());
      highest_m = std::max(highest_m, vehicle.height_m());
      farthest_m = std::max({farthest_m, std::abs(vehicle.state.position_m[0]), std::abs(vehicle.state.position_m[1])});
      CHECK(std::hypot(asked.velocity_m_s[0], asked.velocity_m_s[1]) <= style.max_speed_m_s);
      CHECK(-asked.velocity_m_s[2] < 1.02 * style.max_climb_m_s);
      CHECK(asked.velocity_m_s[2] < 1.02 * style.max_descent_m_s);
      CHECK(std::abs(asked.yaw_rate_rad_s) <= style.max_yaw_rate_rad_s);
    }
    constexpr double tracking_m = 0.005;  // the proportional term, and ticks
    CHECK(lowest_m > style.lowest_m - tracking_m);
    CHECK(highest_m < style.highest_m + tracking_m);
    CHECK(highest_m > 1.4);
    CHECK(lowest_m < style.lowest_stay_m);
    CHECK(farthest_m < style.farthest_m);
    for (const int count : ticks)
      CHECK(count > 7500);  // 5 % of the time each: stay, take-off, hover, traverse, landing
  }
}

TEST_CASE("phases follow each other as sorties do") {
  NearGroundStyle style;
  style.lead_s = 0;
  Pilot pilot(std::mt19937_64(3), style, ground_z_m);
  IdealVehicle vehicle;
  Phase before = Phase::stay;
  int sorties = 0, legs = 0;
  for (int i = 0; i < 150000; ++i) {
    vehicle.fly(pilot(vehicle.state, i * tick_s));
    const Phase now = pilot.phase();
    if (now == before) continue;
    switch (now) {
      case Phase::take_off:
        CHECK(before == Phase::stay);
        CHECK(vehicle.height_m() < style.lowest_stay_m + 0.01);
        ++sorties;
        break;
      case Phase::hover:
      case Phase::traverse:
        CHECK((before == Phase::take_off || before == Phase::hover || before == Phase::traverse));
        ++legs;
        break;
      case Phase::landing: CHECK((before == Phase::hover || before == Phase::traverse)); break;
      case Phase::stay: CHECK(before == Phase::landing); break;
    }
    before = now;
  }
  CHECK(sorties > 10);
  CHECK(legs >= sorties);
}

TEST_CASE("the profile alone, without correction, leads from height to height") {
  NearGroundStyle style;
  style.height_gain_1_s = 0;
  for (const double lead_s : {0.0, 0.33}) {
    CAPTURE(lead_s);
    style.lead_s = lead_s;  // its share of a phase is zero: the profile ends with the slope it began with
    Pilot pilot(std::mt19937_64(6), style, ground_z_m);
    IdealVehicle vehicle;
    Phase before = Phase::stay;
    double highest_m = 0;
    for (int i = 0; i < 100000; ++i) {
      vehicle.fly(pilot(vehicle.state, i * tick_s));
      if (pilot.phase() == Phase::stay && before == Phase::landing) {
        constexpr double sums_m = 0.02;  // of all phases so far: ticks instead of an integral
        CHECK(vehicle.height_m() > style.lowest_m - sums_m);
        CHECK(vehicle.height_m() < style.lowest_stay_m + sums_m);
      }
      before = pilot.phase();
      highest_m = std::max(highest_m, vehicle.height_m());
    }
    CHECK(highest_m > 1.5);
  }
}

TEST_CASE("low heights are asked for more often than high ones") {
  Pilot pilot(std::mt19937_64(4), {}, ground_z_m);
  IdealVehicle vehicle;
  int low = 0;
  constexpr int ticks = 300000;
  const double middle_m = (NearGroundStyle{}.lowest_m + NearGroundStyle{}.highest_m) / 2;
  for (int i = 0; i < ticks; ++i) {
    vehicle.fly(pilot(vehicle.state, i * tick_s));
    low += vehicle.height_m() < middle_m ? 1 : 0;
  }
  CHECK(low > 6 * ticks / 10);
}

TEST_CASE("far inside the box no leg is turned back: neither its size nor the room to brake has a say") {
  NearGroundStyle style, other;
  style.farthest_m = 1e5;
  other.farthest_m = 2e5;
  other.braking_m = 10 * style.braking_m;
  Pilot pilot(std::mt19937_64(8), style, ground_z_m), same(std::mt19937_64(8), other, ground_z_m);
  IdealVehicle vehicle, follower;
  for (int i = 0; i < 100000; ++i) {
    vehicle.fly(pilot(vehicle.state, i * tick_s));
    follower.fly(same(follower.state, i * tick_s));
    REQUIRE(vehicle.state.position_m == follower.state.position_m);
  }
}

TEST_CASE("a seed's first take-off and first leg are the same whatever the number of legs") {
  NearGroundStyle one, five;
  one.max_legs = 1;
  five.max_legs = 5;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    Pilot short_sorties(std::mt19937_64(seed), one), long_sorties(std::mt19937_64(seed), five);
    IdealVehicle vehicle;
    bool has_flown_a_leg = false;
    for (int i = 0; i < 10000; ++i) {
      const SetPoint<double> asked = short_sorties(vehicle.state, i * tick_s);
      const SetPoint<double> other = long_sorties(vehicle.state, i * tick_s);
      has_flown_a_leg =
          has_flown_a_leg || short_sorties.phase() == Phase::hover || short_sorties.phase() == Phase::traverse;
      if (short_sorties.phase() == Phase::landing) break;
      REQUIRE(asked.velocity_m_s == other.velocity_m_s);
      REQUIRE(asked.yaw_rate_rad_s == other.yaw_rate_rad_s);
      vehicle.fly(asked);
    }
    CHECK(has_flown_a_leg);
    CHECK(short_sorties.phase() == Phase::landing);
  }
}

TEST_CASE("styles at their ends: no lag, stays of no time, no legs; what is asked for stays a number") {
  NearGroundStyle style;
  style.velocity_lag_s = style.yaw_rate_lag_s = 0;
  style.min_hold_s = style.max_hold_s = 0;
  for (const int legs : {0, -3, 1}) {
    CAPTURE(legs);
    style.max_legs = legs;
    Pilot pilot(std::mt19937_64(8), style, ground_z_m);
    IdealVehicle vehicle;
    std::array<int, 5> ticks{};
    bool finite = true;
    for (int i = 0; i < 20000; ++i) {
      const SetPoint<double> asked = pilot(vehicle.state, i * tick_s);
      finite = finite && all_finite(asked.velocity_m_s) && is_finite(asked.yaw_rate_rad_s);
      vehicle.fly(asked);
      ++ticks[static_cast<std::size_t>(pilot.phase())];
    }
    CHECK(finite);
    CHECK(ticks[static_cast<std::size_t>(Phase::landing)] > 0);
  }
}
