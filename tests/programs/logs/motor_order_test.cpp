// SPDX-License-Identifier: MIT
#include "logs/motor_order.hpp"

#include <doctest/doctest.h>

#include <string>

#include "pinnquad/dynamics/airframes/crazyflie.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/racer_5_inch.hpp"
#include "pinnquad/dynamics/rotor.hpp"

using pinnquad::Airframe;
using pinnquad::Commands;
using pinnquad::Status;
using pinnquad::logs::MotorOrder;

namespace {
/// The airframe with its rotors numbered as an order says.
Airframe<double> numbered(const Airframe<double>& airframe, const MotorOrder& from, const MotorOrder& to) {
  Airframe<double> result = airframe;
  for (std::size_t i = 0; i < pinnquad::rotor_count; ++i) {
    for (std::size_t k = 0; k < pinnquad::rotor_count; ++k) {
      if (from.corners[k] == to.corners[i]) result.rotors[i] = airframe.rotors[k];
    }
  }
  return result;
}
}  // namespace

TEST_CASE("a name finds its order, in which each corner occurs once") {
  for (const MotorOrder& a : pinnquad::logs::motor_orders) {
    CHECK(pinnquad::logs::is_motor_order(a.corners));
    MotorOrder found;
    REQUIRE(pinnquad::logs::motor_order_named(a.name, found) == Status::ok);
    CHECK(found.corners == a.corners);
  }
  MotorOrder untouched = pinnquad::logs::motor_orders[1];
  CHECK(pinnquad::logs::motor_order_named("ardupilot", untouched) == Status::out_of_range);
  CHECK(untouched.name == "betaflight");
}

TEST_CASE("an airframe's order follows from its rotors' places") {
  MotorOrder order;
  for (const Airframe<double>& a : {pinnquad::PaperQuadrotor::value<double>(), pinnquad::Crazyflie::value<double>(),
                                    pinnquad::Racer5Inch::value<double>()}) {
    REQUIRE(pinnquad::logs::motor_order_of(a, order) == Status::ok);
    CHECK(order.name == "px4");
    for (const MotorOrder& to : pinnquad::logs::motor_orders) {
      MotorOrder again;
      REQUIRE(pinnquad::logs::motor_order_of(numbered(a, order, to), again) == Status::ok);
      CHECK(again.name == to.name);
    }
  }
  Airframe<double> own = pinnquad::PaperQuadrotor::value<double>();
  std::swap(own.rotors[0], own.rotors[3]);
  REQUIRE(pinnquad::logs::motor_order_of(own, order) == Status::ok);
  CHECK(order.name.empty());
  CHECK(order.corners[0] == MotorOrder::rear_right);
}

TEST_CASE("a plus quadrotor and two rotors in one corner have no order") {
  Airframe<double> a = pinnquad::PaperQuadrotor::value<double>();
  MotorOrder order = pinnquad::logs::motor_orders[1];
  a.rotors[0].y_m = 0;
  CHECK(pinnquad::logs::motor_order_of(a, order) == Status::out_of_range);
  a = pinnquad::PaperQuadrotor::value<double>();
  a.rotors[0].x_m = -a.rotors[0].x_m;
  CHECK(pinnquad::logs::motor_order_of(a, order) == Status::out_of_range);
  CHECK(order.name == "betaflight");
}
