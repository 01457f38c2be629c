// SPDX-License-Identifier: MIT
// The whole vehicle with uneven rotors, products of inertia and a sagging battery.
#include <doctest/doctest.h>

#include <cmath>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/vehicle/inverse.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"
#include "support/uneven_airframe.hpp"

using namespace pinnquad;
using pinnquad::test::draws;
using pinnquad::test::RandomStates;
using pinnquad::test::uneven_airframe;

namespace {

/// A battery that has lost a share of its thrust since time 0.
struct Sag {
  double per_s{0.01};
  template <class Scalar>
  void surroundings(Surroundings<Scalar>& air) const noexcept {
    air.thrust_scale = Scalar(1) - Scalar(per_s) * air.time_s;
  }
};

/// inverse(forward(u)) - u
template <class... Effects>
double round_trip(const Quadrotor<double, Effects...>& quadrotor, const State<double>& state,
                  const Commands<double>& u) {
  const double time_s = 12.0;
  Commands<double> again{};
  const Accelerations<double> motion = quadrotor.evaluate(state, u, time_s).motion;
  const Status status = inverse_commands(quadrotor, state, motion, time_s, again);
  return status == Status::ok ? pinnquad::test::distance(again, u) : 1e9;
}

constexpr double steepest = 20;  // du/ds of a quadratic curve at 0.05
const double tolerance = steepest * pinnquad::test::inverse_tolerance<double>;

}  // namespace

TEST_CASE("inverse(forward(u)) = u with tilted uneven rotors, products of inertia and a sagging battery") {
  const Airframe<double> a = uneven_airframe<double>();
  const Quadrotor<double, StandardAtmosphere, Sag, QuadraticDrag> plain(a);
  const Quadrotor<double, StandardAtmosphere, Sag, QuadraticDrag, RotorDrag> dragged(a);
  const Quadrotor<double, Sag, RotorGroundEffect<CheesemanBennett>, GroundEffect<CheesemanBennett>> low(a);
  REQUIRE(plain.status() == Status::ok);
  RandomStates random(91);
  for (int draw = 0; draw < draws; ++draw) {
    State<double> state = random.state<double>();
    const Commands<double> u = random.commands<double>(0.05, 1.0);
    CHECK(round_trip(plain, state, u) <= tolerance);
    CHECK(round_trip(dragged, state, u) <= tolerance);
    state.position_m[2] = random.scalar<double>(-2.0, -0.4);
    state.attitude = from_euler<double>({random.scalar<double>(-0.4, 0.4), random.scalar<double>(-0.4, 0.4), 1.0});
    CHECK(round_trip(low, state, u) <= 10 * tolerance);
  }
}

TEST_CASE("a battery scales what rotors make, as thin air does, and nothing else") {
  const Airframe<double> a = PaperQuadrotor::value<double>();
  const Quadrotor<double, Sag, QuadraticDrag> sagging(a, {}, Sag{0.02}, QuadraticDrag{});
  const Quadrotor<double, QuadraticDrag> full(a);
  RandomStates random(92);
  const State<double> state = random.state<double>();
  const Commands<double> u{0.5, 0.6, 0.7, 0.8};
  const auto one = full.evaluate(state, u, 10.0);
  const auto other = sagging.evaluate(state, u, 10.0);
  CHECK(pinnquad::test::distance(other.rotors.force_N, Vector3<double>(0.8 * one.rotors.force_N)) <= 1e-13);
  CHECK(pinnquad::test::distance(other.rotors.torque_N_m, Vector3<double>(0.8 * one.rotors.torque_N_m)) <= 1e-13);
  CHECK(other.aerodynamic.force_N == one.aerodynamic.force_N);
  Commands<double> untouched{0.1, 0.2, 0.3, 0.4};
  const Commands<double> before = untouched;
  CHECK(inverse_commands(sagging, state, one.motion, 60.0, untouched) == Status::out_of_range);  // empty
  CHECK(untouched == before);
}

