// SPDX-License-Identifier: MIT
// A pilot who flies low at random: take-offs, hovers, low traverses and landings, one sortie after the other.
// His flights show the ground effect at every height where it acts; the same engine state gives the same flight.
#pragma once

#include <cmath>
#include <cstdint>

#include "pinnquad/core/random.hpp"
#include "pinnquad/simulation/pilot.hpp"

namespace pinnquad {

/// How the near-ground pilot flies. Heights are those of the vehicle's centre above ground; what is flown stays within
/// some centimetres of what is asked for.
struct NearGroundStyle {
  double lowest_m{0.14};  ///< a landing ends between these two heights: on the legs, still on its rotors
  double lowest_stay_m{0.22};
  double lowest_flight_m{0.3};  ///< hovers and traverses keep between these two
  double highest_m{1.9};
  double max_speed_m_s{4};      ///< of a traverse; 95 % of it is asked for
  double hover_speed_m_s{0.4};  ///< a hover drifts up to this
  double max_climb_m_s{1.6};    ///< at the steepest of a take-off
  double max_descent_m_s{1.2};
  double max_vertical_acceleration_m_s2{3};  ///< of the height profile
  double min_hold_s{1.2};                    ///< a hover, a traverse, a stay on the ground takes between these two
  double max_hold_s{3.4};
  int max_legs{5};              ///< hovers and traverses between a take-off and its landing; below one it is one
  double velocity_lag_s{0.5};   ///< the velocity asked for follows its target with this lag
  double height_gain_1_s{1.5};  ///< climb asked for per height error
  double lead_s{0.33};          ///< climb asked for ahead of the profile: what the vehicle needs to follow
  double max_yaw_rate_rad_s{1.0};
  double yaw_rate_lag_s{0.4};
  detail::ThumbStyle thumbs{};
  double farthest_m{25};  ///< north and east of the origin
  double braking_m{3};    ///< room left to the border when a target velocity is chosen
};

/// Sorties without end: take-off, one to max_legs hovers and traverses, landing, a stay just above the ground. In
/// take-off, traverse and landing the height follows h(x) = h0 + (h1 - h0) (10 x^3 - 15 x^4 + 6 x^5), x = t / T; the
/// climb asked for is h' + lead h'' + gain (h - height). Velocities north and east and yaw rates are targets followed
/// with a lag, under stick noise.
template <class Engine>
class NearGroundPilot {
 public:
  enum class Phase { stay, take_off, hover, traverse, landing };

  /// `ground_z_m`: NED z of the ground (Site). The engine is the pilot's own from here on.
  explicit NearGroundPilot(const Engine& engine, const NearGroundStyle& style = {}, double ground_z_m = 0)
      : engine_(engine), style_(style), ground_z_m_(ground_z_m), sticks_(style.thumbs) {}

  SetPoint<double> operator()(const State<double>& state, double time_s) {
    time_s_ = time_s;
    const double height_m = ground_z_m_ - state.position_m[2];
    if (!started_) begin(height_m);
    if (time_s >= phase_end_s_) choose_next(state);
    sticks_.follow(engine_, style_, time_s);
    sticks_.wanted.velocity_m_s[2] = -climb(height_m);
    return sticks_.wanted;
  }

  const NearGroundStyle& style() const noexcept { return style_; }
  Phase phase() const noexcept { return phase_; }

 private:
  /// The first phase: a stay at the height where the flight starts.
  void begin(double height_m) {
    started_ = true;
    start_phase(Phase::stay, height_m, uniform(engine_, style_.min_hold_s, style_.max_hold_s));
    from_m_ = height_m;
  }

  void start_phase(Phase phase, double to_m, double duration_s) {
    phase_ = phase;
    phase_start_s_ = time_s_;
    phase_end_s_ = time_s_ + duration_s;
    from_m_ = to_m_;
    to_m_ = to_m;
  }

  void choose_next(const State<double>& state) {
    switch (phase_) {
      case Phase::stay:
        legs_left_ = 1;
        if (style_.max_legs >= 1) {  // drawn for one too, so that a seed flies the same whatever their number
          legs_left_ += static_cast<int>(uniform_index(engine_, static_cast<std::uint64_t>(style_.max_legs)));
        }
        change_height(Phase::take_off, flight_height_m(), style_.max_climb_m_s);
        drift(style_.hover_speed_m_s);
        return;
      case Phase::landing:
        start_phase(Phase::stay, to_m_, uniform(engine_, style_.min_hold_s, style_.max_hold_s));
        drift(style_.hover_speed_m_s);
        return;
      case Phase::take_off:
      case Phase::hover:
      case Phase::traverse:
        if (legs_left_ == 0) {
          change_height(Phase::landing, uniform(engine_, style_.lowest_m, style_.lowest_stay_m),
                        style_.max_descent_m_s);
          drift(style_.hover_speed_m_s);
          return;
        }
        --legs_left_;
        fly_leg(state);
        return;
    }
  }

