// SPDX-License-Identifier: MIT
// The vehicle of PX4's simulation in hardware, flown by the commands that its log has: forward Euler at 4 ms, as SIH
// steps; the body rates of ground truth judge it.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>

#include "pinnquad/aero/drag.hpp"
#include "pinnquad/dynamics/airframes/px4_sih.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"
#include "reference/reference_rows.hpp"

using namespace pinnquad;  // NOLINT: a test of many of its names

namespace {

constexpr long step_us = 4000;
constexpr double step_s = 0.004;
constexpr long airborne_from_us = 19964000, airborne_until_us = 147264000;  // phases.csv

struct Truth {
  Vector3<double> rates, velocity = Vector3<double>::Zero();
};

test::ReferenceTable topic(const std::string& name) {
  return test::ReferenceTable("test_circle_" + name + "_0.csv", test::reference_folder() + "/sih/test_circle_csv/");
}

/// Share of the variance of each axis' rate differences that one step of the vehicle explains.
template <class Vehicle>
std::array<double, 3> explained(const Vehicle& vehicle) {
  std::map<long, Commands<double>> commands;
  const test::ReferenceTable motors = topic("actuator_motors"), rates = topic("vehicle_angular_velocity_groundtruth");
  for (std::size_t row = 0; row < motors.size(); ++row) {
    Commands<double> c{};
    // SIH is given whole microseconds of a pulse
    for (std::size_t i = 0; i < 4; ++i) {
      c[i] = std::round(1000 * motors.at(row, "control[" + std::to_string(i) + "]")) / 1000;
    }
    commands[std::lround(motors.at(row, "timestamp"))] = c;
  }
  std::array<double, 3> missed{}, sum{}, squares{};
  double count = 0;
  ThrustFractions<double> rotors{};
  Commands<double> last{};
  std::size_t row = 0;
  const double lag = 1 - step_s / vehicle.airframe().rotor_time_constant_s;
  for (long now = commands.begin()->first; now < airborne_until_us && row + 1 < rates.size(); now += step_us) {
    rotors = lagged(rotors, last, lag);
    const auto asked = commands.find(now);
    if (asked != commands.end()) last = asked->second;  // of a few steps the log has none: held
    while (row + 1 < rates.size() && rates.at(row, "timestamp") < static_cast<double>(now)) ++row;
    const bool pair =
        std::lround(rates.at(row, "timestamp")) == now && std::lround(rates.at(row + 1, "timestamp")) == now + step_us;
    if (!pair || now < airborne_from_us) continue;
    State<double> body;
    Vector3<double> next;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string column = "xyz[" + std::to_string(axis) + "]";
      body.body_rates_rad_s[axis] = rates.at(row, column);
      next[axis] = rates.at(row + 1, column);
    }
    const Vector3<double> turning = vehicle.evaluate(body, lagged(rotors, last, lag), 0.0).motion.angular_rad_s2;
    for (int axis = 0; axis < 3; ++axis) {
      const double truth = (next[axis] - body.body_rates_rad_s[axis]) / step_s, error = turning[axis] - truth;
      const auto k = static_cast<std::size_t>(axis);
      missed[k] += error * error;
      sum[k] += truth;
      squares[k] += truth * truth;
    }
    ++count;
  }
  REQUIRE(count > 25000);
  std::array<double, 3> r_squared{};
  for (std::size_t k = 0; k < 3; ++k) r_squared[k] = 1 - missed[k] / (squares[k] - sum[k] * sum[k] / count);
  return r_squared;
}

}  // namespace

TEST_CASE("the vehicle of PX4's SIH turns as its log says") {
  if (!std::ifstream(test::reference_folder() + "/sih/test_circle_csv/test_circle_actuator_motors_0.csv")) {
    MESSAGE("skipped: no logs of SIH");
    return;
  }
  const auto of_vehicle = explained(Quadrotor<double, LinearDamping>::of<Px4Sih>());
  const auto undamped = explained(Quadrotor<double>::of<Px4Sih>(Site<double>{}));
  std::printf("%-24s %-24s R^2 %.6f %.6f %.6f\n", "sih/test_circle", "rate differences", of_vehicle[0], of_vehicle[1],
              of_vehicle[2]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    CHECK(of_vehicle[axis] >= 0.9999);
    CHECK(undamped[axis] < 0.9999);
  }
}
