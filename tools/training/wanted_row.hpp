// SPDX-License-Identifier: MIT
// A motion that is asked for, as a row: what a loop's feed-forward asks a model that is judged on rows.
#pragma once

#include "pinnquad/core/rotation.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/dynamics/state.hpp"

namespace programs {

/// `ground_z_m`: NED, what the altitude counts from.
inline pinnquad::Sample wanted_row(const pinnquad::State<double>& state, const pinnquad::Accelerations<double>& desired,
                                   double time_s, double ground_z_m = 0) {
  const pinnquad::EulerAngles<double> angles = pinnquad::to_euler(state.attitude);
  pinnquad::Sample sample;
  sample.time_s = time_s;
  sample.linear_acceleration_m_s2 = desired.linear_m_s2;
  sample.angular_acceleration_rad_s2 = desired.angular_rad_s2;
  sample.velocity_m_s = pinnquad::body_velocity(state);
  sample.body_rates_rad_s = state.body_rates_rad_s;
  sample.roll_rad = angles.roll_rad;
  sample.pitch_rad = angles.pitch_rad;
  sample.yaw_rad = angles.yaw_rad;
  sample.altitude_m = ground_z_m - state.position_m[2];
  return sample;
}

}  // namespace programs
