// SPDX-License-Identifier: MIT
// The course of a vehicle that nobody knows: a hover with sines, flying, back to the centre, and a figure-eight; and
// what its sensors say of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "pinnquad/control/trajectory.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/core/rotation.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/vehicle/vehicle_state.hpp"

namespace programs {

/// A trajectory (control/trajectory.hpp): hover until hover_s, an eight with a moving yaw until learnt_s, back to the
/// centre within home_s, then the default figure-eight of 4.8 m/s: slower where the thrust carries no such turn.
class VehicleCourse {
 public:
  static constexpr double hover_s = 10, home_s = 4, eight_s = 24;
  static constexpr double settled_s = 8;  ///< of the figure-eight: errors are of what comes after

  VehicleCourse(double thrust_to_weight, double learnt_s) : learnt_s_(learnt_s) {
    constexpr double two_pi = 6.283185307179586, share = 0.4;  // of the level acceleration that the thrust leaves
    const double spare = std::max(0.01, thrust_to_weight * thrust_to_weight - 1);
    const double level_m_s2 = share * pinnquad::standard_gravity_m_s2<double> * std::sqrt(spare);
    eight_.center_m = pinnquad::Vector3<double>(0, 0, -20);
    eight_.period_s = std::max(eight_.period_s, two_pi / std::sqrt(level_m_s2 / (4 * eight_.half_width_m)));
    flying_ = eight_;
    flying_.half_length_m = 3;
    flying_.half_height_m = 0.7;
    flying_.yaw_amplitude_rad = 0.6;
    flying_.period_s = std::max(9.0, 1.1 * eight_.period_s);
  }

  double eight_from_s() const { return learnt_s_ + home_s; }
  double end_s() const { return eight_from_s() + eight_s; }

  pinnquad::TrajectoryPoint<double> sample(double time_s) const noexcept {
    if (!(time_s < eight_from_s())) return eight_.sample(time_s - eight_from_s());
    return homewards(flying_.sample(time_s - hover_s), (time_s - learnt_s_) / home_s);
  }

 private:
  /// The point's distance from the centre, times a weight that falls from 1 at x = 0 to 0 at x = 1 with four
  /// derivatives that are continuous: 1 - 35 x^4 + 84 x^5 - 70 x^6 + 20 x^7.
  pinnquad::TrajectoryPoint<double> homewards(pinnquad::TrajectoryPoint<double> p, double x) const noexcept {
    if (!(x > 0)) return p;
    const double y = 1 - x, h = home_s;
    const double w = 1 - x * x * x * x * (35 + x * (-84 + x * (70 - 20 * x)));
    const double w1 = -140 * x * x * x * y * y * y / h, w2 = -420 * x * x * y * y * (y - x) / (h * h);
    const double w3 = -840 * x * y * (1 - 5 * x * y) / (h * h * h);
    const double w4 = -840 * (1 + x * (-12 + x * (30 - 20 * x))) / (h * h * h * h);
    const pinnquad::Vector3<double> d = p.position_m - eight_.center_m, d1 = p.velocity_m_s, d2 = p.acceleration_m_s2,
                                    d3 = p.jerk_m_s3, d4 = p.snap_m_s4;
    p.position_m = eight_.center_m + w * d;
    p.velocity_m_s = w * d1 + w1 * d;
    p.acceleration_m_s2 = w * d2 + 2 * w1 * d1 + w2 * d;
    p.jerk_m_s3 = w * d3 + 3 * w1 * d2 + 3 * w2 * d1 + w3 * d;
    p.snap_m_s4 = w * d4 + 4 * w1 * d3 + 6 * w2 * d2 + 4 * w3 * d1 + w4 * d;
    const double yaw = p.yaw_rad, yaw1 = p.yaw_rate_rad_s, yaw2 = p.yaw_acceleration_rad_s2;
    p.yaw_rad = w * yaw;
    p.yaw_rate_rad_s = w * yaw1 + w1 * yaw;
    p.yaw_acceleration_rad_s2 = w * yaw2 + 2 * w1 * yaw1 + w2 * yaw;
    return p;
  }

  double learnt_s_;
  pinnquad::FigureEight<double> eight_, flying_;
};

/// Sensors of real vehicles, each tick of 2 ms: white noise of body rates behind a low-pass of 1.6 ms, white and slow
/// noise of the velocity, slow noise of the attitude, standard deviations; all of it late.
class VehicleSensors {
 public:
  VehicleSensors(double tick_s, double delay_s, double noise, std::uint64_t seed)
      : tick_s_(tick_s),
        noise_(noise),
        engine_(0x73656e73u + 7919 * seed),
        late_(static_cast<std::size_t>(std::lround(delay_s / tick_s)) + 1) {}

  pinnquad::State<double> operator()(const pinnquad::State<double>& body) noexcept {
    constexpr double rates_rad_s = 0.035, velocity_m_s = 0.01, slow_m_s = 0.02, slow_rad = 0.005;
    constexpr double low_pass_s = 0.0016, velocity_s = 0.5, attitude_s = 2;
    pinnquad::State<double> seen = body;
    const double keeps = ticks_ == 0 ? 0 : std::exp(-tick_s_ / low_pass_s);
    for (int i = 0; i < 3; ++i) {
      rates_[i] = body.body_rates_rad_s[i] + keeps * (rates_[i] - body.body_rates_rad_s[i]);
      seen.body_rates_rad_s[i] = rates_[i] + normal(rates_rad_s);
      wander(velocity_[i], slow_m_s, velocity_s);
      seen.velocity_m_s[i] += velocity_[i] + normal(velocity_m_s);
      wander(attitude_[i], slow_rad, attitude_s);
    }
    const pinnquad::Quaternion<double> turn{1, attitude_[0] / 2, attitude_[1] / 2, attitude_[2] / 2};
    seen.attitude = pinnquad::normalized(body.attitude * turn);
    if (ticks_ == 0) std::fill(late_.begin(), late_.end(), seen);
    late_[ticks_++ % late_.size()] = seen;
    return late_[ticks_ % late_.size()];
  }

 private:
  double normal(double deviation) noexcept { return noise_ * deviation * pinnquad::standard_normal(engine_); }
  void wander(double& value, double deviation, double time_s) noexcept {
    value += -value * tick_s_ / time_s + normal(deviation * std::sqrt(2 * tick_s_ / time_s));
  }

  double tick_s_, noise_;
  std::mt19937_64 engine_;
  std::vector<pinnquad::State<double>> late_;
  std::size_t ticks_ = 0;
  pinnquad::Vector3<double> rates_ = pinnquad::Vector3<double>::Zero(), velocity_ = rates_, attitude_ = rates_;
};

}  // namespace programs
