// SPDX-License-Identifier: MIT
// Forward and inverse dynamics are each other's inverse, through the same effects.
#include "pinnquad/vehicle/inverse.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/battery.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/flapping.hpp"
#include "pinnquad/aero/ground_contact.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/inflow.hpp"
#include "pinnquad/aero/payload.hpp"
#include "pinnquad/aero/rotor_fault.hpp"
#include "pinnquad/aero/wake.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "support/numbers_of.hpp"
#include "support/random_states.hpp"
#include "support/simulator_ground_effect.hpp"
#include "support/tolerances.hpp"

using pinnquad::Accelerations;
using pinnquad::Commands;
using pinnquad::Quadrotor;
using pinnquad::State;
using pinnquad::Status;
using pinnquad::test::draws;
using pinnquad::test::RandomStates;

namespace {

template <class Scalar>
using Airborne = Quadrotor<Scalar, pinnquad::StandardAtmosphere, pinnquad::PeriodicWind, pinnquad::QuadraticDrag>;
template <class Scalar>
using NearGround =
    Quadrotor<Scalar, pinnquad::StandardAtmosphere, pinnquad::QuadraticDrag, pinnquad::GroundEffect<pinnquad::Conyers>>;
template <class Scalar>
using NearGroundCheesemanBennett = Quadrotor<Scalar, pinnquad::StandardAtmosphere, pinnquad::QuadraticDrag,
                                             pinnquad::GroundEffect<pinnquad::CheesemanBennett>>;

template <class Scalar>
Airborne<Scalar> airborne() {
  return Airborne<Scalar>(pinnquad::PaperQuadrotor::value<Scalar>(), pinnquad::paper_site<Scalar>(),
                          pinnquad::StandardAtmosphere{}, pinnquad::PeriodicWind{}, pinnquad::QuadraticDrag{});
}
template <class Scalar>
NearGround<Scalar> near_ground() {
  return NearGround<Scalar>(pinnquad::PaperQuadrotor::value<Scalar>(), pinnquad::paper_site<Scalar>(),
                            pinnquad::StandardAtmosphere{}, pinnquad::QuadraticDrag{},
                            pinnquad::GroundEffect<pinnquad::Conyers>{});
}

/// The thrust equation is solved in closed form; where its branches meet, either may be taken within the rounding.
template <class Scalar>
inline constexpr double ground_effect_tolerance = pinnquad::test::rounding<Scalar>(500);

/// Motions as in flight: accelerations of 100 rad/s^2 times 1 / T_max, and the velocity's transport term.
template <class Scalar>
inline constexpr double flight_tolerance = 2.0 * pinnquad::test::inverse_tolerance<Scalar>;

template <class Scalar, class Vehicle>
double round_trip(const Vehicle& vehicle, const State<Scalar>& state, const Commands<Scalar>& u, Scalar time_s) {
  const Accelerations<Scalar> motion = vehicle.evaluate(state, u, time_s).motion;
  Commands<Scalar> again{};
  if (pinnquad::inverse_commands(vehicle, state, motion, time_s, again) != Status::ok)
    return std::numeric_limits<double>::infinity();
  return pinnquad::test::distance(again, u);
}

}  // namespace

TEST_CASE_TEMPLATE("commands -> motion -> commands in ground effect", Scalar, float, double) {
  // commands above 0.2: the equation is solved relative to the thrust. Tilt below 60 degrees, ratios below 1.5: one
  // solution
  RandomStates random(102);
  const NearGroundCheesemanBennett<Scalar> cheeseman_bennett(
      pinnquad::PaperQuadrotor::value<Scalar>(), pinnquad::paper_site<Scalar>(), pinnquad::StandardAtmosphere{},
      pinnquad::QuadraticDrag{}, pinnquad::GroundEffect<pinnquad::CheesemanBennett>{});
  const NearGround<Scalar> conyers = near_ground<Scalar>();
  for (int draw = 0; draw < draws; ++draw) {
    State<Scalar> state = random.state<Scalar>();
    state.position_m[2] = Scalar(0.877) - random.scalar<Scalar>(0.05, 1.5);
    state.attitude = pinnquad::from_euler<Scalar>(
        {random.scalar<Scalar>(-0.7, 0.7), random.scalar<Scalar>(-0.7, 0.7), random.scalar<Scalar>(-3.0, 3.0)});
    const Commands<Scalar> u = random.commands<Scalar>(0.2, 1.0);
    CHECK(round_trip(conyers, state, u, Scalar(0)) <= ground_effect_tolerance<Scalar>);
    CHECK(round_trip(cheeseman_bennett, state, u, Scalar(0)) <= ground_effect_tolerance<Scalar>);
  }
}

