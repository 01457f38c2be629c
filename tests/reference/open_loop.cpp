// SPDX-License-Identifier: MIT
// Runs with given commands, the rows that are 1 ms apart: the rotor lag, and one step of the simulator's own integrator
// taken with the library's dynamics.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "pinnquad/dynamics/actuator.hpp"
#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"
#include "reference/reference_rows.hpp"
#include "support/compare_with_plain.hpp"

using pinnquad::Commands;
using pinnquad::Vector3;
using pinnquad::test::ReferenceTable;
using pinnquad::test::Statistics;

namespace {

/// The files have 13 digits; float32 constants and thrusts in the simulator leave seven.
constexpr double lag_tolerance = 9.5e-13, torque_tolerance = 4.8e-8, acceleration_tolerance = 3.3e-8,
                 angular_tolerance = 5.6e-8;

Commands<double> commands(const ReferenceTable& table, std::size_t row, const std::string& prefix) {
  return {table.at(row, prefix + "1"), table.at(row, prefix + "2"), table.at(row, prefix + "3"),
          table.at(row, prefix + "4")};
}

Vector3<double> vector(const ReferenceTable& table, std::size_t row, const std::string& prefix) {
  const auto v = table.vector(row, prefix);
  return {v[0], v[1], v[2]};
}

bool one_step(const ReferenceTable& table, std::size_t row) {
  return std::fabs(table.at(row + 1, "t") - table.at(row, "t") - 0.001) < 1e-9;
}

const char* const runs[] = {
    "agile",       "agile_wind",       "coast8_fwd",    "coast8_side", "coast_tilted", "drop_terminal", "ge1_descend",
    "ge2_descend", "ge2_tilted",       "hover",         "motor_step",  "pitch_step",   "roll_step",     "tumble",
    "wind_const",  "wind_const_yaw90", "wind_periodic", "yaw_step"};

pinnquad::VehicleState<double> start(const ReferenceTable& table) {
  pinnquad::VehicleState<double> state;
  state.body.position_m = vector(table, 0, "p");
  state.body.velocity_m_s = vector(table, 0, "v");
  state.body.attitude = {table.at(0, "qw"), table.at(0, "qx"), table.at(0, "qy"), table.at(0, "qz")};
  state.body.body_rates_rad_s = vector(table, 0, "w");
  state.rotors = commands(table, 0, "uf");
  return state;
}

plain::GroundEffect ground_effect_of(const std::string& name) {
  if (name.rfind("ge1", 0) == 0) return plain::GroundEffect::cheeseman_bennett;
  if (name.rfind("ge2", 0) == 0) return plain::GroundEffect::conyers;
  return plain::GroundEffect::none;
}

}  // namespace

TEST_CASE("the rotor lag of every 1 ms row: uf(k+1) = a uf(k) + (1 - a) clip(u(k-1))") {
  Statistics lag;
  const double factor =
      pinnquad::lag_factor(pinnquad::ReferenceQuadrotor15::value<double>().rotor_time_constant_s, 0.001);
  int moving = 0;
  for (const char* name : runs) {
    CAPTURE(name);
    const ReferenceTable table(std::string("open_loop/") + name + ".csv");
    for (std::size_t row = 1; row + 1 < table.size(); ++row) {
      if (!one_step(table, row) || !one_step(table, row - 1)) continue;
      const Commands<double> next = pinnquad::lagged(commands(table, row, "uf"), commands(table, row - 1, "u"), factor);
      const double difference = pinnquad::test::distance(next, commands(table, row + 1, "uf"));
      moving += pinnquad::test::distance(commands(table, row, "uf"), commands(table, row + 1, "uf")) > 1e-4 ? 1 : 0;
      lag.add(difference);
      CHECK(difference <= lag_tolerance);
    }
  }
  lag.print("open_loop", "rotor lag");
  CHECK(lag.count() > 300);
  CHECK(moving > 50);
}

