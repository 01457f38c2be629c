// SPDX-License-Identifier: MIT
#include "pinnquad/aero/drag.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"

using pinnquad::RotorCondition;
using pinnquad::RotorDrag;
using pinnquad::test::RandomStates;
using pinnquad::test::rounding;

namespace {
template <class Scalar>
RotorCondition<Scalar> condition(RandomStates& random) {
  RotorCondition<Scalar> c;
  c.air_relative_velocity_m_s = random.vector<Scalar>(8.0);
  c.body_rates_rad_s = random.vector<Scalar>(6.0);
  for (Scalar& thrust : c.rotor_thrust_N) thrust = random.scalar<Scalar>(0.0, 8.0);
  return c;
}
}  // namespace

TEST_CASE_TEMPLATE("each hub's force, summed about the centre of gravity in three dimensions", Scalar, float, double) {
  const auto airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  RandomStates random(120);
  for (int draw = 0; draw < pinnquad::test::draws; ++draw) {
    const RotorCondition<Scalar> c = condition<Scalar>(random);
    const RotorDrag drag{0.031};
    double force[3] = {}, torque[3] = {};
    for (std::size_t i = 0; i < 4; ++i) {
      // v + omega x r with all components, then r x F
      const double r[3] = {static_cast<double>(airframe.rotors[i].x_m), static_cast<double>(airframe.rotors[i].y_m),
                           0.0};
      const double w[3] = {static_cast<double>(c.body_rates_rad_s[0]), static_cast<double>(c.body_rates_rad_s[1]),
                           static_cast<double>(c.body_rates_rad_s[2])};
      const double v[2] = {static_cast<double>(c.air_relative_velocity_m_s[0]) + w[1] * r[2] - w[2] * r[1],
                           static_cast<double>(c.air_relative_velocity_m_s[1]) + w[2] * r[0] - w[0] * r[2]};
      const double scale = -0.031 * static_cast<double>(c.rotor_thrust_N[i]);
      const double f[3] = {scale * v[0], scale * v[1], 0.0};
      for (int k = 0; k < 3; ++k) force[k] += f[k];
      torque[0] += r[1] * f[2] - r[2] * f[1];
      torque[1] += r[2] * f[0] - r[0] * f[2];
      torque[2] += r[0] * f[1] - r[1] * f[0];
    }
    const auto wrench = drag.wrench(c, airframe);
    for (int k = 0; k < 3; ++k) {
      CHECK(std::fabs(static_cast<double>(wrench.force_N[k]) - force[k]) <= rounding<Scalar>(100) * 10.0);
      CHECK(std::fabs(static_cast<double>(wrench.torque_N_m[k]) - torque[k]) <= rounding<Scalar>(100) * 10.0);
    }
  }
}

TEST_CASE_TEMPLATE("rotor drag takes energy, whatever the motion", Scalar, float, double) {
  const auto airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  RandomStates random(121);
  for (int draw = 0; draw < pinnquad::test::draws; ++draw) {
    const RotorCondition<Scalar> c = condition<Scalar>(random);
    const auto w = RotorDrag{}.wrench(c, airframe);
    const Scalar power_W = w.force_N.dot(c.air_relative_velocity_m_s) + w.torque_N_m.dot(c.body_rates_rad_s);
    CHECK(power_W < Scalar(0));
  }
}

TEST_CASE("rotors that do not turn feel no rotor drag") {
  RandomStates random(122);
  RotorCondition<double> c = condition<double>(random);
  c.rotor_thrust_N = {};
  const auto w = RotorDrag{}.wrench(c, pinnquad::PaperQuadrotor::value<double>());
  CHECK(w.force_N == pinnquad::Vector3<double>(0, 0, 0));
  CHECK(w.torque_N_m == pinnquad::Vector3<double>(0, 0, 0));
  static_assert(pinnquad::uses_rotor_wrench<RotorDrag> && !pinnquad::has_thrust_branches<RotorDrag>);
}
