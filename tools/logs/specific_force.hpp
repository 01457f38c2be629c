// SPDX-License-Identifier: MIT
// The reading of an accelerometer at the centre of gravity in a row of a flight.
#pragma once

#include "pinnquad/core/rotation.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/dynamics/airframe.hpp"

namespace programs {

inline pinnquad::Quaternion<double> attitude(const pinnquad::Sample& sample) noexcept {
  return pinnquad::from_euler(pinnquad::EulerAngles<double>{sample.roll_rad, sample.pitch_rad, sample.yaw_rad});
}

/// f = v_dot + omega x v - R^T g, body FRD, m/s^2: at rest (0, 0, -9.81).
inline pinnquad::Vector3<double> specific_force_m_s2(const pinnquad::Sample& sample) noexcept {
  const pinnquad::Vector3<double> gravity(0, 0, pinnquad::standard_gravity_m_s2<double>);
  return sample.linear_acceleration_m_s2 + pinnquad::cross(sample.body_rates_rad_s, sample.velocity_m_s) -
         pinnquad::world_to_body(attitude(sample), gravity);
}

}  // namespace programs
