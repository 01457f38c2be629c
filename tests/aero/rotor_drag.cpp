// SPDX-License-Identifier: MIT
#include "pinnquad/aero/drag.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "support/hub_motion.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"
#include "support/uneven_airframe.hpp"

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

TEST_CASE_TEMPLATE("each hub's force across its axis, summed about the centre of gravity: upright and tilted rotors",
                   Scalar, float, double) {
  RandomStates random(120);
  for (int draw = 0; draw < pinnquad::test::draws; ++draw) {
    const auto airframe =
        draw % 2 == 0 ? pinnquad::PaperQuadrotor::value<Scalar>() : pinnquad::test::uneven_airframe<Scalar>();
    const RotorCondition<Scalar> c = condition<Scalar>(random);
    pinnquad::Vector3<double> force = pinnquad::Vector3<double>::Zero(), torque = force;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto hub = pinnquad::test::hub_motion(c, airframe.rotors[i]);
      const pinnquad::Vector3<double> across = hub.velocity - hub.axis * hub.velocity.dot(hub.axis);
      const pinnquad::Vector3<double> f = -0.031 * static_cast<double>(c.rotor_thrust_N[i]) * across;
      force += f;
      torque += pinnquad::cross<double>(hub.arm, f);
    }
    const auto wrench = RotorDrag{0.031}.wrench(c, airframe);
    CHECK(pinnquad::test::distance(wrench.force_N, force) <= rounding<Scalar>(100) * 10.0);
    CHECK(pinnquad::test::distance(wrench.torque_N_m, torque) <= rounding<Scalar>(100) * 10.0);
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
