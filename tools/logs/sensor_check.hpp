// SPDX-License-Identifier: MIT
// Do a flight's sensors mean the same axes, the same zero and the same time? Over steps of 0.2 s the attitude turns by
// the integral of the rates, over steps of 0.4 s the velocity in the world changes by specific force and gravity. One
// regression for each pair, with intervals of blocks of time (regression/block_regression.hpp):
//   turning of the attitude - integral of w = r x (integral of w) - bias step + late (change of w)
//   change of v / step - g - f = r x f
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/motion_checks.hpp"

namespace pinnquad::logs {

struct SensorFinding {
  std::string words;
  bool may_be_heading = false;  ///< a heading that drifts, by which the whole attitude is misread
};

/// One for each thing that is off with its whole 95 % interval: rates by 0.04 rad/s on average (about z, where a
/// heading may drift, 0.012 rad/s); rates 20 ms behind the attitude; rates or specific force turned by 5 degrees
/// against the attitude, told to 5 degrees; a clock that is off by 0.6 %, in two of attitude by rates, velocity by
/// force, altitude by velocity alike. `has_velocity`: without one the specific force is not asked; `has_altitude`
/// likewise. Measured, ends of the intervals that lie nearest to zero, of 25 healthy flights: 0.025 (z: 0.004) rad/s,
/// 14 ms, 3 and 1 degrees. Limits: fewer than 16 steps decide nothing. An offset of the accelerometer of 0.9 m/s^2
/// looks like 5 degrees. A specific force that was computed of the velocity agrees with it.
std::vector<SensorFinding> check_sensors(const Flight& flight, bool has_velocity, bool has_altitude);

/// A mistake where the attitude plainly turns by less than three quarters, or more than four thirds, of what the rates
/// integrate to over steps of 0.2 s, whichever of the two has the noise: counts of a quaternion that stand for another
/// number, a gyro of another range.
std::optional<detail::Implausible> find_turning_of_other_size(const Flight& flight);

}  // namespace pinnquad::logs
