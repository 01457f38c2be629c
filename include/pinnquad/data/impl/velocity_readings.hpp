// SPDX-License-Identifier: MIT
// Bodies of motion_checks.hpp: the ways in which columns of velocity and acceleration can be read.
#pragma once

#include "pinnquad/data/motion_checks.hpp"

namespace pinnquad::detail {

PINNQUAD_BODY EulerAngles<double> angles_of(const Sample& sample) {
  return {sample.roll_rad, sample.pitch_rad, sample.yaw_rad};
}

/// Attitudes of a flight whose angles `angles(row)` gives.
template <class Angles>
std::vector<Quaternion<double>> attitudes(std::size_t rows, const Angles& angles) {
  std::vector<Quaternion<double>> result;
  result.reserve(rows);
  for (std::size_t row = 0; row < rows; ++row) result.push_back(from_euler(angles(row)));
  return result;
}

PINNQUAD_BODY std::vector<Quaternion<double>> attitudes_of(const Flight& flight) {
  return attitudes(flight.size(), [&](std::size_t row) { return angles_of(flight[row]); });
}

PINNQUAD_BODY Vector3<double> in_axes(const Vector3<double>& v, std::size_t kind) {
  switch (kind) {
    case 1: return swap_enu_ned(v);
    case 2: return swap_flu_frd(v);
    case 3: return swap_enu_ned(swap_flu_frd(v));
    case 4: return swap_flu_frd(swap_enu_ned(v));
    default: return v;
  }
}

/// A reading of the columns that should hold the derivative of the body-frame velocity.
struct AccelerationReading {
  enum Kind { kinematic, without_turning, world_derivative, world, world_force, no_gravity, accelerometer };
  Kind kind = kinematic;
  std::size_t axes = 0;  ///< of a vector of the world: axes_kinds

  std::string text() const {
    const std::string in_world = axes == 0   ? " in axes north, east, down"
                                 : axes == 1 ? " in axes east, north, up"
                                             : " in axes of another convention (ENU, or z up)";
    switch (kind) {
      case without_turning: return "the world's acceleration in the body's axes (subtract w x v)";
      case world_derivative:
      case world: return "the world's acceleration" + in_world + " (turn it into the body, subtract w x v)";
      case world_force: return "the specific force" + in_world + " of the world (turn it into the body)";
      case no_gravity: return "that with gravity added once too often (an accelerometer's without gravity?)";
      case accelerometer: return "what an accelerometer reads (add gravity in the body's axes, subtract w x v)";
      case kinematic: break;
    }
    return "";
  }

  /// A row as every reading takes it.
  struct Row {
    Vector3<double> given, turning;  ///< of the columns; omega x v
    Quaternion<double> attitude;
  };

  Vector3<double> body_derivative(const Row& row) const {
    const Vector3<double>&given = row.given, &turning = row.turning;
    const Quaternion<double>& q = row.attitude;
    const bool falls = kind == world_force || kind == no_gravity || kind == accelerometer;
    const Vector3<double> gravity =
        falls ? world_to_body(q, Vector3<double>(0, 0, standard_gravity_m_s2<double>)) : Vector3<double>::Zero();
    switch (kind) {
      case without_turning: return given - turning;
      case world_derivative: return world_to_body(q, in_axes(given, axes)) - turning;
      case world: return world_to_body(q, in_axes(given + turning, axes)) - turning;
      case world_force: return world_to_body(q, in_axes(given + turning - gravity, axes)) + gravity - turning;
      case no_gravity: return given - gravity;
      case accelerometer: return given + gravity - turning;
      case kinematic: break;
    }
    return given;
  }
};
PINNQUAD_BODY MotionPair world_velocity_pair(const Flight& flight, const std::vector<Quaternion<double>>& attitude,
                                             const VelocityReading& reading) {
  std::vector<Vector3<double>> velocity, acceleration;
  velocity.reserve(flight.size());
  acceleration.reserve(flight.size());
  for (std::size_t row = 0; row < flight.size(); ++row) {
    const Sample& sample = flight[row];
    Vector3<double> read = in_axes(sample.velocity_m_s, reading.of_columns);
    for (int turn = 0; turn < reading.turns; ++turn) {
      read = body_to_world(attitude[row], read);
      if (turn == 0) read = in_axes(read, reading.of_world);
    }
    velocity.push_back(read);
    const Vector3<double> turning = cross(sample.body_rates_rad_s, sample.velocity_m_s);
    acceleration.push_back(body_to_world(attitude[row], Vector3<double>(sample.linear_acceleration_m_s2 + turning)));
  }
  return {flight.size(), [&](std::size_t row) { return flight[row].time_s; },
          [&](std::size_t row) -> Vector3<double> { return velocity[row + 1] - velocity[row]; },
          [&](std::size_t row) -> const Vector3<double>& { return acceleration[row]; }};
}

PINNQUAD_BODY MotionPair world_velocity_pair(const Flight& flight, const VelocityReading& reading) {
  return world_velocity_pair(flight, attitudes_of(flight), reading);
}

}  // namespace pinnquad::detail
