// SPDX-License-Identifier: MIT
#include "study/mppi.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "support/tolerances.hpp"

namespace {

using namespace pinnquad;
using namespace study;
using Vehicle = Quadrotor<float, StandardAtmosphere, QuadraticDrag>;
using Small = Mppi<Vehicle, 64, 20>;  // an unoptimised build flies a tenth of the flights of 512 x 40

const Airframe<float> airframe = PaperQuadrotor::value<float>();

MppiSettings with_seed(std::uint32_t seed) {
  MppiSettings settings;
  settings.seed = seed;
  return settings;
}

VehicleState<float> start_of(const FigureEight<float>& eight) {
  VehicleState<float> state;
  state.body.position_m = eight.sample(0).position_m;
  state.rotors = {0.5f, 0.5f, 0.5f, 0.5f};
  return state;
}

/// Flies the figure-eight from a state; the worst distance from it over the last half, or infinity for a Status that is
/// not ok.
template <class Controller>
float flown(Controller& controller, VehicleState<float>& state, float seconds) {
  const FigureEight<float> eight;
  const auto sample = [&eight](double time_s) { return eight.sample(static_cast<float>(time_s)); };
  const Vehicle world(airframe, paper_site<float>());
  const auto step = world.time_step(0.002f);
  float worst_m = 0;
  const int ticks = static_cast<int>(seconds / 0.002f);
  Commands<float> commands{};
  for (int tick = 0; tick < ticks; ++tick) {
    state.time_s = 0.002 * tick;
    if (controller(state, sample, commands) != Status::ok) return std::numeric_limits<float>::infinity();
    if (tick > ticks / 2)
      worst_m = std::fmax(worst_m, (sample(state.time_s).position_m - state.body.position_m).norm());
    if (world.step(state, commands, step) != Status::ok) return std::numeric_limits<float>::infinity();
  }
  return worst_m;
}

}  // namespace

TEST_CASE("MPPI flies the figure-eight, also from a metre beside it") {
  Small controller(airframe, paper_site<float>());
  REQUIRE(controller.status() == Status::ok);
  VehicleState<float> state = start_of({});
  CHECK(flown(controller, state, 6) <= 0.1f);

  Small brought_back(airframe, paper_site<float>());
  VehicleState<float> beside = start_of({});
  beside.body.position_m += Vector3<float>(0.6f, -0.6f, 0.5f);
  CHECK(flown(brought_back, beside, 6) <= 0.2f);

  // without anything tried the plan is the trajectory's own, which knows neither drag nor where the vehicle is
  MppiSettings timid;
  timid.thrust_deviation_m_s2 = timid.rate_deviation_rad_s = 1e-6f;
  Small blind(airframe, paper_site<float>(), timid);
  VehicleState<float> astray = start_of({});
  astray.body.position_m += Vector3<float>(0.6f, -0.6f, 0.5f);
  CHECK(flown(blind, astray, 6) > 0.5f);
}

TEST_CASE("MPPI flies to a place far away and stays there; without a limit it rushes past") {
  const auto place = [](double) {
    TrajectoryPoint<float> point;
    point.position_m = {30, 0, -35};
    return point;
  };
  const Vehicle world(airframe, paper_site<float>());
  const auto step = world.time_step(0.004f);
  for (const float most_off_m : {2.0f, 1e6f}) {
    MppiSettings settings;
    settings.most_off_m = most_off_m;
    Small controller(airframe, paper_site<float>(), settings);
    VehicleState<float> state = start_of({});
    state.body.position_m = {0, 0, -35};
    Commands<float> commands{};
    float fastest_m_s = 0;
    bool flies = true;
    for (int tick = 0; tick < 4500 && flies; ++tick) {
      state.time_s = 0.004 * tick;
      flies = controller(state, place, commands) == Status::ok && world.step(state, commands, step) == Status::ok;
      fastest_m_s = std::fmax(fastest_m_s, state.body.velocity_m_s.norm());
    }
    const float off_m = (place(0).position_m - state.body.position_m).norm();
    CAPTURE(off_m);
    CAPTURE(fastest_m_s);
    if (most_off_m < 50) {
      CHECK((flies && off_m < 0.1f && fastest_m_s < 4));
    } else {
      CHECK((!flies || off_m > 5 || fastest_m_s > 12));
    }
  }
}

TEST_CASE("the same seed gives the same flight, another seed another one") {
  VehicleState<float> end[3];
  for (std::uint32_t i = 0; i < 3; ++i) {
    Small controller(airframe, paper_site<float>(), with_seed(i < 2 ? 1 : 2));
    end[i] = start_of({});
    flown(controller, end[i], 0.5f);
  }
  CHECK(end[0].body.position_m == end[1].body.position_m);
  CHECK(end[0].rotors == end[1].rotors);
  CHECK(end[0].rotors != end[2].rotors);
}
