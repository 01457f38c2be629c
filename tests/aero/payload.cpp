// SPDX-License-Identifier: MIT
#include "pinnquad/aero/payload.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/vehicle/inverse.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"
#include "support/uneven_airframe.hpp"

using pinnquad::Commands;
using pinnquad::Payload;
using pinnquad::Quadrotor;
using pinnquad::Status;
using pinnquad::test::RandomStates;

TEST_CASE_TEMPLATE("a vehicle with a payload moves as one with that mass more, from the time on", Scalar, float,
                   double) {
  using Loaded = Quadrotor<Scalar, pinnquad::StandardAtmosphere, pinnquad::QuadraticDrag, pinnquad::RotorDrag, Payload>;
  using Heavier = Quadrotor<Scalar, pinnquad::StandardAtmosphere, pinnquad::QuadraticDrag, pinnquad::RotorDrag>;
  const auto airframe = pinnquad::test::uneven_airframe<Scalar>();
  auto heavy = airframe;
  heavy.mass_kg += Scalar(0.4);
  const Loaded loaded(airframe, {}, {}, {}, {}, {0.4, 3.0});
  const Heavier heavier(heavy), alone(airframe);
  RandomStates random(180);
  for (int draw = 0; draw < pinnquad::test::draws; ++draw) {
    const auto state = random.state<Scalar>();
    const auto u = random.commands<Scalar>();
    const auto after = loaded.evaluate(state, u, Scalar(3)).motion,
               expected = heavier.evaluate(state, u, Scalar(3)).motion;
    const double tolerance = 20 * pinnquad::test::evaluation_tolerance<Scalar>;  // of tens of m/s^2
    CHECK(pinnquad::test::distance(after.linear_m_s2, expected.linear_m_s2) <= tolerance);
    CHECK(pinnquad::test::distance(after.angular_rad_s2, expected.angular_rad_s2) == 0);
    const auto before = loaded.evaluate(state, u, Scalar(2.999)).motion;
    CHECK(pinnquad::test::distance(before.linear_m_s2, alone.evaluate(state, u, Scalar(0)).motion.linear_m_s2) == 0);
  }
}

TEST_CASE("hover with a payload: its share more of command, also in ground effect") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  auto heavy = airframe;
  heavy.mass_kg *= 1.2;
  pinnquad::State<double> low;
  low.position_m[2] = 0.877 - 0.3;
  const Quadrotor<double, pinnquad::GroundEffect<pinnquad::Conyers>, Payload> loaded(
      airframe, pinnquad::paper_site<double>(), {}, {0.2 * airframe.mass_kg, 0});
  const Quadrotor<double, pinnquad::GroundEffect<pinnquad::Conyers>> heavier(heavy, pinnquad::paper_site<double>(), {});
  Commands<double> with{}, expected{};
  REQUIRE(inverse_commands(loaded, low, {}, 0.0, with) == Status::ok);
  REQUIRE(inverse_commands(heavier, low, {}, 0.0, expected) == Status::ok);
  CHECK(pinnquad::test::distance(with, expected) <= 1e-12);
}

TEST_CASE("a mass that is negative or no number is refused") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  CHECK(Payload{}.status(airframe) == Status::ok);
  CHECK(Payload{-0.1, 0}.status(airframe) == Status::out_of_range);
  CHECK(Payload{std::numeric_limits<double>::quiet_NaN(), 0}.status(airframe) == Status::out_of_range);
}
