// SPDX-License-Identifier: MIT
// Where a set point comes from in an external mode, in which none of PX4's own tasks publishes one: a trajectory (from
// a companion computer), else a place to go to, else the pilot's sticks. Pure C++17. Missions are not followed.
#pragma once

#include <cmath>
#include <limits>

#include "neural_control_core.hpp"

namespace pinnquad_px4 {

/// PX4's goto_setpoint: a place, and a heading if `flag_control_heading`.
struct GotoSetpoint {
  std::uint64_t timestamp{0};
  float position[3]{};  ///< NED, m
  bool flag_control_heading{false};
  float heading{0};  ///< rad
};

/// PX4's manual_control_setpoint, -1..1: right, forward, clockwise and up are positive.
struct ManualControlSetpoint {
  std::uint64_t timestamp{0};
  bool valid{false};
  float roll{0};
  float pitch{0};
  float yaw{0};
  float throttle{0};
};

/// How fast full sticks fly.
struct StickSpeeds {
  float horizontal_m_s = 5;
  float climb_m_s = 2;
  float descent_m_s = 1;
  float yaw_rate_rad_s = 1.5f;
};

/// The source that flies, tick by tick. A better source that falls silent leaves the next one to fly after
/// `silence_us`; moved sticks ask for a velocity along the heading, released ones brake, then nothing is asked for: the
/// controller holds its place.
class SetPointSource {
 public:
  enum class Kind : std::uint8_t { none, trajectory, place, sticks };
  static constexpr std::uint64_t silence_us = 500'000;
  static constexpr float dead_zone = 0.05f;
  static constexpr float stands_m_s = 0.3f;

  explicit SetPointSource(const StickSpeeds& speeds = {}) noexcept : speeds_(speeds) {}

  void speeds(const StickSpeeds& speeds) noexcept { speeds_ = speeds; }

  void take(const TrajectorySetpoint& m) noexcept {
    trajectory_ = m;
    trajectory_is_new_ = true;
  }
  void take(const GotoSetpoint& m) noexcept {
    place_ = m;
    place_is_new_ = true;
  }
  void take(const ManualControlSetpoint& m) noexcept { sticks_ = m; }

  /// True: `wanted` is for the controller. `heading`, `velocity_m_s`: the vehicle's, NED.
  bool choose(std::uint64_t now_us, const pinnquad::Heading<float>& heading, const float (&velocity_m_s)[3],
              TrajectorySetpoint& wanted) noexcept {
    if (fresh(trajectory_.timestamp, now_us)) {
      kind_ = Kind::trajectory;
      if (trajectory_is_new_) wanted = trajectory_;
      const bool taken = trajectory_is_new_;
      trajectory_is_new_ = false;
      return taken;
    }
    if (fresh(place_.timestamp, now_us)) {
      kind_ = Kind::place;
      if (place_is_new_) wanted = to_place();
      const bool taken = place_is_new_;
      place_is_new_ = false;
      return taken;
    }
    const bool flown_by_hand = sticks_.valid && fresh(sticks_.timestamp, now_us);
    const bool moved =
        flown_by_hand && (out(sticks_.roll) || out(sticks_.pitch) || out(sticks_.yaw) || out(sticks_.throttle));
    const float speed = std::sqrt(velocity_m_s[0] * velocity_m_s[0] + velocity_m_s[1] * velocity_m_s[1] +
                                  velocity_m_s[2] * velocity_m_s[2]);
    if (!moved && !(kind_ == Kind::sticks && speed > stands_m_s)) {
      kind_ = Kind::none;
      return false;
    }
    kind_ = Kind::sticks;
    wanted = by_sticks(now_us, heading, moved);
    return true;
  }

  Kind kind() const noexcept { return kind_; }

 private:
  static constexpr float not_asked = std::numeric_limits<float>::quiet_NaN();

  static bool fresh(std::uint64_t time_us, std::uint64_t now_us) noexcept {
    return time_us != 0 && now_us - time_us <= silence_us;
  }
  /// False for NaN.
  static bool out(float stick) noexcept { return stick > dead_zone || stick < -dead_zone; }
  /// Without its dead zone, within -1..1; 0 for NaN.
  static float beyond(float stick) noexcept {
    if (!out(stick)) return 0;
    const float past = (stick > 0 ? stick - dead_zone : stick + dead_zone) / (1 - dead_zone);
    return past > 1 ? 1 : (past < -1 ? -1 : past);
  }
  static TrajectorySetpoint nothing(std::uint64_t time_us) noexcept {
    TrajectorySetpoint all;
    all.timestamp = time_us;
    for (int i = 0; i < 3; ++i) all.position[i] = all.velocity[i] = all.acceleration[i] = all.jerk[i] = not_asked;
    all.yaw = all.yawspeed = not_asked;
    return all;
  }
  TrajectorySetpoint to_place() const noexcept {
    TrajectorySetpoint wanted = nothing(place_.timestamp);
    for (int i = 0; i < 3; ++i) wanted.position[i] = place_.position[i];
    if (place_.flag_control_heading) wanted.yaw = place_.heading;
    return wanted;
  }
  TrajectorySetpoint by_sticks(std::uint64_t now_us, const pinnquad::Heading<float>& heading,
                               bool moved) const noexcept {
    TrajectorySetpoint wanted = nothing(now_us);
    const float forward = moved ? beyond(sticks_.pitch) * speeds_.horizontal_m_s : 0;
    const float right = moved ? beyond(sticks_.roll) * speeds_.horizontal_m_s : 0;
    const float up = moved ? beyond(sticks_.throttle) : 0;
    wanted.velocity[0] = heading.cosine * forward - heading.sine * right;
    wanted.velocity[1] = heading.sine * forward + heading.cosine * right;
    wanted.velocity[2] = -up * (up > 0 ? speeds_.climb_m_s : speeds_.descent_m_s);
    wanted.yawspeed = moved ? beyond(sticks_.yaw) * speeds_.yaw_rate_rad_s : 0;
    return wanted;
  }

  StickSpeeds speeds_;
  TrajectorySetpoint trajectory_{};
  GotoSetpoint place_{};
  ManualControlSetpoint sticks_{};
  Kind kind_{Kind::none};
  bool trajectory_is_new_{false};
  bool place_is_new_{false};
};

}  // namespace pinnquad_px4
