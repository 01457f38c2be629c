// SPDX-License-Identifier: MIT
#include "logs/tilt_check.hpp"

#include <algorithm>
#include <string>

#include "logs/specific_force.hpp"
#include "pinnquad/core/rotation.hpp"

namespace pinnquad::logs {
namespace {

/// The acceleration of level flight: thrust along the body's z axis bears the weight.
Vector3<double> acceleration_of_tilt(const Sample& sample) {
  constexpr double least_upright = 0.4;  // nearly on edge nothing is level
  const Vector3<double> down = body_to_world<double>(attitude(sample), Vector3<double>(0, 0, 1));
  return -standard_gravity_m_s2<double> / std::max(least_upright, down[2]) * Vector3<double>(down[0], down[1], 0);
}

Vector3<double> velocity_of(const Sample& sample, const detail::VelocityReading& reading) {
  return reading.in_world(sample.velocity_m_s, attitude(sample));
}

detail::MotionBlocks tilt_sums(const Flight& flight, const detail::VelocityReading& reading, bool has_altitude) {
  const auto rows = static_cast<double>(std::max<std::size_t>(1, flight.size()));
  const Vector3<double> level(1, 1, 0);
  Vector3<double> mean_tilt = Vector3<double>::Zero(), mean_velocity = mean_tilt;
  for (const Sample& sample : flight) {
    mean_tilt += acceleration_of_tilt(sample) / rows;
    mean_velocity += level.cwiseProduct(velocity_of(sample, reading)) / rows;
  }
  double product = 0, square = 0;
  for (const Sample& sample : flight) {
    const Vector3<double> v = level.cwiseProduct(velocity_of(sample, reading)) - mean_velocity;
    product += v.dot(acceleration_of_tilt(sample));
    square += v.squaredNorm();
  }
  const double drag_1_s = square > 0 ? std::max(0.0, product / square) : 0;
  return detail::motion_steps(
             flight.size(), [&](std::size_t row) { return flight[row].time_s; },
             [&](std::size_t row) {
               const Sample &first = flight[row], &next = flight[row + 1];
               Vector3<double> change = velocity_of(next, reading) - velocity_of(first, reading);
               change[2] = has_altitude ? first.altitude_m - next.altitude_m : 0;
               return change;
             },
             [&](std::size_t row) {
               const Vector3<double> v = velocity_of(flight[row], reading);
               Vector3<double> rate = acceleration_of_tilt(flight[row]) - mean_tilt - drag_1_s * (v - mean_velocity);
               rate[2] = has_altitude ? v[2] : 0;
               return rate;
             },
             detail::turning_step_s)
      .sums();
}

}  // namespace

std::optional<detail::Implausible> find_velocity_off_tilt(const Flight& flight, bool has_altitude) {
  using namespace detail;
  const MotionBlocks sums = tilt_sums(flight, {}, has_altitude);
  BestReading reading(sums);
  if (!(reading.as_it_stands() < agrees)) return std::nullopt;
  std::string best;
  const auto judge = [&](const VelocityReading& so, const char* text) {
    if (reading.takes(tilt_sums(flight, so, has_altitude))) best = text;
  };
  for (std::size_t kind = 0; kind < axes_kinds; ++kind) {
    judge({0, kind, 0}, "velocities in the world's axes");
    judge({2, 0, kind}, "velocities in the body's axes");
    if (kind > 0) judge({1, kind, 0}, "velocities in other axes of the body (x forward, y left, z up for FRD)");
    if (kind > 0) judge({1, 0, kind}, "velocities in another world's axes (ENU for NED, or z up)");
  }
  if (best.empty()) return std::nullopt;
  return Implausible{0, velocity_field,
                     std::string("a velocity that changes as the vehicle tilts") +
                         (has_altitude ? ", and the altitude with it," : "") +
                         " in the axes that the mapping says (the log has no accelerometer)",
                     best + reading.evidence()};
}

}  // namespace pinnquad::logs
