// SPDX-License-Identifier: MIT
// Laws that hold for the whole vehicle, with and without effects, in float and double.
#include "pinnquad/vehicle/quadrotor.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"
#include "pinnquad/vehicle/inverse.hpp"
#include "support/numbers_of.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"

using pinnquad::Airframe;
using pinnquad::Commands;
using pinnquad::Quadrotor;
using pinnquad::Quaternion;
using pinnquad::Site;
using pinnquad::State;
using pinnquad::Status;
using pinnquad::Vector3;
using pinnquad::VehicleState;
using pinnquad::test::distance;
using pinnquad::test::draws;
using pinnquad::test::evaluation_tolerance;
using pinnquad::test::RandomStates;

namespace {

/// Accelerations of agile flight reach 100 m/s^2 and rad/s^2; rounding scales with them.
constexpr double largest_acceleration = 100.0;

template <class Scalar>
using Bare = Quadrotor<Scalar>;
template <class Scalar>
using Full = Quadrotor<Scalar, pinnquad::StandardAtmosphere, pinnquad::ConstantWind, pinnquad::QuadraticDrag,
                       pinnquad::GroundEffect<pinnquad::CheesemanBennett>>;

template <class Scalar>
Full<Scalar> full_vehicle(const std::array<double, 3>& wind) {
  return Full<Scalar>(pinnquad::PaperQuadrotor::value<Scalar>(), pinnquad::paper_site<Scalar>(),
                      pinnquad::StandardAtmosphere{}, pinnquad::ConstantWind{wind}, pinnquad::QuadraticDrag{},
                      pinnquad::GroundEffect<pinnquad::CheesemanBennett>{});
}

/// A state low enough for ground effect, not next to its pole.
template <class Scalar>
State<Scalar> low_state(RandomStates& random) {
  State<Scalar> state = random.state<Scalar>();
  state.position_m[2] = random.scalar<Scalar>(-1.0, 0.82);
  return state;
}

template <class Scalar>
Commands<Scalar> hover_commands(const Airframe<Scalar>& airframe, Scalar density_ratio) {
  const Scalar u = Scalar(1) / (airframe.thrust_to_weight() * density_ratio);
  return {u, u, u, u};
}

}  // namespace

TEST_CASE_TEMPLATE("hover balances weight: level, any heading, any place", Scalar, float, double) {
  RandomStates random(90);
  const Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  const Quadrotor<Scalar, pinnquad::StandardAtmosphere, pinnquad::QuadraticDrag> vehicle(
      airframe, pinnquad::paper_site<Scalar>(), pinnquad::StandardAtmosphere{}, pinnquad::QuadraticDrag{});
  for (int draw = 0; draw < draws; ++draw) {
    State<Scalar> state;
    state.position_m = random.vector<Scalar>(100.0);
    state.attitude = pinnquad::from_euler<Scalar>({Scalar(0), Scalar(0), random.scalar<Scalar>(-3.1, 3.1)});
    const Scalar ratio = vehicle.rotor_scale(vehicle.surroundings(state, Scalar(0)));
    const auto result = vehicle.evaluate(state, hover_commands(airframe, ratio), Scalar(0));
    CHECK(pinnquad::test::norm(result.motion.linear_m_s2) <= 10.0 * evaluation_tolerance<Scalar>);
    CHECK(pinnquad::test::norm(result.motion.angular_rad_s2) <= largest_acceleration * evaluation_tolerance<Scalar>);
  }
}

TEST_CASE("the reference vehicle hovers at command 0.8903 at 122 m") {
  const double printed_digits = 1e-6;
  const Airframe<double> airframe = pinnquad::ReferenceQuadrotor15::value<double>();
  const double ratio =
      pinnquad::standard_atmosphere_density_kg_m3(122.0) / pinnquad::standard_air_density_kg_m3<double>;
  CHECK(hover_commands(airframe, ratio)[0] == doctest::Approx(0.890280278).epsilon(printed_digits));
  CHECK(hover_commands(airframe, 1.0)[0] == doctest::Approx(0.879899853).epsilon(printed_digits));
}

TEST_CASE_TEMPLATE("mirror symmetry: left becomes right", Scalar, float, double) {
  RandomStates random(91);
  for (int draw = 0; draw < draws; ++draw) {
    const State<Scalar> state = low_state<Scalar>(random);
    const Commands<Scalar> u = random.commands<Scalar>(-0.2, 1.2);
    const std::array<double, 3> wind{random.scalar<double>(-5, 5), random.scalar<double>(-5, 5),
                                     random.scalar<double>(-1, 1)};

    State<Scalar> mirrored = state;
    mirrored.position_m[1] = -state.position_m[1];
    mirrored.velocity_m_s[1] = -state.velocity_m_s[1];
    mirrored.attitude = {state.attitude.w, -state.attitude.x, state.attitude.y, -state.attitude.z};
    mirrored.body_rates_rad_s[0] = -state.body_rates_rad_s[0];
    mirrored.body_rates_rad_s[2] = -state.body_rates_rad_s[2];
    const Commands<Scalar> swapped{u[2], u[3], u[0], u[1]};  // right with left, front and rear as they are

    const auto a = full_vehicle<Scalar>(wind).evaluate(state, u, Scalar(0));
    const auto b = full_vehicle<Scalar>({wind[0], -wind[1], wind[2]}).evaluate(mirrored, swapped, Scalar(0));
    const Vector3<Scalar> linear(b.motion.linear_m_s2[0], -b.motion.linear_m_s2[1], b.motion.linear_m_s2[2]);
    const Vector3<Scalar> angular(-b.motion.angular_rad_s2[0], b.motion.angular_rad_s2[1], -b.motion.angular_rad_s2[2]);
    CHECK(distance(a.motion.linear_m_s2, linear) <= largest_acceleration * evaluation_tolerance<Scalar>);
    CHECK(distance(a.motion.angular_rad_s2, angular) <= 10.0 * largest_acceleration * evaluation_tolerance<Scalar>);
  }
}

