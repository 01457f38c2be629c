// SPDX-License-Identifier: MIT
#include "pinnquad/dynamics/actuator.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "support/random_states.hpp"
#include "support/tolerances.hpp"
#include "support/uneven_airframe.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

TEST_CASE("the curve's ends: a command is thrust, or a speed whose square is") {
  for (const double u : {-0.5, 0.0, 0.25, 0.5, 1.0, 1.5}) {
    CHECK(thrust_fraction(0.0, u) == u);
    CHECK(command_of_fraction(0.0, u) == u);
    CHECK(thrust_fraction(1.0, u) == u * std::fabs(u));
  }
  CHECK(thrust_fraction(0.5, 0.5) == 0.375);  // 0.5 x 0.25 + 0.5 x 0.5
  CHECK(command_of_fraction(1.0, 0.0) == 0.0);
  CHECK(std::isnan(command_of_fraction(1.0, std::numeric_limits<double>::quiet_NaN())));
}

TEST_CASE_TEMPLATE("curve and inverse undo each other, rise, and pass through 0 and 1", Scalar, float, double) {
  for (const double k : {0.0, 1e-6, 0.3, 0.7, 1.0}) {
    CHECK(thrust_fraction(Scalar(k), Scalar(0)) == Scalar(0));
    CHECK(static_cast<double>(thrust_fraction(Scalar(k), Scalar(1))) ==
          doctest::Approx(1.0).epsilon(rounding<Scalar>(4)));
    for (int i = -15; i <= 15; ++i) {
      const Scalar u = Scalar(0.1 * i);
      const Scalar s = thrust_fraction(Scalar(k), u);
      CHECK(std::fabs(static_cast<double>(command_of_fraction(Scalar(k), s) - u)) <= rounding<Scalar>(16));
      CHECK(thrust_fraction(Scalar(k), -u) == -s);
      if (i != 0) CHECK(thrust_fraction(Scalar(k), u + Scalar(0.01)) > s);
    }
  }
}

TEST_CASE("the slope is the curve's, by central differences") {
  const double h = 1e-6;
  for (const double k : {0.0, 0.4, 1.0}) {
    for (const double u : {-0.8, 0.2, 0.9}) {
      const double difference = (thrust_fraction(k, u + h) - thrust_fraction(k, u - h)) / (2 * h);
      CHECK(pinnquad::thrust_fraction_slope(k, u) == doctest::Approx(difference).epsilon(1e-8));
    }
  }
}

TEST_CASE("a rotor tilted by 30 degrees to the front: its wrench by hand") {
  Airframe<double> a = pinnquad::PaperQuadrotor::value<double>();
  pinnquad::RotorMount<double>& r = a.rotors[2];  // front left, clockwise
  r = {0.2, -0.1, pinnquad::Spin::clockwise};
  r.z_m = -0.05;
  r.axis = {0.5, 0.0, -std::sqrt(0.75)};
  r.thrust_scale = 0.8;
  REQUIRE(check_airframe(a) == Status::ok);
  const double t = 0.6 * 0.8 * a.max_rotor_thrust_N(), q = 0.6 * 0.8 * a.max_rotor_torque_N_m();
  const double c = std::sqrt(0.75);
  const pinnquad::Wrench<double> w = Rotors<double>(a).wrench({0.0, 0.0, 0.6, 0.0}, 1.0);
  CHECK(w.force_N[0] == doctest::Approx(0.5 * t).epsilon(1e-14));
  CHECK(w.force_N[1] == 0.0);
  CHECK(w.force_N[2] == doctest::Approx(-c * t).epsilon(1e-14));
  // r x f, and the reaction of a clockwise rotor: along its axis
  CHECK(w.torque_N_m[0] == doctest::Approx((-0.1) * (-c * t) + q * 0.5).epsilon(1e-14));
  CHECK(w.torque_N_m[1] == doctest::Approx((-0.05) * (0.5 * t) - 0.2 * (-c * t)).epsilon(1e-14));
  CHECK(w.torque_N_m[2] == doctest::Approx(-(-0.1) * (0.5 * t) - q * c).epsilon(1e-14));
}

TEST_CASE_TEMPLATE("an axis written out is an upright rotor, to the rounding", Scalar, float, double) {
  const Airframe<Scalar> plain = pinnquad::PaperQuadrotor::value<Scalar>();
  Airframe<Scalar> turned = plain;
  for (auto& r : turned.rotors) r.axis = {Scalar(1e-30), Scalar(0), Scalar(-1)};  // by the general formula
  const auto a = pinnquad::allocation(plain), b = pinnquad::allocation(turned);
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(static_cast<double>(b[row][i]) ==
            doctest::Approx(static_cast<double>(a[row][i])).epsilon(rounding<Scalar>(4)));
    }
  }
}

TEST_CASE_TEMPLATE("commands invert wrench for uneven rotors, at any scale", Scalar, float, double) {
  const Airframe<Scalar> a = pinnquad::test::uneven_airframe<Scalar>();
  REQUIRE(check_airframe(a) == Status::ok);
  REQUIRE(!pinnquad::is_plain(a));
  const Rotors<Scalar> rotors(a);
  REQUIRE(rotors.status() == Status::ok);
  RandomStates random(71);
  for (int draw = 0; draw < draws; ++draw) {
    const Scalar scale = random.scalar<Scalar>(0.5, 1.1);
    const Commands<Scalar> u =
        random.commands<Scalar>(0.05, 1.5);  // a curve of slope 0 has no inverse to full precision at 0
    const double steepest = 20;              // du/ds of the quadratic curve at 0.05 is 10
    CHECK(pinnquad::test::distance(rotors.commands(rotors.wrench(u, scale), scale), u) <=
          steepest * pinnquad::test::inverse_tolerance<Scalar>);
  }
}

