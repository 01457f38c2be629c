// SPDX-License-Identifier: MIT
#include "pinnquad/aero/flapping.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "support/hub_motion.hpp"
#include "support/momentum_theory.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"
#include "support/uneven_airframe.hpp"

using pinnquad::BladeFlapping;
using pinnquad::RotorCondition;
using pinnquad::Status;
using pinnquad::Vector3;
using pinnquad::test::RandomStates;

TEST_CASE("forward flight raises the nose, flight to the right the right side, climb does nothing") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  RotorCondition<double> c;
  c.rotor_thrust_N = {1, 2, 3, 4};
  const double expected = BladeFlapping{}.coefficient_s * 10 * 5;
  c.air_relative_velocity_m_s = Vector3<double>(5, 0, 0);
  CHECK(pinnquad::test::distance(BladeFlapping{}.wrench(c, airframe).torque_N_m, Vector3<double>(0, expected, 0)) <=
        1e-15);
  c.air_relative_velocity_m_s = Vector3<double>(0, 5, 0);
  CHECK(pinnquad::test::distance(BladeFlapping{}.wrench(c, airframe).torque_N_m, Vector3<double>(-expected, 0, 0)) <=
        1e-15);
  c.air_relative_velocity_m_s = Vector3<double>(0, 0, -5);
  CHECK(pinnquad::test::norm(BladeFlapping{}.wrench(c, airframe).torque_N_m) == 0);
  CHECK(pinnquad::test::norm(BladeFlapping{}.wrench(c, airframe).force_N) == 0);
}

TEST_CASE_TEMPLATE("each hub's moment in three dimensions, of tilted rotors too", Scalar, float, double) {
  const auto airframe = pinnquad::test::uneven_airframe<Scalar>();
  RandomStates random(150);
  for (int draw = 0; draw < pinnquad::test::draws; ++draw) {
    RotorCondition<Scalar> c;
    c.air_relative_velocity_m_s = random.vector<Scalar>(8.0);
    c.body_rates_rad_s = random.vector<Scalar>(6.0);
    for (Scalar& thrust : c.rotor_thrust_N) thrust = random.scalar<Scalar>(0.0, 8.0);
    Vector3<double> torque = Vector3<double>::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      const pinnquad::test::HubMotion hub = pinnquad::test::hub_motion(c, airframe.rotors[i]);
      torque += pinnquad::cross<double>(hub.velocity, hub.axis) * (0.003 * static_cast<double>(c.rotor_thrust_N[i]));
    }
    const auto made = BladeFlapping{0.003}.wrench(c, airframe);
    CHECK(pinnquad::test::distance(made.torque_N_m, torque) <= pinnquad::test::rounding<Scalar>(100));
    CHECK(pinnquad::test::norm(made.force_N) == 0);
  }
}

TEST_CASE("the default is the moment of a stiff propeller in its skewed wake at 10 m/s, summed over the disc") {
  // lift per area of blade elements under Coleman's inflow, by azimuth and radius; units of R, Omega R and v_h
  constexpr double pi = 3.141592653589793, radius_m = 0.1143, weight_N = 9.80665, density = 1.225;
  constexpr double slope = 0.107 * 5.1, agreement = 0.1;
  const double lambda = std::sqrt(2 * 0.1099 / (pi * pi * pi)), area = pi * radius_m * radius_m;
  const double v_h = std::sqrt(weight_N / 4 / (2 * density * area)), edgewise = 10 / v_h;
  const double induced = pinnquad::test::disc_flow(slope, lambda, edgewise, 0).induced;
  const double gradient = std::tan(std::atan(edgewise / induced) / 2);
  double moment = 0;  // over rho A (Omega R)^2 R: sum of sigma a / 2 (theta r^2 - lambda(r, psi) r) r cos(psi) dr dpsi
  constexpr int azimuths = 180, radii = 400;
  for (int i = 0; i < azimuths; ++i) {
    const double psi = 2 * pi * (i + 0.5) / azimuths;  // 0 behind the hub
    for (int j = 0; j < radii; ++j) {
      const double r = (j + 0.5) / radii;
      const double through = lambda * induced * (1 + gradient * r * std::cos(psi));
      moment += slope / 2 * (0.2 * r * r - through * r) * -r * std::cos(psi) / radii / azimuths;
    }
  }
  CHECK(moment > 0);  // more lift in front: nose up
  const double lever_m = moment / (2 * lambda * lambda) * radius_m;
  CHECK(std::fabs(BladeFlapping{}.coefficient_s / (lever_m / 10) - 1) <= agreement);
}

TEST_CASE("a coefficient that is negative or no number is refused") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  CHECK(BladeFlapping{}.status(airframe) == Status::ok);
  CHECK(BladeFlapping{-1e-3}.status(airframe) == Status::out_of_range);
  CHECK(BladeFlapping{std::numeric_limits<double>::quiet_NaN()}.status(airframe) == Status::out_of_range);
}