TEST_CASE_TEMPLATE("yaw invariance: north is no special direction", Scalar, float, double) {
  RandomStates random(92);
  for (int draw = 0; draw < draws; ++draw) {
    const State<Scalar> state = low_state<Scalar>(random);
    const Commands<Scalar> u = random.commands<Scalar>();
    const Vector3<double> wind = random.vector<double>(5.0);
    const double yaw = random.scalar<double>(-3.1, 3.1);
    const Quaternion<double> turn = pinnquad::from_euler<double>({0.0, 0.0, yaw});
    const Vector3<double> turned_wind = pinnquad::body_to_world(turn, wind);

    State<Scalar> turned = state;
    const Quaternion<Scalar> turn_s{Scalar(turn.w), Scalar(turn.x), Scalar(turn.y), Scalar(turn.z)};
    turned.attitude = turn_s * state.attitude;
    turned.velocity_m_s = pinnquad::body_to_world(turn_s, state.velocity_m_s);
    turned.position_m = pinnquad::body_to_world(turn_s, state.position_m);
    turned.position_m[2] = state.position_m[2];

    const auto a = full_vehicle<Scalar>({wind[0], wind[1], wind[2]}).evaluate(state, u, Scalar(0));
    const auto b =
        full_vehicle<Scalar>({turned_wind[0], turned_wind[1], turned_wind[2]}).evaluate(turned, u, Scalar(0));
    CHECK(distance(a.motion.linear_m_s2, b.motion.linear_m_s2) <= largest_acceleration * evaluation_tolerance<Scalar>);
    CHECK(distance(a.motion.angular_rad_s2, b.motion.angular_rad_s2) <=
          largest_acceleration * evaluation_tolerance<Scalar>);
  }
}

TEST_CASE_TEMPLATE("Galileo: flying with the wind is standing still in still air", Scalar, float, double) {
  RandomStates random(93);
  for (int draw = 0; draw < draws; ++draw) {
    const State<Scalar> still = low_state<Scalar>(random);
    const Commands<Scalar> u = random.commands<Scalar>();
    const std::array<double, 3> wind{4.0, -3.0, 1.0};
    State<Scalar> carried = still;
    carried.velocity_m_s += Vector3<Scalar>(4, -3, 1);
    const auto a = full_vehicle<Scalar>({0, 0, 0}).evaluate(still, u, Scalar(0));
    const auto b = full_vehicle<Scalar>(wind).evaluate(carried, u, Scalar(0));
    CHECK(distance(pinnquad::world_acceleration(still, a.motion.linear_m_s2),
                   pinnquad::world_acceleration(carried, b.motion.linear_m_s2)) <=
          largest_acceleration * evaluation_tolerance<Scalar>);
  }
}

TEST_CASE_TEMPLATE("the parts of an evaluation add up to its motion", Scalar, float, double) {
  RandomStates random(94);
  const Full<Scalar> vehicle = full_vehicle<Scalar>({2.0, -1.0, 0.5});
  for (int draw = 0; draw < draws; ++draw) {
    const State<Scalar> state = low_state<Scalar>(random);
    const auto result = vehicle.evaluate(state, random.commands<Scalar>(-0.3, 1.3), Scalar(0));
    const pinnquad::Accelerations<Scalar> motion = pinnquad::accelerations(
        vehicle.airframe(), state, result.rotors + result.aerodynamic, vehicle.site().gravity_m_s2);
    CHECK(motion.linear_m_s2 == result.motion.linear_m_s2);
    CHECK(motion.angular_rad_s2 == result.motion.angular_rad_s2);
    CHECK(result.surroundings.wind_m_s == Vector3<Scalar>(Scalar(2), Scalar(-1), Scalar(0.5)));
    CHECK(result.surroundings.altitude_m == Scalar(122) - state.position_m[2]);
    CHECK(result.rotors.force_N[0] == Scalar(0));
    CHECK(result.rotors.force_N[2] <= Scalar(0));
  }
}

TEST_CASE("evaluate clips the rotors and has no lag") {
  const Bare<double> vehicle(pinnquad::PaperQuadrotor::value<double>());
  const auto outside = vehicle.evaluate({}, {1.7, -0.4, 0.5, 1.0}, 0.0);
  const auto limits = vehicle.evaluate({}, {1.0, 0.0, 0.5, 1.0}, 0.0);
  CHECK(outside.rotors.force_N == limits.rotors.force_N);
  CHECK(outside.rotors.torque_N_m == limits.rotors.torque_N_m);
  CHECK(-limits.rotors.force_N[2] ==
        doctest::Approx(2.5 * pinnquad::PaperQuadrotor::value<double>().max_rotor_thrust_N()));
}

