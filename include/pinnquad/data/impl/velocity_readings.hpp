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

PINNQUAD_BODY Vector3<double> VelocityReading::in_world(const Vector3<double>& column,
                                                        const Quaternion<double>& attitude) const {
  Vector3<double> read = in_axes(column, of_columns);
  for (int turn = 0; turn < turns; ++turn) {
    read = body_to_world(attitude, read);
    if (turn == 0) read = in_axes(read, of_world);
  }
  return read;
}

/// `use` with what motion_steps() takes.
template <class Use>
auto read_world_velocity(const Flight& flight, const std::vector<Quaternion<double>>& attitude,
                         const VelocityReading& reading, const Use& use) {
  std::vector<Vector3<double>> velocity;
  velocity.reserve(flight.size());
  for (std::size_t row = 0; row < flight.size(); ++row) {
    velocity.push_back(reading.in_world(flight[row].velocity_m_s, attitude[row]));
  }
  return use([&](std::size_t row) { return flight[row].time_s; },
             [&](std::size_t row) -> Vector3<double> { return velocity[row + 1] - velocity[row]; },
             [&](std::size_t row) {
               const AccelerationReading::Row read(flight[row], attitude[row]);
               const Vector3<double> derivative = reading.acceleration.body_derivative(read);
               return body_to_world(attitude[row], Vector3<double>(derivative + read.turning));
             });
}

PINNQUAD_BODY MotionBlocks world_velocity_sums(const Flight& flight, const std::vector<Quaternion<double>>& attitude,
                                               const VelocityReading& reading) {
  return read_world_velocity(flight, attitude, reading, [&](const auto& time_s, const auto& change, const auto& rate) {
    return motion_steps(flight.size(), time_s, change, rate, turning_step_s).sums();
  });
}

}  // namespace pinnquad::detail
