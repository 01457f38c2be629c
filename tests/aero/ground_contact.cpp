// SPDX-License-Identifier: MIT
#include "pinnquad/aero/ground_contact.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/dynamics/airframes/crazyflie.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"

using pinnquad::Commands;
using pinnquad::GroundContact;
using pinnquad::Quadrotor;
using pinnquad::Status;
using pinnquad::Vector3;
using pinnquad::VehicleState;

namespace {

template <class Scalar, class... Effects>
VehicleState<Scalar> flown(const Quadrotor<Scalar, Effects...>& vehicle, VehicleState<Scalar> state,
                           double duration_s) {
  const int steps = static_cast<int>(duration_s * 1000 + 0.5);
  for (int i = 0; i < steps; ++i) REQUIRE(vehicle.step(state, Commands<Scalar>{}, Scalar(0.001)) == Status::ok);
  return state;
}

/// Standing height of the centre.
constexpr double standing_m = 0.18 - 0.002;

VehicleState<double> above_ground(double height_m) {
  VehicleState<double> state;
  state.body.position_m[2] = -height_m;
  return state;
}

/// Kinetic, potential and in the springs, J. Heights of the feet by rotating them into the world.
double energy(const pinnquad::Airframe<double>& a, const pinnquad::State<double>& s) {
  double sum = a.mass_kg * (s.velocity_m_s.squaredNorm() / 2 - 9.80665 * s.position_m[2]);
  for (int i = 0; i < 3; ++i) {
    sum += a.inertia_kg_m2[static_cast<std::size_t>(i)] * s.body_rates_rad_s[i] * s.body_rates_rad_s[i] / 2;
  }
  for (const auto& hub : a.rotors) {
    const double foot_m =
        s.position_m[2] + pinnquad::body_to_world<double>(s.attitude, Vector3<double>(hub.x_m, hub.y_m, 0.18))[2];
    if (foot_m > 0) sum += a.mass_kg * 9.80665 / (4 * 0.002) * foot_m * foot_m / 2;
  }
  return sum;
}

}  // namespace

TEST_CASE_TEMPLATE("standing: the feet carry the weight at their static depth; a hair above, nothing", Scalar, float,
                   double) {
  const auto airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  const Quadrotor<Scalar, GroundContact> vehicle(airframe);
  pinnquad::State<Scalar> state;
  state.position_m[2] = Scalar(-standing_m);
  const auto standing = vehicle.evaluate(state, {}, Scalar(0));
  CHECK(std::fabs(static_cast<double>(standing.motion.linear_m_s2[2])) <= 1e3 * pinnquad::test::rounding<Scalar>(10));
  CHECK(pinnquad::test::norm(standing.motion.angular_rad_s2) <= 1e3 * pinnquad::test::rounding<Scalar>(10));
  state.position_m[2] = Scalar(-0.1801);
  CHECK(pinnquad::test::norm(vehicle.evaluate(state, {}, Scalar(0)).aerodynamic.force_N) == 0);
}

TEST_CASE_TEMPLATE("dropped with idle rotors it comes to rest within a millimetre, in steps of 1 ms", Scalar, float,
                   double) {
  // 0.2 m of fall is a touch-down at 2 m/s
  const auto lands = [](const pinnquad::Airframe<Scalar>& airframe, double leg_m) {
    const Quadrotor<Scalar, GroundContact> vehicle(airframe, {}, {leg_m});
    for (const double tilt : {0.0, 0.1, 0.3}) {
      VehicleState<Scalar> state;
      state.body.position_m[2] = Scalar(-leg_m - 0.2);
      state.body.attitude = pinnquad::from_euler<Scalar>({Scalar(tilt), Scalar(-tilt / 2), Scalar(1)});
      state.body.velocity_m_s = Vector3<Scalar>(Scalar(0.3), Scalar(-0.2), Scalar(0));
      state = flown(vehicle, state, 5.0);
      CHECK(std::fabs(static_cast<double>(state.body.position_m[2]) + leg_m - 0.002) <= 1e-3);
      CHECK(pinnquad::test::norm(state.body.velocity_m_s) <= 1e-4);
      CHECK(pinnquad::test::norm(state.body.body_rates_rad_s) <= 1e-3);
      CHECK(static_cast<double>(pinnquad::body_down_axis(state.body.attitude)[2]) >= 1 - 1e-6);
    }
  };
  lands(pinnquad::PaperQuadrotor::value<Scalar>(), 0.18);
  lands(pinnquad::Crazyflie::value<Scalar>(), 0.02);
}