namespace {
/// Effects that leave a trace: they show in which order the vehicle calls them, and with what.
struct AddsWrench {
  double newton;
  template <class Scalar>
  pinnquad::Wrench<Scalar> wrench(const pinnquad::AeroCondition<Scalar>&, const Airframe<Scalar>&) const noexcept {
    pinnquad::Wrench<Scalar> result;
    result.force_N[0] = Scalar(newton);
    result.torque_N_m[1] = Scalar(newton);
    return result;
  }
};
struct DoublesWrenchSoFar {
  template <class Scalar>
  pinnquad::Wrench<Scalar> wrench(const pinnquad::AeroCondition<Scalar>& condition,
                                  const Airframe<Scalar>&) const noexcept {
    return condition.aerodynamic;
  }
};
struct ShowsCondition {
  pinnquad::RotorCondition<double>* seen;
  template <class Scalar>
  pinnquad::Wrench<Scalar> wrench(const pinnquad::RotorCondition<Scalar>& condition,
                                  const Airframe<Scalar>&) const noexcept {
    *seen = condition;
    return {};
  }
};

/// Takes either condition and so is given the one without rotors.
struct ShowsSize {
  std::size_t* seen;
  template <class Condition, class Scalar>
  pinnquad::Wrench<Scalar> wrench(const Condition& condition, const Airframe<Scalar>&) const noexcept {
    *seen = sizeof condition;
    return {};
  }
};
}  // namespace

TEST_CASE("effects fold in order: each sees the wrench so far") {
  const Airframe<double> airframe = pinnquad::PaperQuadrotor::value<double>();
  const Quadrotor<double, AddsWrench, DoublesWrenchSoFar> first(airframe, Site<double>{}, AddsWrench{3.0},
                                                                DoublesWrenchSoFar{});
  const Quadrotor<double, DoublesWrenchSoFar, AddsWrench> last(airframe, Site<double>{}, DoublesWrenchSoFar{},
                                                               AddsWrench{3.0});
  CHECK(first.evaluate({}, {}, 0.0).aerodynamic.force_N[0] == 6.0);
  CHECK(first.evaluate({}, {}, 0.0).aerodynamic.torque_N_m[1] == 6.0);
  CHECK(last.evaluate({}, {}, 0.0).aerodynamic.force_N[0] == 3.0);
}

TEST_CASE("surroundings run before every wrench, whatever the order of the list") {
  const Airframe<double> airframe = pinnquad::PaperQuadrotor::value<double>();
  const Quadrotor<double, pinnquad::QuadraticDrag, pinnquad::ConstantWind> drag_first(
      airframe, Site<double>{}, pinnquad::QuadraticDrag{}, pinnquad::ConstantWind{{5.0, 0.0, 0.0}});
  CHECK(drag_first.evaluate({}, {}, 0.0).aerodynamic.force_N[0] > 0.1);
}

TEST_CASE("what an effect is given") {
  pinnquad::RotorCondition<double> seen;
  const Airframe<double> airframe = pinnquad::PaperQuadrotor::value<double>();
  const Quadrotor<double, pinnquad::ConstantWind, pinnquad::StandardAtmosphere, ShowsCondition> vehicle(
      airframe, pinnquad::paper_site<double>(), pinnquad::ConstantWind{{1.0, 2.0, 3.0}}, pinnquad::StandardAtmosphere{},
      ShowsCondition{&seen});
  RandomStates random(95);
  State<double> state = random.state<double>();
  const auto result = vehicle.evaluate(state, {0.4, 0.5, 0.6, 0.7}, 12.5);
  const Vector3<double> relative = state.velocity_m_s - Vector3<double>(1, 2, 3);
  CHECK(distance(seen.air_relative_velocity_m_s, pinnquad::world_to_body<double>(state.attitude, relative)) <=
        evaluation_tolerance<double>);
  CHECK(seen.body_rates_rad_s == state.body_rates_rad_s);
  CHECK(pinnquad::test::components(seen.attitude) == pinnquad::test::components(state.attitude));
  CHECK(seen.height_above_ground_m == 0.877 - state.position_m[2]);
  CHECK(seen.air_density_kg_m3 == pinnquad::standard_atmosphere_density_kg_m3(122.0 - state.position_m[2]));
  CHECK(seen.time_s == 12.5);
  CHECK(seen.rotors.force_N == result.rotors.force_N);
  CHECK(seen.rotors.torque_N_m == result.rotors.torque_N_m);

  std::size_t undeclared = 0;
  const Quadrotor<double, ShowsSize> other(airframe, pinnquad::paper_site<double>(), ShowsSize{&undeclared});
  static_cast<void>(other.evaluate(state, {0.4, 0.5, 0.6, 0.7}, 12.5));
  CHECK(undeclared == sizeof(pinnquad::AeroCondition<double>));
  static_assert(!pinnquad::uses_rotor_wrench<ShowsSize> && pinnquad::uses_rotor_wrench<ShowsCondition>);
}

/// Takes a tenth of the thrust of all rotors, and only where it is bound.
struct TenthLost {
  struct Bound {
    template <class Scalar>
    pinnquad::Wrench<Scalar> wrench(const pinnquad::RotorCondition<Scalar>& condition,
                                    const Airframe<Scalar>& /*airframe*/) const noexcept {
      return {condition.rotors.force_N * Scalar(-0.1), condition.rotors.torque_N_m * Scalar(-0.1)};
    }
  };
  template <class Scalar>
  Bound bound(const Airframe<Scalar>& /*airframe*/) const noexcept {
    return {};
  }
};

