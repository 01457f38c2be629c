// SPDX-License-Identifier: MIT
// The inverse of a rigid body with a residual wrench, nominal or a network: it makes the motion that is asked for,
// leans against what acts across the thrust, and knows how its network's force changes.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/flapping.hpp"
#include "pinnquad/control/tracking_controller.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/dynamics/airframes/light_quadrotor.hpp"
#include "pinnquad/simulation/tracking.hpp"
#include "study/wrench_network.hpp"

using namespace pinnquad;
using namespace study;

namespace {

using Vehicle = Quadrotor<double, StandardAtmosphere, QuadraticDrag, RotorDrag, BladeFlapping>;
using Nominal = NominalWrench<Vehicle>;
using Inverse = WrenchInverse<double, Nominal>;

Airframe<double> airframe() { return airframe_value<LightQuadrotor, double>(); }
Vehicle vehicle() { return Vehicle(airframe(), paper_site<double>()); }
Inverse inverse() {
  return Inverse(airframe(), Nominal(vehicle()), vehicle().rotor_scale(vehicle().surroundings({}, 0.0)));
}
State<double> forward_flight() {
  State<double> state;
  state.velocity_m_s = {4, -2, 0.5};
  state.attitude = from_euler<double>({0.1, -0.2, 0.7});
  state.body_rates_rad_s = {0.3, -0.2, 0.1};
  return state;
}

/// A network of another scalar, its numbers drawn.
using Net = Mlp<double, InputSize<WrenchFeatures::size>, Hidden<2, 32>, OutputSize<AccelerationOutputs::size>, Tanh>;
struct Drawn {
  Net net{};
  std::array<double, 10> mean{}, deviation{}, lower{}, upper{};
  std::array<double, 6> output_mean{}, output_deviation{};

  Drawn() {
    std::mt19937_64 engine(1);
    for (double& each : net.parameters) each = 0.3 * standard_normal(engine);
    for (std::size_t i = 0; i < mean.size(); ++i) {
      mean[i] = 0.1 * standard_normal(engine);
      deviation[i] = uniform(engine, 0.5, 2);
      lower[i] = -6;
      upper[i] = 6;
    }
    for (std::size_t k = 0; k < output_mean.size(); ++k) {
      output_mean[k] = standard_normal(engine);
      output_deviation[k] = uniform(engine, 0.5, 2);
    }
  }
  WrenchNetwork<Net> wrench() const {
    return WrenchNetwork<Net>(
        {mean.data(), deviation.data(), output_mean.data(), output_deviation.data(), lower.data(), upper.data()},
        net.parameters.data());
  }
};

}  // namespace

TEST_CASE("rotors that have come to its commands make the motion that was asked for") {
  Inverse policy = inverse();
  const State<double> state = forward_flight();
  const Accelerations<double> wanted{{0.2, -0.1, 0.8}, {2, -3, 0.5}};
  Commands<double> commands{};
  std::uint64_t now_us = 2000;
  for (int i = 0; i < 200; ++i, now_us += 2000) {  // the rotors' state comes to the commands
    REQUIRE(policy(state, wanted, now_us, commands) == Status::ok);
    policy.learn(now_us, true, state, commands);
  }
  const Accelerations<double> made = vehicle().evaluate(state, commands, 0.0).motion;
  CHECK(made.linear_m_s2[2] == doctest::Approx(wanted.linear_m_s2[2]).epsilon(1e-6));
  CHECK((made.angular_rad_s2 - wanted.angular_rad_s2).norm() <= 1e-6);
  // and across the thrust is the rest of the force
  const Vector3<double> across = world_to_body<double>(state.attitude, policy.across_m_s2(state));
  const Vector3<double> specific = SpecificForce::of<double>(motion_inputs(state, made));
  CHECK(across[0] == doctest::Approx(specific[0]));
  CHECK(across[1] == doctest::Approx(specific[1]));
  CHECK(std::abs(across[2]) <= 1e-12);
}

TEST_CASE("wind, thrust and force that it is told are in the answer") {
  Inverse policy = inverse();
  const State<double> state = forward_flight();
  Commands<double> plain{}, weak{}, pushed{};
  WindAndThrust<double> told;
  REQUIRE(policy(state, {}, 0, plain) == Status::ok);
  told.thrust_scale = 0.8;
  policy.tell(told);
  REQUIRE(policy(state, {}, 0, weak) == Status::ok);
  for (std::size_t i = 0; i < 4; ++i) CHECK(weak[i] == doctest::Approx(plain[i] / 0.8));
  told = {};
  told.wind_m_s = state.velocity_m_s;  // no air passes
  policy.tell(told);
  CHECK(policy.across_m_s2(state).norm() < 0.1);  // but what turning makes at the hubs
  told = {};
  told.force_m_s2 = {0, 0, 1};
  policy.tell(told);
  REQUIRE(policy(state, {}, 0, pushed) == Status::ok);
  CHECK(pushed[0] + pushed[1] + pushed[2] + pushed[3] > plain[0] + plain[1] + plain[2] + plain[3]);
}

TEST_CASE("it leans along the trajectory: a draggy vehicle stays on a circle") {
  const auto known = vehicle();
  Circle<double> circle;
  circle.center_m = {0, 0, -20};
  const double scale = known.rotor_scale(known.surroundings({}, 0.0));
  const FlightController<double> feedback({}, flight_limits(airframe(), scale));
  const AnalyticInverse<Vehicle> formula(known);
  const double upright = track(known, circle, feedback, formula).rmse_m;
  const double leaning = track(known, circle, feedback, inverse()).rmse_m;
  CHECK(leaning < 0.15 * upright);
  CHECK(leaning < 0.02);
}

TEST_CASE("the network's force changes as its Jacobian says, and not at all beyond the envelope") {
  const Drawn drawn;
  const WrenchNetwork<Net> wrench = drawn.wrench();
  WrenchInputs<double> in{{1.5, -0.7, 0.4}, {0.2, 0.1, -0.3}, {0.4, 0.5, 0.6, 0.5}};
  Matrix<double, 3, 3> slope;
  CHECK((wrench.force_and_slope(in, slope) - wrench(in).linear_m_s2).norm() <= 1e-12);
  const double step = 1e-5;
  for (int k = 0; k < 3; ++k) {
    WrenchInputs<double> more = in, less = in;
    more.air_velocity_m_s[k] += step;
    less.air_velocity_m_s[k] -= step;
    const Vector3<double> expected = (wrench(more).linear_m_s2 - wrench(less).linear_m_s2) / (2 * step);
    CHECK((slope.col(k) - expected).norm() <= 1e-8 * (1 + expected.norm()));
  }
  in.air_velocity_m_s[0] = 6.5;
  WrenchInputs<double> edge = in;
  edge.air_velocity_m_s[0] = 6;
  CHECK((wrench(in).linear_m_s2 - wrench(edge).linear_m_s2).norm() <= 1e-12);
  CHECK((wrench.force_and_slope(in, slope) - wrench(edge).linear_m_s2).norm() <= 1e-12);
  CHECK(slope.col(0).norm() <= 0);
  CHECK(slope.col(1).norm() > 0);
}
