// SPDX-License-Identifier: MIT
// A ground effect chosen in flight: to the bit the compile-time vehicle's, and by its formula's amount.
#include "pinnquad/simulation/switchable_quadrotor.hpp"

#include <doctest/doctest.h>

#include <random>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/simulation/random_pilot.hpp"
#include "pinnquad/simulation/simulator.hpp"

namespace {

using namespace pinnquad;

using Switchable = SwitchableQuadrotor<StandardAtmosphere, PeriodicWind, QuadraticDrag>;
template <class... GroundEffect>
using Fixed = Quadrotor<double, StandardAtmosphere, PeriodicWind, QuadraticDrag, GroundEffect...>;
using Pilot = RandomPilot<std::mt19937_64>;

const Airframe<double> airframe = airframe_value<PaperQuadrotor, double>();
const Site<double> site = paper_site<double>();
constexpr PeriodicWind breeze{{0.0, 1.0, 0.0}, 1.0, 0.5, 7.0};
constexpr double start_height_m = 0.6;  // Z/R = 5.2: within both formulas' reach

Switchable switchable() { return Switchable(airframe, site, {}, breeze, {}); }
template <class... GroundEffect>
Fixed<GroundEffect...> fixed(GroundEffect... ground_effect) {
  return Fixed<GroundEffect...>(airframe, site, {}, breeze, {}, ground_effect...);
}

/// Low and gentle: the vehicle stays within two metres of the ground, where ground effects differ.
Pilot pilot() {
  PilotStyle style;
  style.max_speed_m_s = style.max_climb_m_s = style.max_descent_m_s = 0.3;
  style.lowest_m = 0.3;
  style.highest_m = 1.5;
  style.braking_m = 0.2;
  style.thumbs.roll_pitch_deviation_rad_s = 0.05;
  return Pilot(std::mt19937_64(4), style, site.ground_z_m);
}

FlightPlan low_start() {
  FlightPlan settings;
  settings.start_m = Vector3<double>(0, 0, site.ground_z_m - start_height_m);
  return settings;
}

/// A simulator's steps from a state on, written anew from its parts; rows at multiples of 0.05 s.
template <class Vehicle>
Flight flown_on(const Vehicle& quadrotor, Pilot pilot, VehicleState<double> vehicle, std::size_t first_row,
                std::size_t rows) {
  const FlightPlan settings = low_start();
  State<double> hover;
  hover.position_m = settings.start_m;
  const double density_ratio = quadrotor.rotor_scale(quadrotor.surroundings(hover, 0.0));
  const FlightController<double> controller(
      settings.gains, flight_limits(quadrotor.airframe(), density_ratio, settings.gains), site.gravity_m_s2);
  Flight flight;
  for (std::size_t row = first_row; row < first_row + rows; ++row) {
    Commands<double> commands{};
    for (int tick = 0; tick < 25; ++tick) {
      Accelerations<double> demand;
      REQUIRE(controller(vehicle.body, pilot(vehicle.body, vehicle.time_s), demand) == Status::ok);
      REQUIRE(inverse_commands(quadrotor, vehicle.body, demand, vehicle.time_s, commands) == Status::ok);
      commands = desaturate(quadrotor.rotors(), commands);
      REQUIRE(quadrotor.step(vehicle, commands, 0.001) == Status::ok);
      REQUIRE(quadrotor.step(vehicle, commands, 0.001) == Status::ok);
    }
    vehicle.time_s = static_cast<double>(row + 1) * settings.sample_period_s();
    flight.push_back(ExactRecorder{}(quadrotor, vehicle, commands));
  }
  return flight;
}

template <class Vehicle>
void check_switch(GroundEffectModel model, const Vehicle& compile_time) {
  Simulator<Switchable, Pilot> simulator(switchable(), pilot(), low_start());
  REQUIRE(simulator.advance(2));
  const VehicleState<double> at_switch = simulator.vehicle();
  const Pilot at_the_sticks = simulator.pilot();
  REQUIRE(simulator.take_recording().size() == 40);
  simulator.set_ground_effect(model);
  CHECK(simulator.quadrotor().ground_effect() == model);
  CHECK(simulator.time_s() == at_switch.time_s);
  REQUIRE(simulator.advance(2));
  CHECK(content_hash(simulator.recording()) == content_hash(flown_on(compile_time, at_the_sticks, at_switch, 40, 40)));
}

}  // namespace

TEST_CASE("fly 2 s, switch, fly on: the bits of the compile-time vehicle from that state on") {
  check_switch(GroundEffectModel::none, fixed<>());
  check_switch(GroundEffectModel::cheeseman_bennett, fixed(CheesemanBennettGroundEffect{}));
  check_switch(GroundEffectModel::conyers, fixed(ConyersGroundEffect{}));
}

TEST_CASE("a choice that stays is a flight of the compile-time vehicle") {
  const auto hash = [](const auto& quadrotor) {
    FlightPlan plan;
    static_cast<FlightPlan&>(plan) = low_start();
    plan.samples = 60;
    return content_hash(fly(quadrotor, pilot(), plan).flight);
  };
  Switchable quadrotor = switchable();
  const std::uint64_t none = hash(quadrotor);
  CHECK(none == hash(fixed<>()));
  quadrotor.set_ground_effect(GroundEffectModel::cheeseman_bennett);
  const std::uint64_t cheeseman_bennett = hash(quadrotor);
  CHECK(cheeseman_bennett == hash(fixed(CheesemanBennettGroundEffect{})));
  quadrotor.set_ground_effect(GroundEffectModel::conyers);
  CHECK(hash(quadrotor) == hash(fixed(ConyersGroundEffect{})));
  CHECK(hash(quadrotor) != none);
  CHECK(hash(quadrotor) != cheeseman_bennett);
  CHECK(cheeseman_bennett != none);
  quadrotor.set_ground_effect(GroundEffectModel::none);
  CHECK(hash(quadrotor) == none);
}

TEST_CASE("hover near the ground needs 1 / r of the command") {
  using Calm = SwitchableQuadrotor<StandardAtmosphere, QuadraticDrag>;
  constexpr double agreement = 2e-6;  // of the inverse's rounds
  for (const double height_m : {0.2, 0.4, 0.9}) {
    CAPTURE(height_m);
    FlightPlan settings;
    settings.start_m = Vector3<double>(0, 0, site.ground_z_m - height_m);
    Simulator<Calm, SteadyPilot> simulator(Calm(airframe, site), SteadyPilot{}, settings);
    const double x = height_m / (airframe.propeller_diameter_m / 2);
    Commands<double> none{}, cheeseman_bennett{}, conyers{};
    REQUIRE(simulator.hover_commands(none) == Status::ok);
    simulator.set_ground_effect(GroundEffectModel::cheeseman_bennett);
    REQUIRE(simulator.hover_commands(cheeseman_bennett) == Status::ok);
    simulator.set_ground_effect(GroundEffectModel::conyers);
    REQUIRE(simulator.hover_commands(conyers) == Status::ok);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(none[i] / cheeseman_bennett[i] ==
            doctest::Approx(CheesemanBennett{}.thrust_ratio(x, airframe)).epsilon(agreement));
      CHECK(none[i] / conyers[i] == doctest::Approx(Conyers{}.thrust_ratio(x, airframe)).epsilon(agreement));
    }
  }
}