TEST_CASE("speed and command of a rotor with a curve") {
  const Airframe<double> a = pinnquad::test::uneven_airframe<double>();
  for (std::size_t i = 0; i < 4; ++i) {
    for (const double u : {0.0, 0.3, 1.0}) {
      const double n = pinnquad::speed_from_command(a, i, u);
      CHECK(pinnquad::command_from_speed(a, i, n) == doctest::Approx(u).epsilon(1e-12));
      // thrust = scale c_T n^2 whatever the command means
      const double most = a.rotors[i].thrust_scale * a.dimensional_thrust_coefficient();
      Commands<double> one{};
      one[i] = u;
      CHECK(Rotors<double>(a).thrusts_of(Rotors<double>(a).fractions(one), 1.0)[i] == doctest::Approx(most * n * n));
    }
  }
  CHECK(pinnquad::speed_from_command(a, 3, 0.5) == doctest::Approx(0.5 * a.max_rotor_speed_rev_s));  // k = 1
}

TEST_CASE("lag: each rotor by its own time constant, rising and falling, in thrust") {
  const Airframe<double> a = pinnquad::test::uneven_airframe<double>();
  const ThrustFractions<double> before{0.2, 0.8, 0.3, 0.6}, wanted{0.9, 0.1, 1.4, 0.6};
  const double step = 0.007;
  const auto tau = pinnquad::time_constants_s(a, before, wanted);
  CHECK(tau == std::array<double, 4>{0.004, 0.03, 0.0, 0.05});
  const auto end = pinnquad::lagged(before, wanted, pinnquad::lag_factor(tau, step));
  CHECK(end[0] == doctest::Approx(0.9 + (0.2 - 0.9) * std::exp(-step / 0.004)).epsilon(1e-14));  // rises
  CHECK(end[1] == doctest::Approx(0.1 + (0.8 - 0.1) * std::exp(-step / 0.03)).epsilon(1e-14));   // falls
  CHECK(end[2] == 1.0);                                                                          // its limit, at once
  CHECK(end[3] == 0.6);
  CHECK(pinnquad::at_start(before, end, tau) == ThrustFractions<double>{0.2, 0.8, 1.0, 0.6});
}

TEST_CASE_TEMPLATE("equal time constants: the lag of one for all, to the last bit", Scalar, float, double) {
  const Airframe<Scalar> a = pinnquad::PaperQuadrotor::value<Scalar>();
  RandomStates random(72);
  for (int draw = 0; draw < draws; ++draw) {
    const ThrustFractions<Scalar> before = random.commands<Scalar>(), wanted = random.commands<Scalar>(-0.2, 1.2);
    const auto each = pinnquad::lag_factor(pinnquad::time_constants_s(a, before, wanted), Scalar(0.002));
    const Scalar one = pinnquad::lag_factor(a.rotor_time_constant_s, Scalar(0.002));
    CHECK(pinnquad::lagged(before, wanted, each) == pinnquad::lagged(before, wanted, one));
  }
}

TEST_CASE_TEMPLATE("check_airframe refuses a rotor that can't be", Scalar, float, double) {
  const Airframe<Scalar> good = pinnquad::test::uneven_airframe<Scalar>();
  REQUIRE(check_airframe(good) == Status::ok);
  const Scalar nan = std::numeric_limits<Scalar>::quiet_NaN();
  const auto refused = [&](auto set) {
    Airframe<Scalar> a = good;
    set(a.rotors[1]);
    return check_airframe(a) == Status::invalid_airframe;
  };
  for (const Scalar bad : {nan, std::numeric_limits<Scalar>::infinity()}) {
    CHECK(refused([&](auto& r) { r.z_m = bad; }));
    CHECK(refused([&](auto& r) { r.axis[0] = bad; }));
    CHECK(refused([&](auto& r) { r.thrust_scale = bad; }));
    CHECK(refused([&](auto& r) { r.thrust_curve = bad; }));
    CHECK(refused([&](auto& r) { r.rise_time_constant_s = bad; }));
    CHECK(refused([&](auto& r) { r.fall_time_constant_s = bad; }));
  }
  CHECK(refused([](auto& r) { r.axis = {Scalar(0), Scalar(0), Scalar(-0.99)}; }));
  CHECK(refused([](auto& r) { r.axis = {Scalar(0), Scalar(0), Scalar(0)}; }));
  CHECK(refused([](auto& r) { r.thrust_scale = Scalar(0); }));
  CHECK(refused([](auto& r) { r.thrust_curve = Scalar(-0.01); }));
  CHECK(refused([](auto& r) { r.thrust_curve = Scalar(1.01); }));
  CHECK(refused([](auto& r) { r.rise_time_constant_s = Scalar(-0.5); }));
  CHECK(refused([](auto& r) { r.fall_time_constant_s = Scalar(-0.5); }));
}