TEST_CASE("an effect that makes its wrench where it is bound acts, and the inverse knows it") {
  const Quadrotor<double, TenthLost> vehicle(pinnquad::PaperQuadrotor::value<double>());
  const Commands<double> commands{0.4, 0.5, 0.6, 0.7};
  const auto flown = vehicle.evaluate({}, commands, 0);
  CHECK(distance(flown.aerodynamic.force_N, Vector3<double>(flown.rotors.force_N * -0.1)) <= 1e-15);
  Commands<double> back{};
  CHECK(pinnquad::inverse_commands(vehicle, {}, flown.motion, 0.0, back) == Status::ok);
  for (std::size_t i = 0; i < back.size(); ++i) CHECK(back[i] == doctest::Approx(commands[i]));
  static_assert(pinnquad::uses_rotor_wrench<TenthLost> && !pinnquad::changes_surroundings<TenthLost>);
}

// In time

TEST_CASE("effects that are not given are those of the defaults") {
  const Airframe<double> airframe = pinnquad::PaperQuadrotor::value<double>();
  using Vehicle = Quadrotor<double, pinnquad::PeriodicWind, pinnquad::QuadraticDrag>;
  const Vehicle given(airframe, pinnquad::paper_site<double>(), pinnquad::PeriodicWind{}, pinnquad::QuadraticDrag{});
  const Vehicle implied(airframe, pinnquad::paper_site<double>());
  CHECK(implied.site().elevation_m == 122.0);
  CHECK(given.evaluate({}, {}, 3.0).aerodynamic.force_N == implied.evaluate({}, {}, 3.0).aerodynamic.force_N);
  CHECK(implied.evaluate({}, {}, 3.0).surroundings.wind_m_s[0] ==
        doctest::Approx(2.5 * std::sin(0.6 * 3.14159265358979) + 2.5));
}

TEST_CASE("step is of fourth order with drag, density, wind and rotor lag") {
  // no deadband and axes that keep their sign: the dynamics is smooth; lag of 20 ms
  Airframe<double> airframe = pinnquad::PaperQuadrotor::value<double>();
  airframe.drag_deadband_m_s = 0.0;
  airframe.rotor_time_constant_s = 0.02;
  using Vehicle = Quadrotor<double, pinnquad::StandardAtmosphere, pinnquad::PeriodicWind, pinnquad::QuadraticDrag>;
  const Vehicle vehicle(airframe, pinnquad::paper_site<double>(), pinnquad::StandardAtmosphere{},
                        pinnquad::PeriodicWind{{0.0, 1.0, 0.0}, -4.0, 2.0, 0.5}, pinnquad::QuadraticDrag{});
  VehicleState<double> start;
  start.body.velocity_m_s = {6.0, 5.0, 4.0};
  start.body.attitude = pinnquad::from_euler<double>({0.1, -0.2, 0.3});
  start.body.body_rates_rad_s = {1.0, -2.0, 0.5};
  start.rotors = {0.3, 0.4, 0.5, 0.6};
  start.time_s = 0.07;
  const Commands<double> u{0.60, 0.55, 0.62, 0.56};
  const auto fly = [&](int steps) {
    VehicleState<double> state = start;
    for (int i = 0; i < steps; ++i) REQUIRE(vehicle.step(state, u, 0.2 / steps) == Status::ok);
    return state;
  };
  const State<double> exact = fly(1280).body, coarse = fly(40).body, fine = fly(80).body;
  const auto check = [](double ratio) {
    CHECK(ratio > 13.0);
    CHECK(ratio < 19.5);
  };
  using pinnquad::test::components;
  check(distance(coarse.position_m, exact.position_m) / distance(fine.position_m, exact.position_m));
  check(distance(coarse.velocity_m_s, exact.velocity_m_s) / distance(fine.velocity_m_s, exact.velocity_m_s));
  check(distance(components(coarse.attitude), components(exact.attitude)) /
        distance(components(fine.attitude), components(exact.attitude)));
  check(distance(coarse.body_rates_rad_s, exact.body_rates_rad_s) /
        distance(fine.body_rates_rad_s, exact.body_rates_rad_s));
}

TEST_CASE_TEMPLATE("the rotor lag of a step is exact, however long the step", Scalar, float, double) {
  const Bare<Scalar> vehicle(pinnquad::PaperQuadrotor::value<Scalar>());
  for (const double step : {0.0005, 0.005, 0.05}) {
    VehicleState<Scalar> state;
    state.rotors = {Scalar(0.1), Scalar(0.9), Scalar(0.5), Scalar(0.2)};
    const Commands<Scalar> u{Scalar(0.7), Scalar(0.2), Scalar(1.4), Scalar(-0.4)};
    const double start[4] = {0.1, 0.9, 0.5, 0.2}, target[4] = {0.7, 0.2, 1.0, 0.0};
    REQUIRE(vehicle.step(state, u, Scalar(step)) == Status::ok);
    for (std::size_t i = 0; i < 4; ++i) {
      const double exact = target[i] + (start[i] - target[i]) * std::exp(-step / 0.005);
      CHECK(std::fabs(static_cast<double>(state.rotors[i]) - exact) <= pinnquad::test::rounding<Scalar>(16));
    }
    CHECK(state.time_s == Scalar(step));
  }
}

