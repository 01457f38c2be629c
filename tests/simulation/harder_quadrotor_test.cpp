// SPDX-License-Identifier: MIT
#include "pinnquad/simulation/harder_quadrotor.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

#include "pinnquad/simulation/flights.hpp"
#include "pinnquad/vehicle/inverse.hpp"
#include "support/tolerances.hpp"

using pinnquad::Commands;
using pinnquad::FlightEnd;
using pinnquad::FlightPlan;
using pinnquad::HarderConditions;
using pinnquad::HarderQuadrotor;
using pinnquad::State;
using pinnquad::Status;
using pinnquad::Vector3;

namespace {

using Engine = std::mt19937_64;

/// A weak rotor, a payload and an old battery at once, all from the start.
HarderConditions worst() {
  HarderConditions conditions;
  conditions.fault = {1, 0.85, 0};
  conditions.payload = {0.15, 0};
  conditions.battery.start_charge = 0.5;
  return conditions;
}

HarderQuadrotor vehicle(const HarderConditions& conditions = {}, std::uint64_t seed = 1) {
  Engine engine(seed);
  return pinnquad::harder_vehicle(engine, conditions);
}

}  // namespace

TEST_CASE("hover has a trim: near the rigid body's in calm air, more with a weak rotor, a payload, an old battery") {
  HarderConditions calm;
  calm.wind_m_s = 0;
  pinnquad::Commands<double> trim{}, hard{}, rigid{};
  const Vector3<double> place = FlightPlan{}.start_m;
  REQUIRE(hover_trim(vehicle(calm), place, trim) == Status::ok);
  using Rigid = pinnquad::Quadrotor<double, pinnquad::StandardAtmosphere>;
  REQUIRE(
      hover_trim(Rigid(pinnquad::airframe_value<pinnquad::LightQuadrotor, double>(), pinnquad::paper_site<double>()),
                 place, rigid) == Status::ok);
  CHECK(pinnquad::test::distance(trim, rigid) <= 1e-3);
  HarderConditions still = worst();
  still.wind_m_s = 0;
  REQUIRE(hover_trim(vehicle(still), place, hard) == Status::ok);
  const double load = 1.15 / std::pow(pinnquad::Battery::cell_at_rest_V(0.5) / pinnquad::Battery::full_cell_V, 2);
  CHECK(hard[0] / rigid[0] == doctest::Approx(load).epsilon(0.01));
  CHECK(hard[1] / rigid[1] == doctest::Approx(load / 0.85).epsilon(0.01));
  pinnquad::VehicleState<double> late;  // all but a tenth of its charge is used
  late.body.position_m = place;
  late.charge_used_C = 0.4 * 3600 * still.battery.capacity_Ah;
  Commands<double> more{};
  REQUIRE(inverse_commands(vehicle(still), late, {}, more) == Status::ok);
  const double lower = pinnquad::Battery::cell_at_rest_V(0.1) / pinnquad::Battery::cell_at_rest_V(0.5);
  CHECK(more[0] / hard[0] == doctest::Approx(1 / (lower * lower)).epsilon(1e-6));
}

TEST_CASE("its airframe: a kilogram, rotors that lag 20 ms, three times the thrust that it needs") {
  const pinnquad::Airframe<double> airframe = pinnquad::airframe_value<pinnquad::LightQuadrotor, double>();
  CHECK(check_airframe(airframe) == Status::ok);
  CHECK(airframe.mass_kg == 1.0);
  CHECK(airframe.rise_time_constant_s(0) == 0.020);
  CHECK(airframe.fall_time_constant_s(3) == 0.020);
  CHECK(airframe.thrust_to_weight() == doctest::Approx(3.0).epsilon(0.02));
}

TEST_CASE("a minute of the random pilot: every row is finite, seed by seed") {
  FlightPlan plan;
  plan.samples = 1200;
  for (const HarderConditions& conditions : {HarderConditions{}, worst()}) {
    const HarderQuadrotor quadrotor = vehicle(conditions, 3);
    const auto pilot = pinnquad::AgileFlight::pilot(quadrotor, Engine(4));
    const pinnquad::RecordedFlight flown = fly(quadrotor, pilot, plan);
    CHECK(flown.report.end == FlightEnd::completed);
    CHECK(flown.report.rows == plan.samples);
    CHECK(flown.report.max_speed_m_s > 6);
    const pinnquad::RecordedFlight again = fly(vehicle(conditions, 3), pilot, plan);
    CHECK(again.report.last.body.position_m == flown.report.last.body.position_m);
  }
}

