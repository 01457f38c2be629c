// SPDX-License-Identifier: MIT
// The reading of an accelerometer at the centre of gravity in a row of a flight.
#pragma once

#include "pinnquad/core/rotation.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/dynamics/airframe.hpp"

namespace pinnquad::logs {

inline Quaternion<double> attitude(const Sample& sample) noexcept {
  return from_euler(EulerAngles<double>{sample.roll_rad, sample.pitch_rad, sample.yaw_rad});
}

/// f = v_dot + omega x v - R^T g, body FRD, m/s^2: at rest (0, 0, -9.81).
inline Vector3<double> specific_force_m_s2(const Sample& sample) noexcept {
  const Vector3<double> gravity(0, 0, standard_gravity_m_s2<double>);
  return sample.linear_acceleration_m_s2 + cross(sample.body_rates_rad_s, sample.velocity_m_s) -
         world_to_body(attitude(sample), gravity);
}

}  // namespace pinnquad::logs