TEST_CASE("a thrust that grows with the lag: closed form of speed and height") {
  // level, no drag: m v_dot = m g - 4 T_max u_f(t), u_f = u (1 - exp(-t / tau))
  const Airframe<double> airframe = pinnquad::PaperQuadrotor::value<double>();
  const Bare<double> vehicle(airframe);
  VehicleState<double> state;
  const double u = 0.8, h = 0.001, g = 9.80665, tau = 0.005,
               a = 4.0 * u * airframe.max_rotor_thrust_N() / airframe.mass_kg;
  for (int i = 0; i < 50; ++i) REQUIRE(vehicle.step(state, {u, u, u, u}, h) == Status::ok);
  const double t = 50 * h, e = std::exp(-t / tau);
  const double rk4_tolerance =
      1e-6;  // Simpson's rule on the exponential: a h (h / tau)^4 / 2880 in each of the first steps
  CHECK(std::fabs(state.body.velocity_m_s[2] - (g * t - a * (t - tau * (1 - e)))) <= rk4_tolerance);
  CHECK(std::fabs(state.body.position_m[2] - (g * t * t / 2 - a * (t * t / 2 - tau * (t - tau * (1 - e))))) <=
        rk4_tolerance);
}

TEST_CASE_TEMPLATE("without thrust, air and torque: energy and angular momentum are kept while falling", Scalar, float,
                   double) {
  const Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  const Bare<Scalar> vehicle(airframe);
  const Vector3<Scalar> inertia = pinnquad::to_vector(airframe.inertia_kg_m2);
  const double tolerance =
      sizeof(Scalar) == 4 ? pinnquad::test::rounding<float>(1000) : 1e-10;  // 500 steps of rounding; truncation
  RandomStates random(96);
  for (int draw = 0; draw < 10; ++draw) {
    VehicleState<Scalar> state;
    state.body = random.state<Scalar>();
    const auto energy = [&](const State<Scalar>& s) {
      const double spin = static_cast<double>(s.body_rates_rad_s.dot(inertia.cwiseProduct(s.body_rates_rad_s))) / 2.0;
      const double speed = static_cast<double>(s.velocity_m_s.squaredNorm()) * 1.5 / 2.0;
      return spin + speed - 1.5 * 9.80665 * static_cast<double>(s.position_m[2]);
    };
    const auto momentum = [&](const State<Scalar>& s) {
      return pinnquad::body_to_world<Scalar>(s.attitude, inertia.cwiseProduct(s.body_rates_rad_s));
    };
    const State<Scalar> start = state.body;
    for (int i = 0; i < 500; ++i) REQUIRE(vehicle.step(state, {}, Scalar(0.001)) == Status::ok);
    CHECK(distance(state.body.velocity_m_s, start.velocity_m_s) == doctest::Approx(9.80665 * 0.5).epsilon(1e-4));
    CHECK(std::fabs(energy(state.body) / energy(start) - 1.0) <= tolerance);
    CHECK(pinnquad::test::relative_distance(momentum(state.body), momentum(start)) <= tolerance);
  }
}

TEST_CASE("terminal velocity: v = v_t tanh(g t / v_t), v_t = sqrt(m g / (k rho))") {
  Airframe<double> airframe = pinnquad::PaperQuadrotor::value<double>();
  airframe.drag_deadband_m_s = 0.0;
  const Quadrotor<double, pinnquad::QuadraticDrag> vehicle(airframe, Site<double>{}, pinnquad::QuadraticDrag{});
  const double rho = pinnquad::standard_air_density_kg_m3<double>, g = 9.80665;
  const double terminal = std::sqrt(1.5 * g / (0.1099301 * rho));
  const double rk4_tolerance = 2e-9;  // 10 ms steps
  VehicleState<double> state;
  for (int i = 1; i <= 600; ++i) {
    REQUIRE(vehicle.step(state, {}, 0.01) == Status::ok);
    if (i % 100 == 0) {
      CHECK(std::fabs(state.body.velocity_m_s[2] - terminal * std::tanh(g * 0.01 * i / terminal)) <= rk4_tolerance);
      CHECK(std::fabs(state.body.position_m[2] -
                      terminal * terminal / g * std::log(std::cosh(g * 0.01 * i / terminal))) <= 10 * rk4_tolerance);
    }
  }
}