TEST_CASE("a step on an empty battery falls; one on less than nothing is refused") {
  const Quadrotor<double, Sag> quadrotor(PaperQuadrotor::value<double>(), {}, Sag{0.01});
  VehicleState<double> state;
  state.rotors = {0.5, 0.5, 0.5, 0.5};
  state.time_s = 100;
  CHECK(quadrotor.step(state, state.rotors, 0.0) == Status::ok);
  state.time_s = 100.5;
  const VehicleState<double> before = state;
  CHECK(quadrotor.step(state, state.rotors, 0.001) == Status::out_of_range);
  CHECK(state.time_s == before.time_s);
  CHECK(state.body.velocity_m_s == before.body.velocity_m_s);
}

TEST_CASE("what a command means does not change a flight: the same vehicle told in thrust and in speed") {
  const Airframe<double> thrust = PaperQuadrotor::value<double>();
  Airframe<double> speed = thrust;
  for (auto& rotor : speed.rotors) rotor.thrust_curve = 1.0;
  const Quadrotor<double, QuadraticDrag> a(thrust), b(speed);
  VehicleState<double> at_a, at_b;
  at_a.rotors = {0.49, 0.49, 0.49, 0.49};
  for (std::size_t i = 0; i < 4; ++i) at_b.rotors[i] = std::sqrt(at_a.rotors[i]);
  for (int i = 0; i < 500; ++i) {
    const double t = 0.002 * i;
    const Commands<double> u{0.5 + 0.1 * std::sin(5 * t), 0.5, 0.5 - 0.1 * std::sin(3 * t), 0.51};
    Commands<double> n{};
    for (std::size_t k = 0; k < 4; ++k) n[k] = std::sqrt(u[k]);
    REQUIRE(a.step(at_a, u, 0.002) == Status::ok);
    REQUIRE(b.step(at_b, n, 0.002) == Status::ok);
  }
  CHECK(pinnquad::test::distance(at_a.body.position_m, at_b.body.position_m) <= 1e-11);
  CHECK(pinnquad::test::distance(at_a.body.body_rates_rad_s, at_b.body.body_rates_rad_s) <= 1e-11);
  for (std::size_t i = 0; i < 4; ++i) CHECK(at_b.rotors[i] * at_b.rotors[i] == doctest::Approx(at_a.rotors[i]));
}

TEST_CASE_TEMPLATE("one airframe by both builds of the step: the general one gives the plain one's motion", Scalar,
                   float, double) {
  const Airframe<Scalar> plain = PaperQuadrotor::value<Scalar>();
  Airframe<Scalar> general = plain;
  general.rotors[0].rise_time_constant_s =
      plain.rotor_time_constant_s * Scalar(1.0000002);  // not alike: the general build
  REQUIRE(is_plain(plain));
  REQUIRE(!is_plain(general));
  const Quadrotor<Scalar, QuadraticDrag, RotorDrag> a(plain), b(general);
  VehicleState<Scalar> at_a, at_b;
  at_a.body.body_rates_rad_s = at_b.body.body_rates_rad_s = Vector3<Scalar>(Scalar(1), Scalar(-2), Scalar(0.5));
  for (int i = 0; i < 100; ++i) {
    const Commands<Scalar> u{Scalar(0.6), Scalar(0.5), Scalar(0.55), Scalar(0.52)};
    REQUIRE(a.step(at_a, u, Scalar(0.002)) == Status::ok);
    REQUIRE(b.step(at_b, u, Scalar(0.002)) == Status::ok);
  }
  CHECK(pinnquad::test::distance(at_a.body.velocity_m_s, at_b.body.velocity_m_s) <= 1e-5);
  CHECK(pinnquad::test::distance(at_a.body.body_rates_rad_s, at_b.body.body_rates_rad_s) <= 1e-4);
}
