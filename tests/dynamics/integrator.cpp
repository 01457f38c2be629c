// SPDX-License-Identifier: MIT
#include "pinnquad/dynamics/integrator.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/rigid_body.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"

using namespace pinnquad;
using namespace pinnquad::test;
using pinnquad::detail::StateDerivative;

namespace {

/// The derivative that belongs to body-frame accelerations.
template <class Scalar>
StateDerivative<Scalar> derivative(const State<Scalar>& state, const pinnquad::Accelerations<Scalar>& motion) {
  return {state.velocity_m_s, pinnquad::world_acceleration(state, motion.linear_m_s2),
          pinnquad::attitude_rate(state.attitude, state.body_rates_rad_s), motion.angular_rad_s2};
}

/// World acceleration and body torque as given functions of time, on a rigid body.
template <class Scalar>
struct Driven {
  Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  Scalar start_s{0};

  StateDerivative<Scalar> operator()(const State<Scalar>& state, Scalar offset_s) const {
    const Scalar t = start_s + offset_s;
    pinnquad::Wrench<Scalar> wrench;
    wrench.force_N = {std::sin(Scalar(3) * t), Scalar(2) * std::cos(t),
                      -Scalar(14) + state.velocity_m_s[0] * state.velocity_m_s[1]};
    wrench.torque_N_m = {Scalar(0.1) * std::cos(Scalar(2) * t), Scalar(0.1) * std::sin(t), Scalar(0.05)};
    return derivative(state, pinnquad::accelerations(airframe, state, wrench, Scalar(9.80665)));
  }
};

template <class Step>
State<double> fly(State<double> state, double duration_s, int steps, Driven<double> body, const Step& step) {
  const double h = duration_s / steps;
  for (int i = 0; i < steps; ++i) {
    body.start_s = h * i;
    state = step(state, h, body);
  }
  return state;
}

const auto rk4 = [](const State<double>& s, double h, const Driven<double>& body) {
  return pinnquad::detail::rk4_step(s, h, body);
};
/// Each part's error ratio on halving the step, so that no part hides behind another.
std::array<double, 4> halving_ratios(const State<double>& coarse, const State<double>& fine,
                                     const State<double>& exact) {
  using pinnquad::test::components;
  return {distance(coarse.position_m, exact.position_m) / distance(fine.position_m, exact.position_m),
          distance(coarse.velocity_m_s, exact.velocity_m_s) / distance(fine.velocity_m_s, exact.velocity_m_s),
          distance(components(coarse.attitude), components(exact.attitude)) /
              distance(components(fine.attitude), components(exact.attitude)),
          distance(coarse.body_rates_rad_s, exact.body_rates_rad_s) /
              distance(fine.body_rates_rad_s, exact.body_rates_rad_s)};
}

}  // namespace

TEST_CASE("RK4 is of fourth order: half the step, a sixteenth of the error") {
  RandomStates random(60);
  for (int draw = 0; draw < 10; ++draw) {
    const State<double> start = random.state<double>();
    const State<double> exact = fly(start, 0.5, 1600, {}, rk4);
    const auto ratios = halving_ratios(fly(start, 0.5, 50, {}, rk4), fly(start, 0.5, 100, {}, rk4), exact);
    for (const double ratio : ratios) {
      // 16 in the limit; the next order shows at these steps
      CHECK(ratio > 13.0);
      CHECK(ratio < 19.5);
    }
  }
}

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
  const Driven<Scalar> body;
  for (int draw = 0; draw < pinnquad::test::draws; ++draw) {
    const State<Scalar> start = random.state<Scalar>();
    const State<Scalar> a = pinnquad::detail::rk4_step(start, Scalar(0.01), body);
    CHECK(std::fabs(static_cast<double>(pinnquad::squared_norm(a.attitude)) - 1.0) <=
          pinnquad::test::rounding<Scalar>(4));
    const State<Scalar> same = pinnquad::detail::rk4_step(start, Scalar(0), body);
    CHECK(same.position_m == start.position_m);
    CHECK(same.velocity_m_s == start.velocity_m_s);
    CHECK(same.body_rates_rad_s == start.body_rates_rad_s);
  }
}