TEST_CASE("one step: forces at the row's pose and half-step velocity, thrust of the filtered command") {
  const auto airframe = pinnquad::ReferenceQuadrotor15::value<double>();
  const double h = 0.001;
  for (const std::string name : runs) {
    CAPTURE(name);
    Statistics torque, acceleration, angular;
    const ReferenceTable table("open_loop/" + name + ".csv");
    for (std::size_t row = 1; row + 1 < table.size(); ++row) {
      if (!one_step(table, row)) continue;
      // the simulator evaluates at velocities advanced by half a step with the last accelerations
      const Vector3<double> velocity = vector(table, row, "v") + vector(table, row, "a") * (h / 2);
      const Vector3<double> rates = vector(table, row, "w") + vector(table, row, "al") * (h / 2);
      const Commands<double> u = commands(table, row, "uf");
      const Vector3<double> wind = vector(table, row, "wind");
      const plain::Point p{ground_effect_of(name),
                           table.at(row, "pz"),
                           table.at(row, "qw"),
                           table.at(row, "qx"),
                           table.at(row, "qy"),
                           table.at(row, "qz"),
                           velocity[0],
                           velocity[1],
                           velocity[2],
                           rates[0],
                           rates[1],
                           rates[2],
                           u[0],
                           u[1],
                           u[2],
                           u[3],
                           wind[0],
                           wind[1],
                           wind[2]};
      const plain::Result value = pinnquad::test::evaluate(airframe, p);
      const auto array = [](const double(&v)[3]) { return std::array<double, 3>{v[0], v[1], v[2]}; };
      // near hover accelerations cancel: the scale is what cancels, gravity, and a rotor's torque over the inertia
      const double gravity = 9.80665, largest_torque = 0.1, spin = 1.0;
      const double t =
          pinnquad::test::relative_distance(array(value.rotor_torque), table.vector(row + 1, "tb"), largest_torque);
      const double a =
          pinnquad::test::relative_distance(array(value.acceleration), table.vector(row + 1, "a"), gravity);
      const double w = pinnquad::test::relative_distance(array(value.angular), table.vector(row + 1, "al"), spin);
      torque.add(t);
      acceleration.add(a);
      angular.add(w);
      CAPTURE(row);
      CHECK(t <= torque_tolerance);
      CHECK(a <= acceleration_tolerance);
      CHECK(w <= angular_tolerance);
    }
    // two files have no rows 1 ms apart: they are compared as whole runs below
    if (name == "drop_terminal" || name == "wind_periodic") continue;
    torque.print(name.c_str(), "rotor torque, one step");
    acceleration.print(name.c_str(), "acceleration, one step");
    angular.print(name.c_str(), "angular acc., one step");
    CHECK(acceleration.count() >= (name == "ge1_descend" ? 9 : 37));
  }
}

namespace {

/// Flies a run of constant commands from its first row to its last with RK4, and compares the velocity at every row.
template <class... Ground>
void fly_run(const char* name, double speed_tolerance) {
  const ReferenceTable table(std::string("open_loop/") + name + ".csv");
  const bool periodic = std::string(name) == "wind_periodic";
  const Vector3<double> wind = vector(table, 0, "wind");
  const pinnquad::Quadrotor<double, pinnquad::StandardAtmosphere, pinnquad::ConstantWind, pinnquad::PeriodicWind,
                            pinnquad::QuadraticDrag, Ground...>
      vehicle(pinnquad::ReferenceQuadrotor15::value<double>(), pinnquad::paper_site<double>(),
              pinnquad::StandardAtmosphere{},
              periodic ? pinnquad::ConstantWind{} : pinnquad::ConstantWind{{wind[0], wind[1], wind[2]}},
              periodic ? pinnquad::PeriodicWind{} : pinnquad::PeriodicWind{{1.0, 0.0, 0.0}, 0.0, 0.0, 10.0},
              pinnquad::QuadraticDrag{}, Ground{}...);
  pinnquad::VehicleState<double> state = start(table);
  Statistics velocity, rates;
  const Commands<double> u = commands(table, 0, "u");
  for (std::size_t row = 1; row < table.size(); ++row) {
    CAPTURE(name);
    CAPTURE(row);
    REQUIRE(commands(table, row, "u") == u);
    const int steps = static_cast<int>(std::lround((table.at(row, "t") - table.at(row - 1, "t")) / 0.001));
    for (int i = 0; i < steps; ++i) REQUIRE(vehicle.step(state, u, 0.001) == pinnquad::Status::ok);
    velocity.add(pinnquad::test::distance(state.body.velocity_m_s, vector(table, row, "v")));
    rates.add(pinnquad::test::distance(state.body.body_rates_rad_s, vector(table, row, "w")));
  }
  velocity.print(name, "velocity, m/s, whole run");
  rates.print(name, "rates, rad/s, whole run");
  CHECK(velocity.worst() <= speed_tolerance);
}

}  // namespace

