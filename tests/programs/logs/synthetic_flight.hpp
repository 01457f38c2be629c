// SPDX-License-Identifier: MIT
// A vehicle small enough to know everything of: commands at random, motors behind a lag and a delay, rotation by
// Euler's equation without gyroscopic terms, attitude by the exponential map at a fine step. All along one uniform
// clock.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include "pinnquad/core/random.hpp"
#include "pinnquad/core/rotation.hpp"
#include "pinnquad/data/dataset.hpp"

namespace pinnquad::test {

struct SyntheticVehicle {
  double period_s = 0.01;
  double duration_s = 60;
  double motor_time_constant_s = 0.05;
  double delay_s = 0.01;
  double rate_damping_1_s = 1;
  double acceleration_noise_rad_s2 = 0;
  std::uint64_t seed = 1;
};

/// Signs of an X quadrotor, PX4's order; effectiveness 40, 40, 3.3 rad/s^2 per command, thrust 5 m/s^2 per command.
inline Flight synthetic_flight(const SyntheticVehicle& vehicle = {}) {
  constexpr int fine = 10;
  constexpr double signs[3][4] = {{-1, 1, 1, -1}, {1, -1, 1, -1}, {1, 1, -1, -1}};
  constexpr double effectiveness[3] = {40, 40, 3.3};
  std::mt19937_64 engine(vehicle.seed);
  const double dt = vehicle.period_s / fine;
  std::array<double, 4> command{}, motor{0.5, 0.5, 0.5, 0.5};
  std::array<double, 3> wanted{};
  std::deque<std::array<double, 4>> queue(static_cast<std::size_t>(std::lround(vehicle.delay_s / dt)) + 1, motor);
  Vector3<double> rates = Vector3<double>::Zero();
  Quaternion<double> q = from_euler(EulerAngles<double>{0.2, -0.1, 2.2});
  Flight flight;
  const auto rows = static_cast<int>(vehicle.duration_s / vehicle.period_s);
  for (int row = 0; row < rows; ++row) {
    // manoeuvres: a rate wanted per axis that changes now and then, and a loop that follows it and levels
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (row % static_cast<int>(0.3 / vehicle.period_s) == 0)
        wanted[axis] = (axis == 2 ? 0.3 : 1.0) * standard_normal(engine);
    }
    const EulerAngles<double> angles = to_euler(q);
    const double collective = 0.49 + 0.05 * std::sin(1.7 * row * vehicle.period_s) + 0.02 * standard_normal(engine);
    for (std::size_t i = 0; i < 4; ++i) {
      command[i] = collective;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double tilt = axis == 0 ? angles.roll_rad : (axis == 1 ? angles.pitch_rad : 0);
        const double loop =
            (axis == 2 ? 0.15 : 0.05) * (wanted[axis] - 2 * tilt - rates[static_cast<Eigen::Index>(axis)]);
        command[i] += signs[axis][i] * loop;
      }
      command[i] = std::clamp(command[i] + 0.005 * standard_normal(engine), 0.0, 1.0);
    }
    Sample sample;
    const auto turning = [&](std::size_t axis) {
      double sum = 0;
      for (std::size_t i = 0; i < 4; ++i) sum += signs[axis][i] * motor[i];
      return effectiveness[axis] * sum - vehicle.rate_damping_1_s * rates[static_cast<Eigen::Index>(axis)];
    };
    const auto thrust = [&] { return 5 * (motor[0] + motor[1] + motor[2] + motor[3]); };
    sample.time_s = row * vehicle.period_s;
    sample.commands = command;
    sample.body_rates_rad_s = rates;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sample.angular_acceleration_rad_s2[static_cast<Eigen::Index>(axis)] =
          turning(axis) + vehicle.acceleration_noise_rad_s2 * standard_normal(engine);
    }
    sample.roll_rad = angles.roll_rad;
    sample.pitch_rad = angles.pitch_rad;
    sample.yaw_rad = angles.yaw_rad;
    sample.linear_acceleration_m_s2 =
        Vector3<double>(0, 0, -thrust()) + world_to_body(q, Vector3<double>(0, 0, 9.80665));
    sample.altitude_m = 10;
    flight.push_back(sample);
    for (int step = 0; step < fine; ++step) {
      queue.push_back(command);
      queue.pop_front();
      for (std::size_t i = 0; i < 4; ++i) {
        const double share = vehicle.motor_time_constant_s > 0 ? 1 - std::exp(-dt / vehicle.motor_time_constant_s) : 1;
        motor[i] += share * (queue.front()[i] - motor[i]);
      }
      for (std::size_t axis = 0; axis < 3; ++axis) rates[static_cast<Eigen::Index>(axis)] += dt * turning(axis);
      const double angle = rates.norm() * dt, factor = angle > 1e-12 ? std::sin(angle / 2) / rates.norm() : dt / 2;
      q = normalized(q *
                     Quaternion<double>{std::cos(angle / 2), factor * rates[0], factor * rates[1], factor * rates[2]});
    }
  }
  return flight;
}

}  // namespace pinnquad::test
