// SPDX-License-Identifier: MIT
// An agile pilot who flies at random: smooth velocities in all directions up to a limit, turns, and busy thumbs.
// His flights excite every input of the inverse dynamics; the same engine state gives the same flight.
#pragma once

#include <cmath>

#include "pinnquad/core/random.hpp"
#include "pinnquad/simulation/pilot.hpp"

namespace pinnquad {

/// How the random pilot flies.
struct PilotStyle {
  double max_speed_m_s{8};  ///< of what is flown; 95 % of it is asked for, and less as soon as `easing_share` is passed
  double easing_share{0.993};  ///< of max_speed_m_s: flown faster than this, the velocity asked for shrinks
  double max_climb_m_s{8};     ///< of a heavy vehicle less (pilot_style)
  double max_descent_m_s{8};   ///< nor a fall that leaves the rotors nothing to do
  double min_hold_s{0.8};      ///< a target velocity is held between these two times
  double max_hold_s{2.6};
  double velocity_lag_s{0.45};  ///< the velocity asked for follows its target with this lag
  double max_yaw_rate_rad_s{1.0};
  double yaw_rate_lag_s{0.4};
  detail::ThumbStyle thumbs{};
  double lowest_m{10};  ///< box, heights above ground and distances from the origin
  double highest_m{60};
  double farthest_m{60};
  double braking_m{6};  ///< room left to the border when a target velocity is chosen
};

/// Draws a target velocity (any direction; the greatest speed and the vertical more often) and a yaw rate, holds them
/// for a random time, and asks for them with a lag, under stick noise. A component that would lead out of the box
/// before its time is up is turned round. A turn against the thrust limits can carry the vehicle past what was asked
/// for: beyond easing_share less velocity is asked for.
template <class Engine>
class RandomPilot {
 public:
  /// `ground_z_m`: NED z of the ground (Site). The engine is the pilot's own from here on.
  explicit RandomPilot(const Engine& engine, const PilotStyle& style = {}, double ground_z_m = 0)
      : engine_(engine), style_(style), ground_z_m_(ground_z_m), sticks_(style.thumbs) {}

  SetPoint<double> operator()(const State<double>& state, double time_s) {
    if (time_s >= next_target_s_) {
      next_target_s_ = time_s + uniform(engine_, style_.min_hold_s, style_.max_hold_s);
      choose_target(state, next_target_s_ - time_s);
    }
    sticks_.follow(engine_, style_, time_s);
    return eased(state.velocity_m_s.norm());
  }

  const PilotStyle& style() const noexcept { return style_; }

 private:
  void choose_target(const State<double>& state, double hold_s) {
    constexpr double two_pi = 6.283185307179586;
    constexpr double beyond = 1.25;     // draws past the limits are cut: the limits themselves are flown often
    constexpr double overshoot = 0.95;  // of the limit is asked for; the flown speed stays near it
    const double down = within(uniform(engine_, -beyond, beyond), 1);
    const double level = std::sqrt(1 - down * down);
    const double course = uniform(engine_, 0, two_pi);
    const double speed = overshoot * style_.max_speed_m_s * within(beyond * std::sqrt(uniform_01(engine_)), 1);
    Vector3<double> velocity(speed * level * std::cos(course), speed * level * std::sin(course), speed * down);

    const Vector3<double> lowest(-style_.farthest_m, -style_.farthest_m, ground_z_m_ - style_.highest_m);
    const Vector3<double> highest(style_.farthest_m, style_.farthest_m, ground_z_m_ - style_.lowest_m);
    for (int i = 0; i < 3; ++i) {
      const double there = state.position_m[i] + velocity[i] * hold_s;
      const double magnitude = velocity[i] < 0 ? -velocity[i] : velocity[i];
      if (there > highest[i] - style_.braking_m) velocity[i] = -magnitude;
      if (there < lowest[i] + style_.braking_m) velocity[i] = magnitude;
    }
    if (velocity[2] < -style_.max_climb_m_s) velocity[2] = -style_.max_climb_m_s;
    if (velocity[2] > style_.max_descent_m_s) velocity[2] = style_.max_descent_m_s;
    sticks_.target_velocity_m_s = velocity;
    sticks_.choose_yaw_rate(engine_, style_.max_yaw_rate_rad_s);
  }

  static double within(double value, double most) { return value > most ? most : (value < -most ? -most : value); }

  /// The set point, its velocity shrunk by (v - easing) / (max - easing), v the speed flown: all of it at
  /// easing_share, none at the greatest speed.
  SetPoint<double> eased(double speed_m_s) const {
    const double easing_m_s = style_.easing_share * style_.max_speed_m_s;
    SetPoint<double> result = sticks_.wanted;
    if (speed_m_s > easing_m_s) {
      const double past = (speed_m_s - easing_m_s) / (style_.max_speed_m_s - easing_m_s);
      result.velocity_m_s *= past < 1 ? 1 - past : 0;
    }
    return result;
  }

  Engine engine_;
  PilotStyle style_;
  double ground_z_m_;
  detail::RandomSticks sticks_;
  double next_target_s_{0};
};

}  // namespace pinnquad