TEST_CASE("whole runs under constant commands: RK4 against the simulator's first-order integrator") {
  // h/2 times the acceleration that a step begins with, 5e-4 s * 10 m/s^2 in a fall; what that lag becomes in the
  // others
  fly_run<>("drop_terminal", 9.6e-3);
  fly_run<>("hover", 9.4e-6);
  fly_run<>("coast8_fwd", 2.7e-4);
  fly_run<>("coast8_side", 3e-4);
  fly_run<>("wind_const", 1e-4);
  fly_run<>("wind_const_yaw90", 1.1e-4);
  fly_run<>("wind_periodic", 1.7e-4);
  fly_run<pinnquad::test::SimulatorGroundEffect>("ge1_descend", 7.3e-4);
  fly_run<pinnquad::GroundEffect<pinnquad::Conyers>>("ge2_descend", 6e-4);
  fly_run<pinnquad::GroundEffect<pinnquad::Conyers>>("ge2_tilted", 2.5e-3);
}

TEST_CASE("short runs: a better integrator stays within the simulator's first order") {
  // the simulator's first step takes half the acceleration: 0.5 ms of up to 11 m/s^2 and 30 rad/s^2, over 40 ms
  const double speed_tolerance = 0.5e-3 * 11.0, rate_tolerance = 0.5e-3 * 31.0,
               attitude_tolerance = rate_tolerance * 0.04 / 2.0;
  using Vehicle = pinnquad::Quadrotor<double, pinnquad::StandardAtmosphere, pinnquad::QuadraticDrag>;
  const Vehicle vehicle(pinnquad::ReferenceQuadrotor15::value<double>(), pinnquad::paper_site<double>(),
                        pinnquad::StandardAtmosphere{}, pinnquad::QuadraticDrag{});
  for (const char* name : {"tumble", "coast_tilted", "agile"}) {
    CAPTURE(name);
    const ReferenceTable table(std::string("open_loop/") + name + ".csv");
    pinnquad::VehicleState<double> state = start(table);
    std::size_t row = 0;
    for (; row + 1 < 40 && one_step(table, row); ++row) {
      REQUIRE(vehicle.step(state, commands(table, row == 0 ? 0 : row - 1, "u"), 0.001) == pinnquad::Status::ok);
    }
    CHECK(row >= 30);
    const std::array<double, 4> attitude{table.at(row, "qw"), table.at(row, "qx"), table.at(row, "qy"),
                                         table.at(row, "qz")};
    const std::array<double, 4> reached{state.body.attitude.w, state.body.attitude.x, state.body.attitude.y,
                                        state.body.attitude.z};
    std::printf("%-12s %2zu ms: |dv| %.1e m/s, |dw| %.1e rad/s, |dq| %.1e\n", name, row,
                pinnquad::test::distance(state.body.velocity_m_s, vector(table, row, "v")),
                pinnquad::test::distance(state.body.body_rates_rad_s, vector(table, row, "w")),
                pinnquad::test::distance(reached, attitude));
    CHECK(pinnquad::test::distance(state.body.velocity_m_s, vector(table, row, "v")) <= speed_tolerance);
    CHECK(pinnquad::test::distance(state.body.body_rates_rad_s, vector(table, row, "w")) <= rate_tolerance);
    CHECK(pinnquad::test::distance(reached, attitude) <= attitude_tolerance);
  }
}