TEST_CASE_TEMPLATE("coasting: 8 m/s becomes 7.0244 m/s after 4 s, as 1 / (1 / v + k rho t / m)", Scalar, float,
                   double) {
  const Airframe<Scalar> airframe = pinnquad::ReferenceQuadrotor15::value<Scalar>();
  const Quadrotor<Scalar, pinnquad::StandardAtmosphere, pinnquad::QuadraticDrag> vehicle(
      airframe, pinnquad::paper_site<Scalar>(), pinnquad::StandardAtmosphere{}, pinnquad::QuadraticDrag{});
  VehicleState<Scalar> state;
  state.body.position_m[2] = Scalar(-10);
  state.body.velocity_m_s[0] = Scalar(8);
  const Commands<Scalar> hover =
      hover_commands(airframe, vehicle.rotor_scale(vehicle.surroundings(state.body, Scalar(0))));
  state.rotors = hover;
  for (int i = 0; i < 1000; ++i) REQUIRE(vehicle.step(state, hover, Scalar(0.004)) == Status::ok);
  const double speed = static_cast<double>(state.body.velocity_m_s[0]);
  // the simulator's first step takes half the deceleration: 0.5 ms of 0.28 m/s^2
  const double first_step = 0.5e-3 * 0.28;
  CHECK(std::fabs(speed - 7.02437) <= first_step);
  const double closed_form = 8.0 / (1.0 + 8.0 * 4.0 * 0.00538309224 * 1.209551206943 / 1.5);
  CHECK(speed ==
        doctest::Approx(closed_form).epsilon(sizeof(Scalar) == 4 ? pinnquad::test::rounding<float>(500) : 1e-7));
  CHECK(std::fabs(static_cast<double>(state.body.velocity_m_s[2])) <= 1e-3);  // it neither climbs nor sinks
}

// Bad input

TEST_CASE_TEMPLATE("a bad input returns not_finite and leaves the state untouched", Scalar, float, double) {
  const Full<Scalar> vehicle = full_vehicle<Scalar>({1.0, 0.0, 0.0});
  RandomStates random(97);
  VehicleState<Scalar> good;
  good.body = random.state<Scalar>();
  good.rotors = random.commands<Scalar>();
  const auto refuses = [&](const VehicleState<Scalar>& bad, const Commands<Scalar>& u, Scalar step) {
    VehicleState<Scalar> state;
    std::memcpy(static_cast<void*>(&state), &bad, sizeof state);  // padding too: bytes are compared below
    CHECK(vehicle.step(state, u, step) == Status::not_finite);
    CHECK(std::memcmp(&state, &bad, sizeof state) == 0);  // NaN does not equal itself
  };
  VehicleState<Scalar> state = good;
  const auto refuses_it = [&](const auto&) { refuses(state, {}, Scalar(0.001)); };
  const auto each_bad = [&](auto& part) {
    for (Scalar* const number : pinnquad::test::numbers_of(part)) {
      const Scalar sound = *number;
      for (const Scalar bad : pinnquad::test::no_numbers<Scalar>) *number = bad, refuses_it(part);
      *number = sound;
    }
  };
  each_bad(state.body);
  each_bad(state.rotors);
  pinnquad::test::with_each_number_bad<Scalar>(Commands<Scalar>{},
                                               [&](const Commands<Scalar>& u) { refuses(good, u, Scalar(0.001)); });
  for (const Scalar bad : pinnquad::test::no_numbers<Scalar>) refuses(good, {}, bad);
  CHECK(vehicle.step(state, {}, Scalar(0.001)) == Status::ok);
}

TEST_CASE_TEMPLATE("a result that is not finite is refused and leaves the state untouched", Scalar, float, double) {
  const Quadrotor<Scalar, pinnquad::QuadraticDrag> vehicle(pinnquad::PaperQuadrotor::value<Scalar>(), Site<Scalar>{},
                                                           pinnquad::QuadraticDrag{});
  VehicleState<Scalar> start;
  start.body.velocity_m_s[0] = std::numeric_limits<Scalar>::max() / Scalar(4);
  VehicleState<Scalar> state;
  std::memcpy(static_cast<void*>(&state), &start, sizeof state);  // padding too: bytes are compared below
  CHECK(vehicle.step(state, {}, Scalar(0.01)) == Status::output_not_finite);
  CHECK(std::memcmp(&state, &start, sizeof state) == 0);
}

TEST_CASE_TEMPLATE("step refuses a time that is no number, a step backwards and an attitude that is none", Scalar,
                   float, double) {
  const Bare<Scalar> vehicle(pinnquad::PaperQuadrotor::value<Scalar>());
  VehicleState<Scalar> state;
  state.time_s = std::numeric_limits<double>::quiet_NaN();
  CHECK(vehicle.step(state, {}, Scalar(0.001)) == Status::not_finite);
  state = {};
  CHECK(vehicle.step(state, {}, Scalar(-0.001)) != Status::ok);
  state = {};
  state.body.attitude.w = Scalar(2);
  CHECK(vehicle.step(state, {}, Scalar(0.001)) == Status::not_unit_quaternion);
}

namespace {
/// Steps a copy of `start`; true if that is refused with `expected` and every byte of it stays.
template <class Vehicle, class Scalar>
bool refuses(const Vehicle& vehicle, const VehicleState<Scalar>& start, Scalar step_s, Status expected) {
  VehicleState<Scalar> state;
  std::memcpy(static_cast<void*>(&state), &start, sizeof state);
  const Status status = vehicle.step(state, {Scalar(0.5), Scalar(0.5), Scalar(0.5), Scalar(0.5)}, step_s);
  CAPTURE(pinnquad::to_string(status));
  CHECK(status == expected);
  return status == expected && std::memcmp(&state, &start, sizeof state) == 0;
}
}  // namespace