TEST_CASE("the effects show: the commands of its flight are not those of a rigid body with drag") {
  using Plain = pinnquad::Quadrotor<double, pinnquad::StandardAtmosphere, pinnquad::QuadraticDrag>;
  const Plain plain(pinnquad::airframe_value<pinnquad::LightQuadrotor, double>(), pinnquad::paper_site<double>());
  FlightPlan plan;
  plan.samples = 400;
  const HarderQuadrotor quadrotor = vehicle();
  const auto pilot = pinnquad::AgileFlight::pilot(quadrotor, Engine(5));
  double squares = 0;
  int rows = 0;
  fly(quadrotor, pilot, plan, [&](const auto& simulator) {
    const auto& state = simulator.vehicle();
    const auto motion = quadrotor.evaluate(state).motion;
    Commands<double> u{};
    REQUIRE(inverse_commands(plain, state.body, motion, state.time_s, u) == Status::ok);
    const double distance = pinnquad::test::distance(u, state.rotors);
    squares += distance * distance / 4;
    ++rows;
  });
  CHECK(std::sqrt(squares / rows) > 0.02);  // per command
}

TEST_CASE("idle rotors land it: it stands within a millimetre of its static depth, and the flight goes on") {
  FlightPlan plan;
  plan.start_m = Vector3<double>(0, 0, 0.877 - 0.3);
  pinnquad::Simulator<HarderQuadrotor, pinnquad::SteadyPilot> simulator(vehicle(), {}, plan);
  for (int i = 0; i < 1500; ++i) simulator.tick({0, 0, 0, 0});
  CHECK(simulator.end() == FlightEnd::completed);
  CHECK(std::fabs(simulator.altitude_m() - (0.18 - 0.002)) <= 1e-3);
  CHECK(simulator.vehicle().body.velocity_m_s.norm() <= 2e-3);  // it creeps in the wind
  for (int i = 0; i < 1000; ++i) simulator.tick();              // the pilot hovers: off the ground with it
  CHECK(simulator.end() == FlightEnd::completed);
  using NoLegs = pinnquad::Quadrotor<double, pinnquad::StandardAtmosphere, pinnquad::QuadraticDrag>;
  pinnquad::Simulator<NoLegs, pinnquad::SteadyPilot> falls(
      NoLegs(pinnquad::airframe_value<pinnquad::LightQuadrotor, double>(), pinnquad::paper_site<double>()), {}, plan);
  for (int i = 0; i < 1500; ++i) falls.tick({0, 0, 0, 0});
  CHECK(falls.end() == FlightEnd::ground);
}

TEST_CASE("a payload presses the legs deeper: it weighs on them too") {
  HarderConditions conditions;
  conditions.wind_m_s = 0;
  conditions.payload = {0.25, 0};
  FlightPlan plan;
  plan.start_m = Vector3<double>(0, 0, 0.877 - 0.25);
  pinnquad::Simulator<HarderQuadrotor, pinnquad::SteadyPilot> simulator(vehicle(conditions), {}, plan);
  for (int i = 0; i < 1500; ++i) simulator.tick({0, 0, 0, 0});
  CHECK(std::fabs(simulator.altitude_m() - (0.18 - 1.25 * 0.002)) <= 1e-4);
}

TEST_CASE("the near-ground pilot's landings reach the ground, and the flight goes on") {
  FlightPlan plan = pinnquad::NearGroundFlight::plan();
  plan.samples = 1200;
  const HarderQuadrotor quadrotor = vehicle();
  const auto& legs = std::get<pinnquad::GroundContact>(quadrotor.effects());
  pinnquad::NearGroundStyle style = pinnquad::near_ground_style(quadrotor, plan.start_m);
  style.lowest_stay_m = 0.17;  // every landing is asked to end on the legs
  const pinnquad::NearGroundPilot<Engine> pilot(Engine(6), style, quadrotor.site().ground_z_m);
  int touching = 0, clear = 0;
  const auto flown = fly(quadrotor, pilot, plan, [&](const auto& simulator) {
    pinnquad::AeroCondition<double> c;
    c.attitude = simulator.vehicle().body.attitude;
    c.height_above_ground_m = simulator.altitude_m();
    (legs.wrench(c, quadrotor.airframe()).force_N[2] < 0 ? touching : clear) += 1;
  });
  CHECK(flown.report.end == FlightEnd::completed);
  CHECK(flown.report.rows == plan.samples);
  CHECK(touching >= 3);
  CHECK(clear > 600);
  CHECK(flown.report.min_altitude_m > 0.15);
}
