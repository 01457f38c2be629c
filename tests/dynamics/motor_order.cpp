// SPDX-License-Identifier: MIT
#include "pinnquad/dynamics/motor_order.hpp"

#include <doctest/doctest.h>

#include <string>

#include "pinnquad/dynamics/airframes/crazyflie.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/racer_5_inch.hpp"
#include "pinnquad/dynamics/rotor.hpp"

using pinnquad::Airframe;
using pinnquad::Commands;
using pinnquad::Corner;
using pinnquad::MotorOrder;
using pinnquad::Status;

namespace {
/// The airframe with its rotors numbered as an order says.
Airframe<double> numbered(const Airframe<double>& airframe, const MotorOrder& from, const MotorOrder& to) {
  Airframe<double> result = airframe;
  result.rotors = pinnquad::reordered(airframe.rotors, from, to);
  return result;
}
}  // namespace

TEST_CASE("the conventions, corner by corner") {
  // 1 front right, 2 rear left, 3 front left, 4 rear right, told to each stack in its own order
  const Commands<double> px4{0.1, 0.2, 0.3, 0.4};
  CHECK(pinnquad::reordered(px4, pinnquad::px4_motor_order, pinnquad::betaflight_motor_order) ==
        Commands<double>{0.4, 0.1, 0.2, 0.3});
  CHECK(pinnquad::reordered(px4, pinnquad::px4_motor_order, pinnquad::crazyflie_motor_order) ==
        Commands<double>{0.1, 0.4, 0.2, 0.3});
  for (const MotorOrder& order : pinnquad::motor_orders) CHECK(pinnquad::is_motor_order(order.corners));
}

TEST_CASE("there and back, by every pair of orders; a name finds its order") {
  const Commands<double> u{0.1, 0.2, 0.3, 0.4};
  for (const MotorOrder& a : pinnquad::motor_orders) {
    for (const MotorOrder& b : pinnquad::motor_orders) {
      CHECK(pinnquad::reordered(pinnquad::reordered(u, a, b), b, a) == u);
    }
    MotorOrder found;
    REQUIRE(pinnquad::motor_order_named(a.name, found) == Status::ok);
    CHECK(found.corners == a.corners);
  }
  MotorOrder untouched = pinnquad::betaflight_motor_order;
  CHECK(pinnquad::motor_order_named("ardupilot", untouched) == Status::out_of_range);
  CHECK(untouched.name == "betaflight");
}

TEST_CASE("an airframe's order follows from its rotors' places") {
  MotorOrder order;
  for (const Airframe<double>& a : {pinnquad::PaperQuadrotor::value<double>(), pinnquad::Crazyflie::value<double>(),
                                    pinnquad::Racer5Inch::value<double>()}) {
    REQUIRE(pinnquad::motor_order_of(a, order) == Status::ok);
    CHECK(order.name == "px4");
    for (const MotorOrder& to : pinnquad::motor_orders) {
      MotorOrder again;
      REQUIRE(pinnquad::motor_order_of(numbered(a, order, to), again) == Status::ok);
      CHECK(again.name == to.name);
    }
  }
  Airframe<double> own = pinnquad::PaperQuadrotor::value<double>();
  std::swap(own.rotors[0], own.rotors[3]);
  REQUIRE(pinnquad::motor_order_of(own, order) == Status::ok);
  CHECK(order.name.empty());
  CHECK(order.corners[0] == Corner::rear_right);
}

TEST_CASE("renumbered rotors and reordered commands make the same wrench") {
  const Airframe<double> a = pinnquad::PaperQuadrotor::value<double>();
  const Commands<double> u{0.4, 0.5, 0.6, 0.7};
  for (const MotorOrder& to : pinnquad::motor_orders) {
    const auto one = pinnquad::Rotors<double>(a).wrench(u, 1.0);
    const auto other = pinnquad::Rotors<double>(numbered(a, pinnquad::px4_motor_order, to))
                           .wrench(pinnquad::reordered(u, pinnquad::px4_motor_order, to), 1.0);
    for (int i = 0; i < 3; ++i) CHECK(other.torque_N_m[i] == doctest::Approx(one.torque_N_m[i]).epsilon(1e-13));
    CHECK(other.force_N[2] == doctest::Approx(one.force_N[2]).epsilon(1e-14));
  }
}

TEST_CASE("a plus quadrotor and two rotors in one corner have no order") {
  Airframe<double> a = pinnquad::PaperQuadrotor::value<double>();
  MotorOrder order = pinnquad::betaflight_motor_order;
  a.rotors[0].y_m = 0;
  CHECK(pinnquad::motor_order_of(a, order) == Status::out_of_range);
  a = pinnquad::PaperQuadrotor::value<double>();
  a.rotors[0].x_m = -a.rotors[0].x_m;
  CHECK(pinnquad::motor_order_of(a, order) == Status::out_of_range);
  CHECK(order.name == "betaflight");
}