TEST_CASE_TEMPLATE("body rates that no step can follow are refused: the attitude stays a rotation", Scalar, float,
                   double) {
  const Bare<Scalar> vehicle(pinnquad::PaperQuadrotor::value<Scalar>());
  for (const double rate : {1e20, 1e10, -1e6, 3200.0}) {
    CAPTURE(rate);
    for (int axis = 0; axis < 3; ++axis) {
      VehicleState<Scalar> state;
      state.body.body_rates_rad_s[axis] = Scalar(rate);
      CHECK(refuses(vehicle, state, Scalar(0.001), Status::out_of_range));
    }
  }
  VehicleState<Scalar> fast;  // just under half a turn: flown, and still a rotation
  fast.body.body_rates_rad_s[2] = Scalar(3100);
  REQUIRE(vehicle.step(fast, {}, Scalar(0.001)) == Status::ok);
  CHECK(pinnquad::is_unit(fast.body.attitude));
}

namespace {
/// Torque without measure.
struct Spinner {
  double torque_N_m;
  template <class Scalar>
  pinnquad::Wrench<Scalar> wrench(const pinnquad::AeroCondition<Scalar>&, const Airframe<Scalar>&) const noexcept {
    pinnquad::Wrench<Scalar> result;
    result.torque_N_m[2] = Scalar(torque_N_m);
    return result;
  }
};
}  // namespace

TEST_CASE_TEMPLATE("a step that ends faster than it can follow, or as no rotation, is refused", Scalar, float, double) {
  const Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  using Vehicle = Quadrotor<Scalar, Spinner>;
  CHECK(refuses(Vehicle(airframe, {}, Spinner{1e6}), VehicleState<Scalar>{}, Scalar(0.001), Status::out_of_range));
  // the quaternion is finite but its square is not: normalised to zero
  const double beyond = sizeof(Scalar) == 4 ? 1e15 : 1e80;
  CHECK(refuses(Vehicle(airframe, {}, Spinner{beyond}), VehicleState<Scalar>{}, Scalar(0.001),
                Status::output_not_finite));
}

TEST_CASE_TEMPLATE("an airframe or a site that is none is refused, with its status", Scalar, float, double) {
  const Scalar nan = std::numeric_limits<Scalar>::quiet_NaN(), inf = std::numeric_limits<Scalar>::infinity();
  const auto refused = [](const Airframe<Scalar>& airframe, const Site<Scalar>& site, Status expected) {
    const Bare<Scalar> vehicle(airframe, site);
    CHECK(vehicle.status() == expected);
    return refuses(vehicle, VehicleState<Scalar>{}, Scalar(0.001), expected);
  };
  const Airframe<Scalar> good = pinnquad::PaperQuadrotor::value<Scalar>();
  for (const Scalar bad : {Scalar(0), Scalar(-1), nan, inf}) {
    CAPTURE(bad);
    Airframe<Scalar> airframe = good;
    airframe.mass_kg = bad;
    CHECK(refused(airframe, {}, Status::invalid_airframe));
    for (std::size_t i = 0; i < 3; ++i) {
      airframe = good;
      airframe.inertia_kg_m2[i] = bad;
      CHECK(refused(airframe, {}, Status::invalid_airframe));
    }
    airframe = good;
    airframe.propeller_diameter_m = bad;
    CHECK(refused(airframe, {}, Status::invalid_airframe));
  }
  for (const Scalar bad : {nan, inf}) {
    Airframe<Scalar> airframe = good;
    airframe.rotors[2].x_m = bad;
    CHECK(refused(airframe, {}, Status::invalid_airframe));
    for (int which = 0; which < 3; ++which) {
      Site<Scalar> site;
      (which == 0 ? site.elevation_m : which == 1 ? site.ground_z_m : site.gravity_m_s2) = bad;
      CHECK(refused(good, site, Status::out_of_range));
    }
  }
  Airframe<Scalar> in_line = good;
  for (auto& rotor : in_line.rotors) rotor.y_m = Scalar(0);
  CHECK(refused(in_line, {}, Status::no_solution));
}

TEST_CASE_TEMPLATE("where the air has no answer the step is refused, at its start and on its way", Scalar, float,
                   double) {
  const Quadrotor<Scalar, pinnquad::StandardAtmosphere> vehicle(pinnquad::PaperQuadrotor::value<Scalar>());
  for (const double altitude_m : {12e3, 45e3, 1e9, -6e3, -1e9}) {
    CAPTURE(altitude_m);
    VehicleState<Scalar> state;
    state.body.position_m[2] = Scalar(-altitude_m);
    CHECK(refuses(vehicle, state, Scalar(0.001), Status::out_of_range));
  }
  VehicleState<Scalar> climbing;  // leaves the troposphere within the step and would be back at its end
  climbing.body.position_m[2] = Scalar(-10900);
  climbing.body.velocity_m_s[2] = Scalar(-60);
  CHECK(refuses(vehicle, climbing, Scalar(12), Status::out_of_range));
  climbing.body.position_m[2] = Scalar(-10000);
  CHECK(vehicle.step(climbing, {}, Scalar(0.001)) == Status::ok);
}

TEST_CASE_TEMPLATE("a clock that a step does not move, or that no float can tell, is refused", Scalar, float, double) {
  const Bare<Scalar> vehicle(pinnquad::PaperQuadrotor::value<Scalar>());
  for (const double time_s : {1e300, -1e300, 1e15, 1.1e12}) {
    CAPTURE(time_s);
    VehicleState<Scalar> state;
    state.time_s = time_s;
    CHECK(refuses(vehicle, state, Scalar(0.001), Status::out_of_range));
    CHECK(refuses(vehicle, state, Scalar(0), Status::out_of_range));
  }
  VehicleState<Scalar> late;
  late.time_s = 9e11;
  CHECK(refuses(vehicle, late, Scalar(1e-6), Status::out_of_range));  // below the clock's resolution
  late.time_s = 1.8e9;                                                // today, in seconds since 1970
  CHECK(vehicle.step(late, {}, Scalar(0.001)) == Status::ok);
}

