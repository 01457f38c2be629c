// SPDX-License-Identifier: MIT
#include "pinnquad/dynamics/rigid_body.hpp"

#include <doctest/doctest.h>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {
template <class Scalar>
Wrench<Scalar> random_wrench(RandomStates& random) {
  Wrench<Scalar> wrench;
  wrench.force_N = random.vector<Scalar>(20.0);
  wrench.torque_N_m = random.vector<Scalar>(2.0);
  return wrench;
}
/// Accelerations reach 200 m/s^2 and rad/s^2 here; rounding scales with them.
constexpr double largest_acceleration = 200.0;
}  // namespace

TEST_CASE_TEMPLATE("Newton: the world acceleration is gravity plus rotated force over mass", Scalar, float, double) {
  const Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  RandomStates random(40);
  for (int draw = 0; draw < draws; ++draw) {
    const State<Scalar> state = random.state<Scalar>();
    const Wrench<Scalar> wrench = random_wrench<Scalar>(random);
    const Accelerations<Scalar> motion = pinnquad::accelerations(airframe, state, wrench, Scalar(9.80665));
    Vector3<Scalar> expected = pinnquad::body_to_world(state.attitude, wrench.force_N) / airframe.mass_kg;
    expected[2] += Scalar(9.80665);
    CHECK(distance(pinnquad::world_acceleration(state, motion.linear_m_s2), expected) <=
          largest_acceleration * evaluation_tolerance<Scalar>);
  }
}

TEST_CASE("v_dot_B is the time derivative of the body-frame velocity") {
  const Airframe<double> airframe = pinnquad::PaperQuadrotor::value<double>();
  RandomStates random(41);
  const double h = 1e-5;
  const double tolerance = 1e-6;  // central difference: h^2 times a third derivative of some 1e4 m/s^4, rounding / h
  for (int draw = 0; draw < draws; ++draw) {
    const State<double> state = random.state<double>();
    const Accelerations<double> motion =
        pinnquad::accelerations(airframe, state, random_wrench<double>(random), 9.80665);
    const Vector3<double> world = pinnquad::world_acceleration(state, motion.linear_m_s2);
    const auto velocity_at = [&](double t) {
      State<double> later = state;
      later.velocity_m_s = state.velocity_m_s + world * t;
      const double angle = state.body_rates_rad_s.norm() * t, s = std::sin(angle / 2);
      const Vector3<double> axis = state.body_rates_rad_s / state.body_rates_rad_s.norm();
      later.attitude =
          state.attitude * pinnquad::Quaternion<double>{std::cos(angle / 2), s * axis[0], s * axis[1], s * axis[2]};
      return pinnquad::body_velocity(later);
    };
    const Vector3<double> difference = (velocity_at(h) - velocity_at(-h)) / (2 * h);
    CHECK(distance(motion.linear_m_s2, difference) <= tolerance);
  }
}

TEST_CASE_TEMPLATE("Euler: each component as it stands in a textbook", Scalar, float, double) {
  const Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  const double jx = static_cast<double>(airframe.inertia_kg_m2[0]), jy = static_cast<double>(airframe.inertia_kg_m2[1]),
               jz = static_cast<double>(airframe.inertia_kg_m2[2]);
  RandomStates random(42);
  for (int draw = 0; draw < draws; ++draw) {
    const State<Scalar> state = random.state<Scalar>();
    const Wrench<Scalar> wrench = random_wrench<Scalar>(random);
    const Vector3<double> t = wrench.torque_N_m.template cast<double>(),
                          w = state.body_rates_rad_s.template cast<double>();
    const Vector3<double> expected((t[0] + (jy - jz) * w[1] * w[2]) / jx, (t[1] + (jz - jx) * w[2] * w[0]) / jy,
                                   (t[2] + (jx - jy) * w[0] * w[1]) / jz);
    const Accelerations<Scalar> motion = pinnquad::accelerations(airframe, state, wrench, Scalar(9.80665));
    CHECK(distance(motion.angular_rad_s2, expected) <= largest_acceleration * evaluation_tolerance<Scalar>);
  }
}

TEST_CASE_TEMPLATE("without torque angular momentum and energy keep still at that instant", Scalar, float, double) {
  const Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  const Vector3<Scalar> inertia = pinnquad::to_vector(airframe.inertia_kg_m2);
  RandomStates random(43);
  for (int draw = 0; draw < draws; ++draw) {
    const State<Scalar> state = random.state<Scalar>();
    const Vector3<Scalar>& w = state.body_rates_rad_s;
    const Accelerations<Scalar> motion = pinnquad::accelerations(airframe, state, Wrench<Scalar>{}, Scalar(0));
    const Vector3<Scalar> change = inertia.cwiseProduct(motion.angular_rad_s2);  // body derivative of J w
    const Vector3<Scalar> transport = pinnquad::cross<Scalar>(w, inertia.cwiseProduct(w));
    CHECK(distance(change, Vector3<Scalar>(-transport)) <= evaluation_tolerance<Scalar>);
    CHECK(std::fabs(static_cast<double>(w.dot(change))) <= 6.0 * evaluation_tolerance<Scalar>);
    CHECK(distance(pinnquad::world_acceleration(state, motion.linear_m_s2), Vector3<Scalar>(0, 0, 0)) <=
          largest_acceleration * evaluation_tolerance<Scalar>);
  }
}

TEST_CASE_TEMPLATE("body_derivative and world_acceleration are each other's inverse", Scalar, float, double) {
  RandomStates random(45);
  for (int draw = 0; draw < draws; ++draw) {
    const State<Scalar> state = random.state<Scalar>();
    const Vector3<Scalar> world = random.vector<Scalar>(20.0);
    const Vector3<Scalar> again = pinnquad::world_acceleration(state, pinnquad::body_derivative(state, world));
    CHECK(distance(again, world) <= largest_acceleration * evaluation_tolerance<Scalar>);
  }
}

TEST_CASE_TEMPLATE("wrenches add and subtract component by component", Scalar, float, double) {
  RandomStates random(46);
  const Wrench<Scalar> a = random_wrench<Scalar>(random), b = random_wrench<Scalar>(random);
  const Wrench<Scalar> sum = a + b, difference = a - b;
  for (int i = 0; i < 3; ++i) {
    CHECK(sum.force_N[i] == a.force_N[i] + b.force_N[i]);
    CHECK(sum.torque_N_m[i] == a.torque_N_m[i] + b.torque_N_m[i]);
    CHECK(difference.force_N[i] == a.force_N[i] - b.force_N[i]);
    CHECK(difference.torque_N_m[i] == a.torque_N_m[i] - b.torque_N_m[i]);
  }
}
