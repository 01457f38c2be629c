// SPDX-License-Identifier: MIT
// One row of a recorded flight, and its flat form: the names and the order of its 21 numbers.
// The CSV files and the content hash both take names and order from here.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "pinnquad/core/types.hpp"

namespace pinnquad {

/// One row of a recorded flight: the motion at one instant and the commands that cause it.
/// Frames: body is FRD, the world NED; attitude is Euler ZYX, body to world. docs/guide.md has the same as columns of a
/// CSV.
struct Sample {
  double time_s = 0;  ///< strictly increasing from row to row; any start
  /// Derivative of the body-frame velocity, FRD: v_dot_B = R^T a_world - omega x v_B (Eq. (1)).
  Vector3<double> linear_acceleration_m_s2 = Vector3<double>::Zero();
  Vector3<double> angular_acceleration_rad_s2 = Vector3<double>::Zero();  ///< body, FRD
  Vector3<double> velocity_m_s = Vector3<double>::Zero();                 ///< relative to the ground, in body FRD
  Vector3<double> body_rates_rad_s = Vector3<double>::Zero();             ///< p, q, r
  double roll_rad = 0;
  double pitch_rad = 0;
  double yaw_rad = 0;
  double altitude_m = 0;  ///< of the vehicle's centre above the ground below it, positive up
  /// u_i, 0..1, as given to the motor at this instant, before its lag: (n_i / n_max)^2, which is thrust over the
  /// greatest thrust, unless the airframe's rotors have a curve (dynamics/actuator.hpp).
  /// Front right, rear left, front left, rear right: the order of Eq. (2).
  Commands<double> commands{};
};

inline constexpr std::size_t sample_value_count = 21;

/// The numbers of one Sample in the order of `sample_field_names`.
using SampleValues = std::array<double, sample_value_count>;

/// Column names of a recorded flight, in the order of `to_values`.
inline constexpr std::array<std::string_view, sample_value_count> sample_field_names = {
    // clang-format off
    "t",
    "vdot_bx", "vdot_by", "vdot_bz",
    "wdot_x", "wdot_y", "wdot_z",
    "v_bx", "v_by", "v_bz",
    "w_x", "w_y", "w_z",
    "roll", "pitch", "yaw",
    "altitude",
    "u1", "u2", "u3", "u4"};
// clang-format on

/// The sample as 21 numbers, ordered as `sample_field_names`.
inline SampleValues to_values(const Sample& sample) {
  const auto& v_dot = sample.linear_acceleration_m_s2;
  const auto& omega_dot = sample.angular_acceleration_rad_s2;
  const auto& v = sample.velocity_m_s;
  const auto& omega = sample.body_rates_rad_s;
  const auto& u = sample.commands;
  // clang-format off
  return {sample.time_s,
          v_dot[0], v_dot[1], v_dot[2],
          omega_dot[0], omega_dot[1], omega_dot[2],
          v[0], v[1], v[2],
          omega[0], omega[1], omega[2],
          sample.roll_rad, sample.pitch_rad, sample.yaw_rad,
          sample.altitude_m,
          u[0], u[1], u[2], u[3]};
  // clang-format on
}

/// The inverse of `to_values`.
inline Sample to_sample(const SampleValues& values) {
  const auto vector_at = [&values](std::size_t first) {
    return Vector3<double>(values[first], values[first + 1], values[first + 2]);
  };
  Sample sample;
  sample.time_s = values[0];
  sample.linear_acceleration_m_s2 = vector_at(1);
  sample.angular_acceleration_rad_s2 = vector_at(4);
  sample.velocity_m_s = vector_at(7);
  sample.body_rates_rad_s = vector_at(10);
  sample.roll_rad = values[13];
  sample.pitch_rad = values[14];
  sample.yaw_rad = values[15];
  sample.altitude_m = values[16];
  sample.commands = {values[17], values[18], values[19], values[20]};
  return sample;
}

}  // namespace pinnquad