TEST_CASE_TEMPLATE("a rotor without lag gives its thrust from the first instant of a step", Scalar, float, double) {
  Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  airframe.rotor_time_constant_s = Scalar(0);
  const Bare<Scalar> vehicle(airframe);
  VehicleState<Scalar> state;  // rotors at rest
  const Commands<Scalar> hover = hover_commands(airframe, Scalar(1));
  REQUIRE(vehicle.step(state, hover, Scalar(0.01)) == Status::ok);
  // the first of four stages at rest would be a sixth of g over the step
  CHECK(std::fabs(static_cast<double>(state.body.velocity_m_s[2])) <= pinnquad::test::rounding<Scalar>(40));
  CHECK(state.rotors == hover);
}

TEST_CASE_TEMPLATE("an effect whose values or model do not hold makes the vehicle's status, step and all", Scalar,
                   float, double) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  const auto refused = [&airframe](const auto& effect) {
    using Effect = std::decay_t<decltype(effect)>;
    const Quadrotor<Scalar, Effect> vehicle(airframe, {}, effect);
    CHECK(vehicle.status() == Status::out_of_range);
    return refuses(vehicle, VehicleState<Scalar>{}, Scalar(0.001), Status::out_of_range);
  };
  CHECK(refused(pinnquad::ConstantWind{{nan, 0.0, 0.0}}));
  CHECK(refused(pinnquad::PeriodicWind{{1.0, 0.0, 0.0}, 2.5, 2.5, 0.0}));
  CHECK(refused(pinnquad::PeriodicWind{{1.0, 0.0, 0.0}, 2.5, nan, 10.0}));
  CHECK(refused(pinnquad::PeriodicWind{{1.0, 1.0, 0.0}, 2.5, 2.5, 10.0}));
  CHECK(refused(pinnquad::RotorDrag{-0.02}));
  CHECK(refused(pinnquad::RotorDrag{nan}));

  Airframe<Scalar> f450 = airframe;  // L 450 mm, R 127 mm: Conyers' fit has a pole at 24 cm
  for (auto& rotor : f450.rotors) {
    rotor.x_m *= Scalar(450.0 / 690.0);
    rotor.y_m *= Scalar(450.0 / 690.0);
  }
  f450.propeller_diameter_m = Scalar(0.254);
  using Near = Quadrotor<Scalar, pinnquad::GroundEffect<pinnquad::Conyers>>;
  CHECK(Near(f450).status() == Status::out_of_range);
  CHECK(refuses(Near(f450), VehicleState<Scalar>{}, Scalar(0.001), Status::out_of_range));
  CHECK(Near(airframe).status() == Status::ok);
  CHECK(Near::template of<pinnquad::PaperQuadrotor>().status() == Status::ok);
}

namespace {
/// It has no value by default that could be flown.
struct MeasuredDrag : pinnquad::QuadraticDrag {
  double measured = 0;
  template <class Scalar>
  constexpr Status status(const Airframe<Scalar>&) const noexcept {
    return measured > 0 ? Status::ok : Status::out_of_range;
  }
};
}  // namespace

TEST_CASE("a vehicle of effects that are given is judged by these, not by what they are by default") {
  using Vehicle = Quadrotor<double, MeasuredDrag>;
  MeasuredDrag drag;
  drag.measured = 1;
  CHECK(Vehicle::of<pinnquad::PaperQuadrotor>(Site<double>{}, drag).status() == Status::ok);
  CHECK(Vehicle::of<pinnquad::PaperQuadrotor>(Site<double>{}, MeasuredDrag{}).status() == Status::out_of_range);
}

// an effect that is not named costs no memory
static_assert(sizeof(Quadrotor<float, pinnquad::QuadraticDrag>) <= sizeof(Quadrotor<float>) + sizeof(float));

TEST_CASE("float agrees with double over a second of flight") {
  const Full<float> small = full_vehicle<float>({1.0, 2.0, 0.0});
  const Full<double> large = full_vehicle<double>({1.0, 2.0, 0.0});
  VehicleState<float> a;
  VehicleState<double> b;
  a.body.position_m[2] = -20.0f;
  b.body.position_m[2] = -20.0;
  for (int i = 0; i < 1000; ++i) {
    const double lean = 0.002 * std::sin(0.01 * i);
    const Commands<double> u{0.5 - lean, 0.5 + lean, 0.5 + lean, 0.5 - lean};
    REQUIRE(small.step(a, {float(u[0]), float(u[1]), float(u[2]), float(u[3])}, 0.001f) == Status::ok);
    REQUIRE(large.step(b, u, 0.001) == Status::ok);
  }
  const double drift = 1e-4;  // 1000 steps of float rounding, integrated twice
  CHECK(distance(a.body.position_m, b.body.position_m) <= drift);
  CHECK(distance(a.body.velocity_m_s, b.body.velocity_m_s) <= drift);
  CHECK(distance(pinnquad::test::components(a.body.attitude), pinnquad::test::components(b.body.attitude)) <= drift);
}
