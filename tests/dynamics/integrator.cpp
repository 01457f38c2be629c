// SPDX-License-Identifier: MIT
#include "pinnquad/dynamics/integrator.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "support/random_states.hpp"
#include "support/tolerances.hpp"

using namespace pinnquad;
using namespace pinnquad::test;
using pinnquad::detail::StateDerivative;

TEST_CASE("RK4 integrates a cubic in time without error") {
  const auto cubic = [](const State<double>& state, double t) {
    StateDerivative<double> d;
    d.velocity_m_s = Vector3<double>(1 + t * t * t, 0, state.velocity_m_s[2]);
    d.acceleration_m_s2 = Vector3<double>(4 * t * t * t, 3 * t * t, 9.0);
    d.attitude_rate = {0, 0, 0, 0};
    d.angular_acceleration_rad_s2 = Vector3<double>(1, 2 * t, 8 * t * t * t);
    return d;
  };
  const double h = 2.0, tolerance = pinnquad::test::rounding<double>(100);
  const State<double> end = pinnquad::detail::rk4_step(State<double>{}, h, cubic);
  CHECK(distance(end.position_m, Vector3<double>(h + h * h * h * h / 4, 0, 4.5 * h * h)) <= tolerance);
  CHECK(distance(end.velocity_m_s, Vector3<double>(h * h * h * h, h * h * h, 9 * h)) <= tolerance);
  CHECK(distance(end.body_rates_rad_s, Vector3<double>(h, h * h, 2 * h * h * h * h)) <= tolerance);
}

TEST_CASE_TEMPLATE("a step leaves a unit quaternion, and a step of zero changes nothing", Scalar, float, double) {
  RandomStates random(62);
  const auto spinning = [](const State<Scalar>& state, Scalar) {
    return StateDerivative<Scalar>{state.velocity_m_s, Vector3<Scalar>(1, 2, 3),
                                   pinnquad::attitude_rate(state.attitude, state.body_rates_rad_s),
                                   Vector3<Scalar>(3, 2, 1)};
  };
  for (int draw = 0; draw < pinnquad::test::draws; ++draw) {
    const State<Scalar> start = random.state<Scalar>();
    const State<Scalar> a = pinnquad::detail::rk4_step(start, Scalar(0.01), spinning);
    CHECK(std::fabs(static_cast<double>(pinnquad::squared_norm(a.attitude)) - 1.0) <=
          pinnquad::test::rounding<Scalar>(4));
    const State<Scalar> same = pinnquad::detail::rk4_step(start, Scalar(0), spinning);
    CHECK(same.position_m == start.position_m);
    CHECK(same.velocity_m_s == start.velocity_m_s);
    CHECK(same.body_rates_rad_s == start.body_rates_rad_s);
  }
}
