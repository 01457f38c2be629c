// SPDX-License-Identifier: MIT
#include "pinnquad/aero/drag.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "pinnquad/dynamics/airframes/px4_sih.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

using pinnquad::LinearDamping;
using pinnquad::Px4Sih;
using pinnquad::Status;

TEST_CASE("a vehicle that falls, drifts and turns is slowed as exp(-k t / m) and exp(-c t / J)") {
  const auto vehicle = pinnquad::Quadrotor<double, LinearDamping>::of<Px4Sih>();
  pinnquad::VehicleState<double> state;
  state.body.velocity_m_s = {3, 0, 0};
  state.body.body_rates_rad_s = {0, 0, 2};  // about the axis of thrust and gravity: the attitude turns no force
  const double hover = 9.80665 / 20;
  state.rotors = {hover, hover, hover, hover};
  constexpr double step_s = 0.001;
  for (int i = 0; i < 1000; ++i) REQUIRE(vehicle.step(state, state.rotors, step_s) == Status::ok);
  const double speed = std::hypot(state.body.velocity_m_s[0], state.body.velocity_m_s[1]);
  CHECK(speed == doctest::Approx(3 * std::exp(-1.0)).epsilon(1e-9));
  CHECK(state.body.body_rates_rad_s[2] == doctest::Approx(2 * std::exp(-0.025 / 0.030)).epsilon(1e-9));
}

TEST_CASE("coefficients that are negative or no numbers are out of range") {
  const auto airframe = Px4Sih::value<double>();
  CHECK(LinearDamping{}.status(airframe) == Status::ok);
  CHECK(LinearDamping{0, 0}.status(airframe) == Status::ok);
  CHECK(LinearDamping{-1, 0.025}.status(airframe) == Status::out_of_range);
  CHECK(LinearDamping{1, -0.025}.status(airframe) == Status::out_of_range);
  CHECK(LinearDamping{1, std::numeric_limits<double>::quiet_NaN()}.status(airframe) == Status::out_of_range);
}