namespace {
/// An effect with all six components, as a gust on a lopsided body would have.
struct Push {
  template <class Scalar>
  pinnquad::Wrench<Scalar> wrench(const pinnquad::AeroCondition<Scalar>& condition,
                                  const pinnquad::Airframe<Scalar>&) const noexcept {
    pinnquad::Wrench<Scalar> result;
    result.force_N = {Scalar(1), Scalar(-2), Scalar(3)};
    result.torque_N_m = {Scalar(0.2) * condition.air_relative_velocity_m_s[1], Scalar(-0.3), Scalar(0.05)};
    return result;
  }
};
/// Lift that grows with the square of thrust: no affine effect, but a mild one.
struct Quadratic {
  template <class Scalar>
  pinnquad::Wrench<Scalar> wrench(const pinnquad::RotorCondition<Scalar>& condition,
                                  const pinnquad::Airframe<Scalar>&) const noexcept {
    pinnquad::Wrench<Scalar> result;
    result.force_N[2] = Scalar(-0.005) * condition.rotors.force_N[2] * condition.rotors.force_N[2];
    return result;
  }
};
}  // namespace

TEST_CASE_TEMPLATE("commands -> motion -> commands: without effects, in wind, with torque, of one nearly affine",
                   Scalar, float, double) {
  RandomStates random(100);
  const pinnquad::Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  for (int draw = 0; draw < draws; ++draw) {
    const State<Scalar> state = random.state<Scalar>();
    const Commands<Scalar> u = random.commands<Scalar>();
    const Scalar time_s = random.scalar<Scalar>(0.0, 20.0);
    CHECK(round_trip(Quadrotor<Scalar>(airframe), state, u, time_s) <= flight_tolerance<Scalar>);
    CHECK(round_trip(airborne<Scalar>(), state, u, time_s) <= flight_tolerance<Scalar>);
    CHECK(round_trip(Quadrotor<Scalar, Push>(airframe), state, u, time_s) <= flight_tolerance<Scalar>);
    CHECK(round_trip(Quadrotor<Scalar, Quadratic>(airframe), state, u, time_s) <= 10 * ground_effect_tolerance<Scalar>);
  }
}

TEST_CASE_TEMPLATE("motion -> commands -> motion: what rotors can make comes back", Scalar, float, double) {
  RandomStates random(103);
  const Airborne<Scalar> vehicle = airborne<Scalar>();
  int compared = 0;
  for (int draw = 0; draw < 10 * draws; ++draw) {
    const State<Scalar> state = random.state<Scalar>();
    const Accelerations<Scalar> wanted = random.motion<Scalar>();
    Commands<Scalar> u{};
    REQUIRE(pinnquad::inverse_commands(vehicle, state, wanted, Scalar(1), u) == Status::ok);
    bool clipped = false;
    for (const Scalar command : u) clipped = clipped || command < Scalar(0) || command > Scalar(1);
    if (clipped) continue;
    ++compared;
    const Accelerations<Scalar> made = vehicle.evaluate(state, u, Scalar(1)).motion;
    // thrust acts along z only; the lateral acceleration is what it is
    CHECK(std::fabs(static_cast<double>(made.linear_m_s2[2] - wanted.linear_m_s2[2])) <=
          50.0 * flight_tolerance<Scalar>);
    CHECK(pinnquad::test::distance(made.angular_rad_s2, wanted.angular_rad_s2) <= 50.0 * flight_tolerance<Scalar>);
  }
  CHECK(compared > 10);
}

TEST_CASE_TEMPLATE("commands are not clipped: they say how far beyond its limit a rotor would have to go", Scalar,
                   float, double) {
  const Quadrotor<Scalar> vehicle(pinnquad::PaperQuadrotor::value<Scalar>());
  Accelerations<Scalar> motion;
  motion.linear_m_s2[2] = Scalar(-30);
  Commands<Scalar> u{};
  REQUIRE(pinnquad::inverse_commands(vehicle, State<Scalar>{}, motion, Scalar(0), u) == Status::ok);
  for (const Scalar command : u) CHECK(command > Scalar(1));
  motion.linear_m_s2[2] = Scalar(20);
  REQUIRE(pinnquad::inverse_commands(vehicle, State<Scalar>{}, motion, Scalar(0), u) == Status::ok);
  for (const Scalar command : u) CHECK(command < Scalar(0));
}