  /// A hover or, twice as often, a traverse.
  void fly_leg(const State<double>& state) {
    const double hold_s = uniform(engine_, style_.min_hold_s, style_.max_hold_s);
    if (uniform_index(engine_, 3) == 0) {
      start_phase(Phase::hover, to_m_, hold_s);
      drift(style_.hover_speed_m_s);
      return;
    }
    const double height_m = flight_height_m();
    const double least_s = shortest_s(height_m, height_m < to_m_ ? style_.max_descent_m_s : style_.max_climb_m_s);
    start_phase(Phase::traverse, height_m, hold_s > least_s ? hold_s : least_s);
    constexpr double overshoot = 0.95;  // asked for, so that what is flown stays near the limit
    drift(overshoot * style_.max_speed_m_s);
    for (int i = 0; i < 2; ++i) {  // not out of the box
      double& velocity_m_s = sticks_.target_velocity_m_s[i];
      const double there = state.position_m[i] + velocity_m_s * (phase_end_s_ - time_s_);
      const double border = style_.farthest_m - style_.braking_m;
      if (there > border) velocity_m_s = -std::abs(velocity_m_s);
      if (there < -border) velocity_m_s = std::abs(velocity_m_s);
    }
  }

  /// Heights of hovers and traverses: low ones, where the ground effect acts, more often.
  double flight_height_m() {
    const double share = uniform_01(engine_);
    return style_.lowest_flight_m + (style_.highest_m - style_.lowest_flight_m) * share * std::sqrt(share);
  }

  /// A phase that goes to a height, at a steepness drawn up to the limit.
  void change_height(Phase phase, double to_m, double limit_m_s) {
    constexpr double gentlest = 0.4;  // of the limit
    const double steepest_m_s = limit_m_s * uniform(engine_, gentlest, 1);
    start_phase(phase, to_m, shortest_s(to_m, steepest_m_s));
  }

  /// Time that the profile to a height takes at least: steepest slope 15/8 of the mean, greatest acceleration
  /// 10 / sqrt(3) of the rise over the square of the time.
  double shortest_s(double to_m, double steepest_m_s) const {
    constexpr double slope = 1.875, bend = 5.773502691896258;
    const double rise_m = std::abs(to_m - to_m_);
    const double by_slope_s = slope * rise_m / steepest_m_s;
    const double by_bend_s = std::sqrt(bend * rise_m / style_.max_vertical_acceleration_m_s2);
    const double longer_s = by_slope_s > by_bend_s ? by_slope_s : by_bend_s;
    constexpr double least_s = 0.5;
    return longer_s > least_s ? longer_s : least_s;
  }

  /// A new target velocity of any course and up to a speed, and a new yaw rate.
  void drift(double max_speed_m_s) {
    constexpr double two_pi = 6.283185307179586;
    const double course = uniform(engine_, 0, two_pi);
    const double speed = max_speed_m_s * std::sqrt(uniform_01(engine_));
    sticks_.target_velocity_m_s[0] = speed * std::cos(course);
    sticks_.target_velocity_m_s[1] = speed * std::sin(course);
    sticks_.choose_yaw_rate(engine_, style_.max_yaw_rate_rad_s);
  }

  /// Climb asked for at a height, m/s up.
  double climb(double height_m) const {
    const double duration_s = phase_end_s_ - phase_start_s_;
    if (duration_s == 0) return style_.height_gain_1_s * (to_m_ - height_m);  // a stay of no time
    const double x = (time_s_ - phase_start_s_) / duration_s;
    const double rise_m = to_m_ - from_m_;
    const double profile_m = from_m_ + rise_m * x * x * x * (10 + x * (-15 + 6 * x));
    const double rate_m_s = rise_m / duration_s * 30 * x * x * (1 + x * (-2 + x));
    const double rate_change_m_s2 = rise_m / (duration_s * duration_s) * 60 * x * (1 + x * (-3 + 2 * x));
    return rate_m_s + style_.lead_s * rate_change_m_s2 + style_.height_gain_1_s * (profile_m - height_m);
  }

  Engine engine_;
  NearGroundStyle style_;
  double ground_z_m_;
  detail::RandomSticks sticks_;
  bool started_{false};
  double time_s_{0};
  Phase phase_{Phase::stay};
  double phase_start_s_{0};
  double phase_end_s_{0};
  double from_m_{0};  ///< heights of the profile
  double to_m_{0};
  int legs_left_{0};
};

}  // namespace pinnquad
