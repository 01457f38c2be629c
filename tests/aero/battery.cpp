// SPDX-License-Identifier: MIT
#include "pinnquad/aero/battery.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/vehicle/inverse.hpp"

using pinnquad::Battery;
using pinnquad::Commands;
using pinnquad::Quadrotor;
using pinnquad::State;
using pinnquad::Status;
using pinnquad::Vector3;
using pinnquad::VehicleState;

namespace {

const auto airframe = pinnquad::PaperQuadrotor::value<double>();
constexpr Battery four{4, 5.0, 0.9, 0.02, 0.75};

/// Voltage under load by iteration, from the rotors' power at their speeds, of commands that are thrusts.
double plain_voltage_V(const Battery& battery, double charge, const Commands<double>& u, double density_kg_m3) {
  const double z = charge;
  const double rest_V =
      battery.cells * (-1.031 * std::exp(-35 * z) + 3.685 + 0.2156 * z - 0.1178 * z * z + 0.3201 * z * z * z);
  const double full_V = battery.cells * 4.1029;
  double volts = rest_V;
  for (int round = 0; round < 200; ++round) {
    double power_W = 0;
    for (const double command : u) {
      const double n = airframe.max_rotor_speed_rev_s * std::sqrt(command) * volts / full_V;
      power_W += airframe.power_coefficient * density_kg_m3 * n * n * n * std::pow(airframe.propeller_diameter_m, 5);
    }
    const double current_A = power_W / battery.efficiency / volts;
    volts = rest_V - current_A * battery.cells * battery.cell_resistance_ohm_Ah / battery.capacity_Ah;
  }
  return volts;
}

}  // namespace

TEST_CASE("its voltage is that of its charge under the rotors' power, and thrust goes with the square of it") {
  using Vehicle = Quadrotor<double, pinnquad::StandardAtmosphere, Battery>;
  const Vehicle vehicle(airframe, {}, {}, four);
  const Quadrotor<double, pinnquad::StandardAtmosphere> without(airframe);
  VehicleState<double> state;
  state.body.position_m[2] = -2000;
  for (const double used : {0.0, 0.4, 0.8, 0.88}) {
    state.rotors = {0.3, 0.5 + used / 4, 0.7, 0.4};
    state.charge_used_C = used * 3600 * four.capacity_Ah;
    const auto air = vehicle.surroundings(state);
    const double volts = plain_voltage_V(four, 0.9 - used, state.rotors, air.air_density_kg_m3);
    CHECK(air.battery.voltage_V == doctest::Approx(volts).epsilon(1e-6));
    const double share = volts / (4 * 4.1029);
    const Vector3<double> made = vehicle.evaluate(state).rotors.force_N;
    CHECK(made[2] == doctest::Approx(share * share * without.evaluate(state).rotors.force_N[2]).epsilon(1e-6));
    Commands<double> again{};
    REQUIRE(inverse_commands(vehicle, state, vehicle.evaluate(state).motion, again) == Status::ok);
    for (std::size_t i = 0; i < 4; ++i) CHECK(again[i] == doctest::Approx(state.rotors[i]).epsilon(1e-12));
  }
  CHECK(without.surroundings(state).battery.voltage_V == 0);
}

TEST_CASE("a flight takes from it what the rotors draw: energy out is power times time") {
  const Quadrotor<double, Battery> vehicle(airframe, {}, four);
  VehicleState<double> state;
  state.rotors = {0.5, 0.5, 0.5, 0.5};
  double charge_C = 0;
  for (int i = 0; i < 5000; ++i) {
    state.body = {};  // held in place
    const auto air = vehicle.surroundings(state);
    REQUIRE(vehicle.step(state, {0.5, 0.5, 0.5, 0.5}, 0.002) == Status::ok);
    double power_W = 0;
    for (const double command : state.rotors) {
      const double n = airframe.max_rotor_speed_rev_s * std::sqrt(command) * air.battery.voltage_V / (4 * 4.1029);
      power_W += airframe.power_coefficient * 1.225 * n * n * n * std::pow(airframe.propeller_diameter_m, 5);
    }
    charge_C += power_W / four.efficiency / air.battery.voltage_V * 0.002;
  }
  CHECK(state.charge_used_C > 50);
  CHECK(state.charge_used_C == doctest::Approx(charge_C).epsilon(1e-4));
}

TEST_CASE("beyond its last charge it is empty, and takes the vehicle down without a fault") {
  const Quadrotor<double, Battery> vehicle(airframe, {}, Battery{4, 5.0, 0.01});
  VehicleState<double> state;
  state.rotors = {0.5, 0.5, 0.5, 0.5};
  state.charge_used_C = 1e9;
  CHECK(vehicle.surroundings(state.body, 0.0).battery.voltage_V > vehicle.surroundings(state).battery.voltage_V);
  CHECK(vehicle.step(state, state.rotors, 0.002) == Status::ok);
  CHECK(state.body.velocity_m_s[2] > 0);
  state.charge_used_C = std::numeric_limits<double>::quiet_NaN();
  CHECK(vehicle.step(state, state.rotors, 0.002) == Status::not_finite);
}

TEST_CASE("batteries that are none are refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(Battery{}.status(airframe) == Status::ok);
  for (const Battery& wrong :
       {Battery{0}, Battery{3, 0}, Battery{3, nan}, Battery{3, 2, 1.1}, Battery{3, 2, -0.1}, Battery{3, 2, 1, -1},
        Battery{3, 2, 1, 0.02, 0}, Battery{3, 2, 1, 0.02, 1.2}, Battery{3, 2, 1, 0.02, 0.75, -1}, Battery{3, 2, nan}}) {
    CHECK(wrong.status(airframe) == Status::out_of_range);
  }
}