TEST_CASE_TEMPLATE("not_finite: every input, and the commands stay", Scalar, float, double) {
  const Airborne<Scalar> vehicle = airborne<Scalar>();
  const Commands<Scalar> before{Scalar(1), Scalar(2), Scalar(3), Scalar(4)};
  RandomStates random(104);
  const State<Scalar> good = random.state<Scalar>();
  const auto refuses = [&](const State<Scalar>& state, const Accelerations<Scalar>& motion, Scalar time) {
    Commands<Scalar> u = before;
    CHECK(pinnquad::inverse_commands(vehicle, state, motion, time, u) == Status::not_finite);
    CHECK(u == before);
  };
  using pinnquad::test::with_each_number_bad;
  with_each_number_bad<Scalar>(good, [&](const State<Scalar>& state) { refuses(state, {}, Scalar(0)); });
  with_each_number_bad<Scalar>(Accelerations<Scalar>{},
                               [&](const Accelerations<Scalar>& motion) { refuses(good, motion, Scalar(0)); });
  for (const Scalar bad : pinnquad::test::no_numbers<Scalar>) refuses(good, {}, bad);
}

TEST_CASE_TEMPLATE("a motion beyond all numbers is refused and the commands stay", Scalar, float, double) {
  const Quadrotor<Scalar> vehicle(pinnquad::PaperQuadrotor::value<Scalar>());
  Accelerations<Scalar> motion;
  motion.linear_m_s2[2] = std::numeric_limits<Scalar>::max();
  const Commands<Scalar> before{Scalar(1), Scalar(2), Scalar(3), Scalar(4)};
  Commands<Scalar> u = before;
  CHECK(pinnquad::inverse_commands(vehicle, State<Scalar>{}, motion, Scalar(0), u) == Status::output_not_finite);
  CHECK(u == before);
}

TEST_CASE_TEMPLATE("a vehicle or an attitude that can't be inverted is refused", Scalar, float, double) {
  const Commands<Scalar> before{Scalar(1), Scalar(2), Scalar(3), Scalar(4)};
  pinnquad::Airframe<Scalar> flat = pinnquad::PaperQuadrotor::value<Scalar>();
  for (auto& rotor : flat.rotors) rotor.y_m = Scalar(0);
  Commands<Scalar> u = before;
  CHECK(pinnquad::inverse_commands(Quadrotor<Scalar>(flat), State<Scalar>{}, Accelerations<Scalar>{}, Scalar(0), u) ==
        Status::no_solution);
  CHECK(u == before);
  State<Scalar> twice;
  twice.attitude.w = Scalar(2);
  u = before;
  CHECK(pinnquad::inverse_commands(Quadrotor<Scalar>(pinnquad::PaperQuadrotor::value<Scalar>()), twice,
                                   Accelerations<Scalar>{}, Scalar(0), u) == Status::not_unit_quaternion);
  CHECK(u == before);
}

TEST_CASE_TEMPLATE("almost without thrust in ground effect there still is a solution", Scalar, float, double) {
  RandomStates random(105);
  const NearGround<Scalar> vehicle = near_ground<Scalar>();
  for (int draw = 0; draw < draws; ++draw) {
    State<Scalar> state = random.state<Scalar>();
    state.position_m[2] = Scalar(0.877) - random.scalar<Scalar>(0.05, 1.5);
    state.attitude = {};
    const Scalar u = random.scalar<Scalar>(0.0, 1e-3);
    CHECK(round_trip<Scalar>(vehicle, state, {u, u, u, u}, Scalar(0)) <= ground_effect_tolerance<Scalar>);
  }
}

TEST_CASE_TEMPLATE("commands -> motion -> commands: rotor drag tilts what ground effect sees, of one ratio or by rotor",
                   Scalar, float, double) {
  using pinnquad::Conyers, pinnquad::QuadraticDrag, pinnquad::RotorDrag;
  const pinnquad::Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  const auto site = pinnquad::paper_site<Scalar>();
  RandomStates random(107);
  const Quadrotor<Scalar, QuadraticDrag, RotorDrag, pinnquad::GroundEffect<Conyers>> one_ratio(airframe, site);
  const Quadrotor<Scalar, pinnquad::StandardAtmosphere, QuadraticDrag, RotorDrag, pinnquad::RotorGroundEffect<Conyers>>
      by_rotor(airframe, site);
  for (int draw = 0; draw < draws; ++draw) {
    State<Scalar> state = random.state<Scalar>();
    state.position_m[2] = Scalar(0.877) - random.scalar<Scalar>(0.3, 1.5);
    const Commands<Scalar> u = random.commands<Scalar>();
    CHECK(round_trip(one_ratio, state, u, Scalar(0)) <= ground_effect_tolerance<Scalar>);
    CHECK(round_trip(by_rotor, state, u, Scalar(0)) <= ground_effect_tolerance<Scalar>);
  }
}

