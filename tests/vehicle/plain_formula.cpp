// SPDX-License-Identifier: MIT
// The library against a second formula, which tests/reference confirms against rows of the independent simulator.
#include <doctest/doctest.h>

#include <algorithm>

#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"
#include "support/compare_with_plain.hpp"
#include "support/random_states.hpp"

namespace {

/// The float vehicle: rounding of a hundred operations, and Conyers' coefficients, which nearly cancel.
template <class Scalar>
inline constexpr double tolerance = sizeof(Scalar) == 4 ? 2e-5 : 1e-11;

/// A point of agile flight; low above the ground where there is a ground effect. Half of the points have wind; in a
/// quarter of them rotors clip.
plain::Point random_point(pinnquad::test::RandomStates& random, plain::GroundEffect effect, int draw) {
  const auto state = random.state<double>();
  const auto u = draw % 4 == 3 ? random.commands<double>(-0.4, 1.4) : random.commands<double>(0.2, 0.95);
  const auto wind = draw % 2 == 1 ? random.vector<double>(5.0) : pinnquad::Vector3<double>(0, 0, 0);
  const auto& v = state.velocity_m_s;
  const auto& w = state.body_rates_rad_s;
  const auto& q = state.attitude;
  const double z = effect == plain::GroundEffect::none ? state.position_m[2] : random.scalar<double>(0.04, 0.7);
  return {effect, z,    q.w,  q.x,  q.y,  q.z,  v[0],    v[1],    v[2],   w[0],
          w[1],   w[2], u[0], u[1], u[2], u[3], wind[0], wind[1], wind[2]};
}

}  // namespace

TEST_CASE_TEMPLATE("the library agrees with the plain formula: wind, clipped rotors, ground effects", Scalar, float,
                   double) {
  const auto airframe = pinnquad::ReferenceQuadrotor15::value<Scalar>();
  pinnquad::test::RandomStates random(150);
  for (const auto effect :
       {plain::GroundEffect::none, plain::GroundEffect::cheeseman_bennett, plain::GroundEffect::conyers}) {
    int in_ground_effect = 0;
    for (int draw = 0; draw < 16; ++draw) {
      const plain::Point point = random_point(random, effect, draw);
      const plain::Result expected = plain::evaluate(point);
      in_ground_effect += expected.ground_force[2] != 0.0 ? 1 : 0;
      const auto d = pinnquad::test::differences(pinnquad::test::evaluate(airframe, point), expected);
      CAPTURE(draw);
      const double greatest = std::max({d.density, d.rotor_force, d.rotor_torque, d.drag_force, d.ground_force,
                                        d.acceleration, d.body_derivative, d.angular});
      CHECK(greatest <= tolerance<Scalar>);
    }
    CHECK(in_ground_effect == (effect == plain::GroundEffect::none ? 0 : 16));
  }
}
