// SPDX-License-Identifier: MIT
// An attitude for logs that hold none: the gyroscope turns it, and the accelerometer pulls it slowly upright,
// since a vehicle that goes nowhere for ever has a specific force of -g on average. Good for tilt to a few degrees;
// heading counts from where the log began, and drifts.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/core/rotation.hpp"
#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/logs/flight_log.hpp"

namespace pinnquad::logs {

/// FRD to NED, by rows in time's order.
class IntegratedAttitude {
 public:
  using Vector = std::array<double, 3>;

  /// `rates_rad_s` in FRD. `force_g`: specific force over g in FRD, at rest (0, 0, -1).
  Quaternion<double> next(double time_s, const Vector& rates_rad_s, const Vector& force_g) {
    if (!begun_) {
      begin(force_g);
    } else if (time_s > last_s_ && time_s - last_s_ < longest_step_s) {
      step(time_s - last_s_, rates_rad_s, force_g);
    }
    last_s_ = time_s;
    return q_;
  }

 private:
  static constexpr double longest_step_s = 1;
  static constexpr double upright_1_s = 0.15;  ///< of the way a second: far slower than a manoeuvre
  static constexpr double most_force_g = 3;    ///< a knock counts as that

  void begin(const Vector& f) {
    begun_ = std::isfinite(f[0] + f[1] + f[2]);
    const double size = std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    if (!begun_ || !(size > 0.5)) return;
    q_ = from_euler(EulerAngles<double>{std::atan2(-f[1], -f[2]), std::atan2(f[0], std::hypot(f[1], f[2])), 0});
  }

  void step(double dt, const Vector& w, const Vector& f) {
    // up in the body's axes, by the attitude and by the accelerometer
    const Vector up = {-2 * (q_.x * q_.z - q_.w * q_.y), -2 * (q_.y * q_.z + q_.w * q_.x),
                       -(1 - 2 * (q_.x * q_.x + q_.y * q_.y))};
    const double size = std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    const double share =
        std::isfinite(size) && size > 0 ? upright_1_s * (size > most_force_g ? most_force_g / size : 1) : 0;
    Vector turn{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      const double pull = share > 0 ? share * (f[j] * up[k] - f[k] * up[j]) : 0.0;
      turn[i] = (std::isfinite(w[i]) ? w[i] : 0.0) + pull;
    }
    const double rate = std::sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
    const double half = 0.5 * rate * dt, scale = rate > 0 ? std::sin(half) / rate : 0.0;
    q_ = q_ * Quaternion<double>{std::cos(half), scale * turn[0], scale * turn[1], scale * turn[2]};
    const double norm = std::sqrt(q_.w * q_.w + q_.x * q_.x + q_.y * q_.y + q_.z * q_.z);
    q_ = {q_.w / norm, q_.x / norm, q_.y / norm, q_.z / norm};
  }

  Quaternion<double> q_;
  double last_s_ = 0;
  bool begun_ = false;
};

/// Columns roll, pitch and heading, in degrees, of a gyroscope (deg/s) and a specific force (`g_per_unit` g) along x
/// forward, y left, z up: roll about x, pitch about y, heading clockwise. None where a column is missing.
inline void add_integrated_attitude(LogTopic& topic, const std::array<std::string, 3>& gyro_names,
                                    const std::array<std::string, 3>& force_names, double g_per_unit) {
  constexpr double degree = pi / 180;
  std::array<const LogColumn*, 3> gyro{}, force{};
  for (std::size_t i = 0; i < 3; ++i) {
    gyro[i] = topic.column(gyro_names[i]);
    force[i] = topic.column(force_names[i]);
    if (gyro[i] == nullptr || force[i] == nullptr) return;
  }
  IntegratedAttitude attitude;
  std::array<std::vector<double>, 3> angles;
  for (std::size_t row = 0; row < topic.size(); ++row) {
    IntegratedAttitude::Vector w{}, f{};
    for (std::size_t i = 0; i < 3; ++i) {
      w[i] = (i == 0 ? degree : -degree) * gyro[i]->values[row];
      f[i] = (i == 0 ? g_per_unit : -g_per_unit) * force[i]->values[row];
    }
    const EulerAngles<double> euler = to_euler(attitude.next(topic.time_s[row], w, f));
    angles[0].push_back(euler.roll_rad / degree);
    angles[1].push_back(-euler.pitch_rad / degree);
    angles[2].push_back(euler.yaw_rad / degree);
  }
  constexpr std::array<const char*, 3> names = {"roll", "pitch", "heading"};
  for (std::size_t i = 0; i < 3; ++i) topic.columns.push_back({names[i], std::move(angles[i]), {}});
}

}  // namespace pinnquad::logs
