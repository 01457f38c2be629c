// SPDX-License-Identifier: MIT
#include "pinnquad/aero/ground_effect.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "support/plain_dynamics.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"
#include "support/uneven_airframe.hpp"

using pinnquad::CheesemanBennett;
using pinnquad::Conyers;
using pinnquad::RotorCondition;
using pinnquad::RotorGroundEffect;
using pinnquad::Vector3;
using pinnquad::test::RandomStates;
using pinnquad::test::rounding;

namespace {
template <class Scalar>
RotorCondition<Scalar> hovering(Scalar height_m, Scalar thrust_N) {
  RotorCondition<Scalar> c;
  c.height_above_ground_m = height_m;
  c.rotor_thrust_N = {thrust_N, thrust_N, thrust_N, thrust_N};
  c.rotors.force_N[2] = Scalar(-4) * thrust_N;
  return c;
}
}  // namespace

TEST_CASE_TEMPLATE("level and still: the force of the one-ratio model, no torque", Scalar, float, double) {
  const auto airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  for (int i = 1; i < 40; ++i) {
    const auto c = hovering<Scalar>(Scalar(0.05 * i), Scalar(3.7));
    const auto per_rotor = RotorGroundEffect<Conyers>{}.wrench(c, airframe);
    const auto whole = pinnquad::GroundEffect<pinnquad::Conyers>{}.wrench(c, airframe);
    CHECK(std::fabs(static_cast<double>(per_rotor.force_N[2] - whole.force_N[2])) <= rounding<Scalar>(50));
    CHECK(pinnquad::test::norm(per_rotor.torque_N_m) <= rounding<Scalar>(50));
  }
}

TEST_CASE_TEMPLATE("tilted near the ground: the low side lifts more and turns the vehicle level", Scalar, float,
                   double) {
  const auto airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  for (const double tilt : {0.1, 0.3}) {
    for (const double sign : {-1.0, 1.0}) {
      auto c = hovering<Scalar>(Scalar(0.2), Scalar(3.7));
      c.attitude = pinnquad::from_euler<Scalar>({Scalar(sign * tilt), Scalar(0), Scalar(1)});
      CHECK(static_cast<double>(RotorGroundEffect<CheesemanBennett>{}.wrench(c, airframe).torque_N_m[0]) * sign <
            -1e-3);
      c.attitude = pinnquad::from_euler<Scalar>({Scalar(0), Scalar(sign * tilt), Scalar(1)});
      CHECK(static_cast<double>(RotorGroundEffect<CheesemanBennett>{}.wrench(c, airframe).torque_N_m[1]) * sign <
            -1e-3);
    }
  }
}

TEST_CASE_TEMPLATE("at each hub, rotated into the world, along its axis: upright rotors, raised and tilted ones",
                   Scalar, float, double) {
  RandomStates random(131);
  for (int draw = 0; draw < pinnquad::test::draws; ++draw) {
    const auto airframe =
        draw % 2 == 0 ? pinnquad::PaperQuadrotor::value<Scalar>() : pinnquad::test::uneven_airframe<Scalar>();
    auto c = hovering<Scalar>(random.scalar<Scalar>(0.6, 1.5), Scalar(0));
    for (Scalar& thrust : c.rotor_thrust_N) thrust = random.scalar<Scalar>(0.0, 8.0);
    c.attitude = random.attitude<Scalar>();
    Vector3<double> force = Vector3<double>::Zero(), torque = Vector3<double>::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& hub = airframe.rotors[i];
      const Vector3<Scalar> arm(hub.x_m, hub.y_m, hub.z_m), axis(hub.axis[0], hub.axis[1], hub.axis[2]);
      const auto in_world = [&](const Vector3<Scalar>& v) {
        return static_cast<double>(pinnquad::body_to_world<Scalar>(c.attitude, v)[2]);
      };
      const double height_m = static_cast<double>(c.height_above_ground_m) - in_world(arm);
      const double lift = (plain::cheeseman_bennett(height_m / 0.1143) - 1.0) * std::fabs(in_world(axis)) *
                          static_cast<double>(c.rotor_thrust_N[i]);
      const Vector3<double> pull = axis.template cast<double>() * lift;
      force += pull;
      torque += pinnquad::cross<double>(arm.template cast<double>(), pull);
    }
    const auto w = RotorGroundEffect<CheesemanBennett>{}.wrench(c, airframe);
    const double tolerance = rounding<Scalar>(1000);  // the ratio is steep where a hub is low
    CHECK(pinnquad::test::distance(w.force_N, force) <= tolerance);
    CHECK(pinnquad::test::distance(w.torque_N_m, torque) <= tolerance);
    CHECK(pinnquad::test::norm(force) > 0);
  }
}

TEST_CASE("bound to an airframe it gives the same wrench, bit by bit, and tells the inverse that it uses the rotors") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  const auto bound = pinnquad::detail::bound_effect(RotorGroundEffect<Conyers>{}, airframe);
  const auto c = hovering<double>(0.3, 4.0);
  CHECK(bound.wrench(c, airframe).force_N == RotorGroundEffect<Conyers>{}.wrench(c, airframe).force_N);
  static_assert(pinnquad::uses_rotor_wrench<std::decay_t<decltype(bound)>>);
  static_assert(!pinnquad::has_thrust_branches<RotorGroundEffect<Conyers>>);
  static_assert(pinnquad::has_thrust_branches<pinnquad::GroundEffect<pinnquad::Conyers>>);
}

TEST_CASE_TEMPLATE("tilted on the ground: hubs at, next to and under it make at most a third more lift", Scalar, float,
                   double) {
  const auto airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  const double radius_m = static_cast<double>(airframe.propeller_diameter_m) / 2;
  const double most_N = 4 * 3.7 / 3 * 1.00001;
  for (int tilt = 0; tilt <= 90; ++tilt) {
    for (int i = -200; i <= 400; ++i) {
      auto c = hovering<Scalar>(Scalar(i * 1e-3 + 0.25 * radius_m), Scalar(3.7));
      c.attitude = pinnquad::from_euler<Scalar>({Scalar(tilt * 0.0174533), Scalar(0), Scalar(0)});
      const auto lift = RotorGroundEffect<CheesemanBennett>{}.wrench(c, airframe);
      const bool finite = pinnquad::all_finite(lift.force_N) && pinnquad::all_finite(lift.torque_N_m);
      const double force_N = static_cast<double>(-lift.force_N[2]);
      if (!finite || force_N < 0 || force_N > most_N) FAIL_CHECK("tilt " << tilt << " height " << i << " mm");
    }
  }
  const auto under = hovering<Scalar>(Scalar(0.24 * radius_m), Scalar(3.7));
  const Scalar lift = -RotorGroundEffect<CheesemanBennett>{}.wrench(under, airframe).force_N[2];
  CHECK(static_cast<double>(lift) == doctest::Approx(4 * 3.7 / 3).epsilon(1e-5));
}