TEST_CASE_TEMPLATE("commands -> motion -> commands: rotors that feel the air and each other, a weak one, legs, a load",
                   Scalar, float, double) {
  using Vehicle = Quadrotor<Scalar, pinnquad::StandardAtmosphere, pinnquad::Battery, pinnquad::QuadraticDrag,
                            pinnquad::RotorDrag, pinnquad::Inflow, pinnquad::BladeFlapping, pinnquad::Wake,
                            pinnquad::RotorFault, pinnquad::GroundContact, pinnquad::Payload>;
  RandomStates random(109);
  const Vehicle vehicle(pinnquad::PaperQuadrotor::value<Scalar>(), pinnquad::paper_site<Scalar>(), {},
                        pinnquad::Battery{4, 5.0, 0.3}, {}, {}, {}, {}, {}, {3, 0.8, 0.0}, {}, {0.3, 0.0});
  REQUIRE(vehicle.status() == Status::ok);
  for (int draw = 0; draw < draws; ++draw) {
    State<Scalar> state = random.state<Scalar>();
    if (draw % 4 == 0) state.position_m[2] = Scalar(0.877) - random.scalar<Scalar>(0.1, 0.4);
    const Scalar time_s = random.scalar<Scalar>(0.0, 600.0);
    // the ground pushes with many weights, of which the rotors are a small difference
    CHECK(round_trip(vehicle, state, random.commands<Scalar>(), time_s) <= 10 * ground_effect_tolerance<Scalar>);
  }
}

namespace {
/// Sinking fast right above the pole: drag holds more than the rotors, so both branches can be flown.
struct BesideThePole {
  State<double> state;
  Quadrotor<double, pinnquad::StandardAtmosphere, pinnquad::QuadraticDrag, pinnquad::test::SimulatorGroundEffect>
      vehicle;
  double ratio;

  BesideThePole()
      : vehicle(pinnquad::PaperQuadrotor::value<double>(), pinnquad::paper_site<double>(),
                pinnquad::StandardAtmosphere{}, pinnquad::QuadraticDrag{}, pinnquad::test::SimulatorGroundEffect{}),
        ratio(pinnquad::test::SimulatorCheesemanBennett{}.thrust_ratio(0.30, vehicle.airframe())) {
    state.position_m[2] = 0.877 - 0.30 * 0.1143;
    state.velocity_m_s[2] = -9.0;  // climbing: drag pushes down
  }
};
}  // namespace

TEST_CASE("beyond the gain of 1 a wanted force has two solutions: the one with the greater thrust is returned") {
  const BesideThePole point;
  REQUIRE(point.ratio > 2.0);
  // little thrust: drag (down) outweighs it, |F_z| falls as thrust grows: the lower branch
  const Commands<double> little{0.05, 0.05, 0.05, 0.05};
  const Accelerations<double> motion = point.vehicle.evaluate(point.state, little, 0.0).motion;
  Commands<double> u{};
  REQUIRE(pinnquad::inverse_commands(point.vehicle, point.state, motion, 0.0, u) == Status::ok);
  CHECK(u[0] > 0.1);  // another solution, and
  const Accelerations<double> again = point.vehicle.evaluate(point.state, u, 0.0).motion;
  CHECK(again.linear_m_s2[2] == doctest::Approx(motion.linear_m_s2[2]).epsilon(1e-12));  // as right a one
  // on the upper branch the commands themselves come back
  const Commands<double> much{0.8, 0.7, 0.75, 0.85};
  CHECK(round_trip(point.vehicle, point.state, much, 0.0) <= ground_effect_tolerance<double>);
}

TEST_CASE("beyond the gain of 1 there is a least force: less has no solution, and the commands stay") {
  const BesideThePole point;
  // where |F_z| is 0 the force is least: thrust equals drag, and gravity and drag remain
  const double drag_N = 0.1099301 * point.vehicle.surroundings(point.state, 0.0).air_density_kg_m3 * 81.0;
  Accelerations<double> least;
  least.linear_m_s2[2] = 9.80665 + (drag_N - drag_N) / 1.5;
  Commands<double> u{};
  CHECK(pinnquad::inverse_commands(point.vehicle, point.state, least, 0.0, u) == Status::ok);
  const Commands<double> before = u;
  least.linear_m_s2[2] += 0.5;
  CHECK(pinnquad::inverse_commands(point.vehicle, point.state, least, 0.0, u) == Status::no_solution);
  CHECK(u == before);
}
