// SPDX-License-Identifier: MIT
// Eq. (3) must be what Eq. (1) becomes near hover: the same value there, the same Jacobian.
#include "pinnquad/dynamics/linearized.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/rigid_body.hpp"
#include "support/linearized.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"

using namespace pinnquad;

namespace {

constexpr double gravity = 9.80665;

/// (phi, theta, psi, v_B, omega, u) around hover.
using Point = std::array<double, 13>;
using Value = std::array<double, 6>;

Value pack(const Accelerations<double>& a) {
  return {a.linear_m_s2[0],    a.linear_m_s2[1],    a.linear_m_s2[2],
          a.angular_rad_s2[0], a.angular_rad_s2[1], a.angular_rad_s2[2]};
}

Point hover(const Airframe<double>& airframe) {
  Point point{};
  for (std::size_t i = 9; i < 13; ++i) point[i] = airframe.mass_kg * gravity / (4.0 * airframe.max_rotor_thrust_N());
  return point;
}

Value full(const Airframe<double>& airframe, const Point& p) {
  pinnquad::State<double> state;
  state.attitude = pinnquad::from_euler<double>({p[0], p[1], p[2]});
  state.velocity_m_s = pinnquad::body_to_world<double>(state.attitude, {p[3], p[4], p[5]});
  state.body_rates_rad_s = {p[6], p[7], p[8]};
  const pinnquad::Wrench<double> wrench = Rotors<double>(airframe).wrench({p[9], p[10], p[11], p[12]}, 1.0);
  return pack(pinnquad::accelerations(airframe, state, wrench, gravity));
}

Value linear(const Airframe<double>& airframe, const Point& p) {
  const pinnquad::Wrench<double> wrench = Rotors<double>(airframe).wrench({p[9], p[10], p[11], p[12]}, 1.0);
  return pack(pinnquad::test::linearized_accelerations(airframe, p[0], p[1], wrench, gravity));
}

}  // namespace

TEST_CASE("at hover both models stand still") {
  const Airframe<double> airframe = pinnquad::PaperQuadrotor::value<double>();
  CHECK(pinnquad::test::norm(full(airframe, hover(airframe))) <= pinnquad::test::evaluation_tolerance<double>);
  CHECK(pinnquad::test::norm(linear(airframe, hover(airframe))) <= pinnquad::test::evaluation_tolerance<double>);
}

TEST_CASE("the linearized model is the Jacobian of Eq. (1) at hover") {
  const Airframe<double> airframe = pinnquad::PaperQuadrotor::value<double>();
  const double h = 1e-5;
  const double tolerance = 1e-7;  // central difference: h^2 / 6 times a third derivative of some hundreds, rounding / h
  const Point centre = hover(airframe);
  for (std::size_t variable = 0; variable < centre.size(); ++variable) {
    CAPTURE(variable);
    Point after = centre, before = centre;
    after[variable] += h;
    before[variable] -= h;
    const Value f1 = full(airframe, after), f0 = full(airframe, before);
    const Value l1 = linear(airframe, after), l0 = linear(airframe, before);
    for (std::size_t row = 0; row < 6; ++row) {
      CAPTURE(row);
      CHECK(std::fabs((f1[row] - f0[row]) / (2 * h) - (l1[row] - l0[row]) / (2 * h)) <= tolerance);
    }
  }
}

TEST_CASE_TEMPLATE("Eq. (3) inverted gives the wrench and the commands back, not clipped", Scalar, float, double) {
  const Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  const Rotors<Scalar> rotors(airframe);
  pinnquad::test::RandomStates random(50);
  for (int draw = 0; draw < pinnquad::test::draws; ++draw) {
    const Commands<Scalar> u = random.commands<Scalar>(-0.3, 1.3);
    const Scalar density_ratio = random.scalar<Scalar>(0.7, 1.1);
    const Scalar roll = random.scalar<Scalar>(-0.5, 0.5), pitch = random.scalar<Scalar>(-0.5, 0.5);
    Accelerations<Scalar> motion = pinnquad::test::linearized_accelerations(
        airframe, roll, pitch, rotors.wrench(u, density_ratio), Scalar(gravity));
    const double tolerance = pinnquad::test::inverse_tolerance<Scalar>;
    CHECK(pinnquad::test::distance(
              pinnquad::linearized_commands(airframe, rotors, motion, Scalar(gravity), density_ratio), u) <= tolerance);
    // v_dot_x and v_dot_y are not used
    const Commands<Scalar> before =
        pinnquad::linearized_commands(airframe, rotors, motion, Scalar(gravity), density_ratio);
    motion.linear_m_s2[0] = Scalar(99);
    motion.linear_m_s2[1] = Scalar(-99);
    CHECK(pinnquad::linearized_commands(airframe, rotors, motion, Scalar(gravity), density_ratio) == before);
  }
}

TEST_CASE("Eq. (3): nose up flies backwards, right side down flies right, less thrust sinks") {
  const Airframe<double> airframe = pinnquad::PaperQuadrotor::value<double>();
  pinnquad::Wrench<double> weight;
  weight.force_N[2] = -airframe.mass_kg * gravity;
  CHECK(pinnquad::test::linearized_accelerations(airframe, 0.0, 0.1, weight, gravity).linear_m_s2[0] ==
        doctest::Approx(-0.1 * gravity));
  CHECK(pinnquad::test::linearized_accelerations(airframe, 0.1, 0.0, weight, gravity).linear_m_s2[1] ==
        doctest::Approx(0.1 * gravity));
  CHECK(pinnquad::test::linearized_accelerations(airframe, 0.0, 0.0, pinnquad::Wrench<double>{}, gravity)
            .linear_m_s2[2] == gravity);
}
