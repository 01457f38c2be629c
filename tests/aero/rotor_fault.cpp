// SPDX-License-Identifier: MIT
#include "pinnquad/aero/rotor_fault.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "pinnquad/aero/drag.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/vehicle/inverse.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"
#include "support/uneven_airframe.hpp"

using pinnquad::Commands;
using pinnquad::Quadrotor;
using pinnquad::RotorFault;
using pinnquad::Status;
using pinnquad::test::RandomStates;

TEST_CASE_TEMPLATE("a weak rotor is an airframe whose rotor is weaker, and before its time it is none", Scalar, float,
                   double) {
  const auto whole = pinnquad::test::uneven_airframe<Scalar>();
  RandomStates random(170);
  for (int draw = 0; draw < pinnquad::test::draws; ++draw) {
    const auto rotor = static_cast<unsigned>(draw % 4);
    const double share = random.scalar<double>(0.1, 1.0);
    auto weak = whole;
    weak.rotors[rotor].thrust_scale *= Scalar(share);
    const Quadrotor<Scalar, pinnquad::QuadraticDrag, RotorFault> failing(whole, {}, {}, {rotor, share, 2.0});
    const Quadrotor<Scalar, pinnquad::QuadraticDrag> weaker(weak), sound(whole);
    const auto state = random.state<Scalar>();
    const auto u = random.commands<Scalar>();
    const auto before = failing.evaluate(state, u, Scalar(1.999)).motion,
               after = failing.evaluate(state, u, Scalar(2)).motion;
    const auto expected = weaker.evaluate(state, u, Scalar(2)).motion,
               as_new = sound.evaluate(state, u, Scalar(1)).motion;
    const double tolerance = 1e3 * pinnquad::test::evaluation_tolerance<Scalar>;  // of hundreds of rad/s^2
    CHECK(pinnquad::test::distance(after.linear_m_s2, expected.linear_m_s2) <= tolerance);
    CHECK(pinnquad::test::distance(after.angular_rad_s2, expected.angular_rad_s2) <= tolerance);
    CHECK(pinnquad::test::distance(before.linear_m_s2, as_new.linear_m_s2) == 0);
    CHECK(pinnquad::test::distance(before.angular_rad_s2, as_new.angular_rad_s2) == 0);
  }
}

TEST_CASE("the inverse turns the weak rotor up, and has no solution with three") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  Commands<double> sound{}, u{};
  const pinnquad::State<double> hover;
  REQUIRE(inverse_commands(Quadrotor<double>(airframe), hover, {}, 0.0, sound) == Status::ok);
  const Quadrotor<double, RotorFault> weak(airframe, {}, {2, 0.7, 0.0}), dead(airframe, {}, {2, 0.0, 0.0});
  REQUIRE(inverse_commands(weak, hover, {}, 0.0, u) == Status::ok);
  CHECK(u[0] == doctest::Approx(sound[0]).epsilon(1e-12));
  CHECK(u[2] == doctest::Approx(sound[2] / 0.7).epsilon(1e-12));
  CHECK(dead.status() == Status::ok);  // it flies, for a while
  CHECK(inverse_commands(dead, hover, {}, 0.0, u) == Status::no_solution);
}

TEST_CASE("a rotor that is not there and a share that is none are refused") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  CHECK(RotorFault{}.status(airframe) == Status::ok);
  CHECK(RotorFault{4, 0.5, 0}.status(airframe) == Status::out_of_range);
  CHECK(RotorFault{0, 1.1, 0}.status(airframe) == Status::out_of_range);
  CHECK(RotorFault{0, -0.1, 0}.status(airframe) == Status::out_of_range);
  CHECK(RotorFault{0, 0.5, std::numeric_limits<double>::quiet_NaN()}.status(airframe) == Status::out_of_range);
}
