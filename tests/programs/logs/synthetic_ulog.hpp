// SPDX-License-Identifier: MIT
// A flight as PX4 would log it: each quantity a topic of its own.
#pragma once

#include <cmath>
#include <string>

#include "programs/logs/synthetic_flight.hpp"
#include "programs/logs/ulog_bytes.hpp"

namespace pinnquad_test {

inline std::string synthetic_ulog() {
  UlogBytes ulog;
  ulog.format("vehicle_attitude:uint64_t timestamp;uint64_t timestamp_sample;float[4] q;");
  ulog.format("vehicle_angular_velocity:uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;");
  ulog.format("vehicle_acceleration:uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;");
  ulog.format("actuator_motors:uint64_t timestamp;uint64_t timestamp_sample;float[4] control;");
  ulog.topic(0, 0, "vehicle_attitude").topic(0, 1, "vehicle_angular_velocity");
  ulog.topic(0, 2, "vehicle_acceleration").topic(0, 3, "actuator_motors");
  for (const pinnquad::Sample& sample : pinnquad::test::synthetic_flight()) {
    const auto row = [&](unsigned id, const auto& numbers) {
      const auto time_us = static_cast<std::uint64_t>(std::llround(1e6 * (1 + sample.time_s)));
      Bytes bytes;
      bytes.u64(time_us).u64(time_us);
      for (const double number : numbers) bytes.f32(static_cast<float>(number));
      ulog.data(id, bytes);
    };
    const auto q =
        pinnquad::from_euler(pinnquad::EulerAngles<double>{sample.roll_rad, sample.pitch_rad, sample.yaw_rad});
    const pinnquad::Vector3<double> force =
        sample.linear_acceleration_m_s2 - pinnquad::world_to_body(q, pinnquad::Vector3<double>(0, 0, 9.80665));
    const auto& w = sample.body_rates_rad_s;
    row(0, std::array<double, 4>{q.w, q.x, q.y, q.z});
    row(1, std::array<double, 3>{w[0], w[1], w[2]});
    row(2, std::array<double, 3>{force[0], force[1], force[2]});
    row(3, sample.commands);
  }
  return ulog.str();
}

}  // namespace pinnquad_test