TEST_CASE("energy only falls, whatever the attitude, and each bounce is lower than a third of the one before") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  const Quadrotor<double, GroundContact> vehicle(airframe);
  pinnquad::test::RandomStates random(190);
  for (int draw = 0; draw < 20; ++draw) {
    VehicleState<double> state = above_ground(random.scalar<double>(0.3, 0.45));
    state.body.attitude = pinnquad::from_euler<double>(
        {random.scalar<double>(-0.3, 0.3), random.scalar<double>(-0.3, 0.3), random.scalar<double>(-3.0, 3.0)});
    state.body.velocity_m_s = random.vector<double>(0.5);
    state.body.body_rates_rad_s = random.vector<double>(1.0);
    const double at_first = energy(airframe, state.body);
    double before = at_first;
    for (int i = 0; i < 3000; ++i) {
      state = flown(vehicle, state, 0.001);
      const double now = energy(airframe, state.body);
      if (now > before + 1e-4 * std::fabs(at_first)) FAIL_CHECK("step " << i << " gains " << now - before << " J");
      before = now;
    }
  }
  VehicleState<double> state = above_ground(0.38);
  std::vector<double> tops{0.38 - standing_m};
  double sinking = 1;
  for (int i = 0; i < 3000; ++i) {
    state = flown(vehicle, state, 0.001);
    const double now = state.body.velocity_m_s[2];
    if (sinking < 0 && now >= 0) tops.push_back(-state.body.position_m[2] - standing_m);
    sinking = now;
  }
  for (std::size_t i = 1; i < tops.size(); ++i) CHECK(tops[i] < std::max(tops[i - 1] / 3, 1e-6));
}

TEST_CASE("friction: it slides to a stop in v^2 / (2 mu g), and a breeze does not carry it off") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  VehicleState<double> state = above_ground(standing_m);
  state.body.velocity_m_s[0] = 1.0;
  state = flown(Quadrotor<double, GroundContact>(airframe), state, 3.0);
  CHECK(std::fabs(state.body.position_m[0] / (1.0 / (2 * 0.6 * 9.80665)) - 1) <= 0.15);

  using Windy = Quadrotor<double, pinnquad::ConstantWind, pinnquad::QuadraticDrag, GroundContact>;
  state = flown(Windy(airframe, {}, {{5.0, 0.0, 0.0}}, {}, {}), above_ground(standing_m), 10.0);
  const double push_N = 0.00538309 * 1.225 * 25;
  const double creep_m_s = push_N / (0.6 * 1.5 * 9.80665) * (0.005 + 0.6 * 9.80665 * 0.005);
  CHECK(creep_m_s < 1e-3);
  CHECK(std::fabs(state.body.velocity_m_s[0] / creep_m_s - 1) <= 0.05);
  CHECK(std::fabs(state.body.position_m[2] + standing_m) <= 1e-4);
}

TEST_CASE("a spin on the ground stops, one foot under the ground turns the vehicle off it") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  const Quadrotor<double, GroundContact> vehicle(airframe);
  VehicleState<double> state = above_ground(standing_m);
  state.body.body_rates_rad_s[2] = 3;
  state = flown(vehicle, state, 2.0);
  CHECK(std::fabs(state.body.body_rates_rad_s[2]) <= 1e-3);
  pinnquad::State<double> tilted;
  tilted.position_m[2] = -0.2;
  tilted.attitude = pinnquad::from_euler<double>({0.2, 0.0, 0.0});  // right side down
  CHECK(vehicle.evaluate(tilted, {}, 0.0).motion.angular_rad_s2[0] < 0);
  tilted.attitude = pinnquad::from_euler<double>({0.0, 0.2, 0.0});  // nose up: the rear touches
  CHECK(vehicle.evaluate(tilted, {}, 0.0).motion.angular_rad_s2[1] < 0);
}

TEST_CASE("springs that are none are refused") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  CHECK(GroundContact{}.status(airframe) == Status::ok);
  CHECK(GroundContact{0.0}.status(airframe) == Status::out_of_range);
  CHECK(GroundContact{0.1, 0.0}.status(airframe) == Status::out_of_range);
  CHECK(GroundContact{0.1, 0.002, -0.1}.status(airframe) == Status::out_of_range);
  CHECK(GroundContact{0.1, 0.002, 0.5, -0.1}.status(airframe) == Status::out_of_range);
  CHECK(GroundContact{0.1, 0.002, 0.5, 0.6, 0.0}.status(airframe) == Status::out_of_range);
  CHECK(GroundContact{std::numeric_limits<double>::quiet_NaN()}.status(airframe) == Status::out_of_range);
  static_assert(!pinnquad::uses_rotor_wrench<GroundContact>);
}
