// SPDX-License-Identifier: MIT
// Ranges that hold the numbers of every quadrotor, from a nano of 30 g to a carrier of 30 kg, with a margin. A number
// outside of them is no vehicle's: commands were filtered, clipped or stamped late on their way into the log, a unit is
// mistaken, or the flights do not tell the number and the fit ran away.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/regression/identification.hpp"

namespace pinnquad {

/// True where the interval is no wider than this share of the value: then the number stands on the flights.
inline bool is_told(const Estimate& estimate, double share) noexcept {
  return estimate.half_width <= share * std::abs(estimate.value);
}

/// Ends of a range, both within it.
struct PlausibleRange {
  double least, most;
  constexpr bool holds(double value) const noexcept { return value >= least && value <= most; }
};

namespace plausible {
/// Grows with the propeller: 5 ms (the paper's simulator), 33 ms (5 inches), 60 ms (a Crazyflie's brushed motors), some
/// 0.1 s of 28 inches.
inline constexpr PlausibleRange rotor_lag_s{0, 0.2};
/// Before the lag: 5 ms (a gyro's filter of 40 Hz) to 0.1 s (a radio link). Below 0 by half of a coarse row, or by
/// commands that are stamped a tick late.
inline constexpr PlausibleRange delay_s{-0.06, 0.15};
/// Greatest angular acceleration from rest, rad/s^2: two rotors at command 1. 20 of a carrier, 1000 of a small racer.
inline constexpr std::array<PlausibleRange, 3> turn_rad_s2{{{15, 3000}, {15, 3000}, {1, 500}}};
/// Moment of inertia over mass and the square of the arm: 0.15 to 0.65 of the airframes here, 1 if all mass sat in the
/// motors. The arm may be an assumed one, a fifth of the true or five times as long.
inline constexpr PlausibleRange inertia_over_arms{0.01, 5};
/// Effectiveness of roll over that of pitch, either way: moments and arms of both are alike within this factor. Told,
/// not refused.
inline constexpr double roll_over_pitch = 3;
}  // namespace plausible

/// A number of an identification that lies outside of its range.
struct ImplausibleNumber {
  const char* key;    ///< "rotor_lag_s", as the numbers of an identification are called; "inertia_x" about an axis
  const char* words;  ///< "rotor lag"
  const char* unit;
  double value;
  PlausibleRange range;
};

namespace detail {

/// That an airframe would take: told to half of it, above 0.
inline bool is_taken(const Estimate& estimate) noexcept { return is_told(estimate, 0.5) && estimate.value > 0; }

}  // namespace detail

/// The rotor lags: one, or of growing and falling thrust.
inline std::optional<ImplausibleNumber> implausible_lag(const Identification& found) {
  const auto outside = [](const Estimate& lag) {
    return detail::is_taken(lag) && !plausible::rotor_lag_s.holds(lag.value);
  };
  if (outside(found.lag_s)) {
    return ImplausibleNumber{"rotor_lag_s", "rotor lag", "s", found.lag_s.value, plausible::rotor_lag_s};
  }
  const Estimate& apart = found.fall_after_rise_s;
  if (!(std::abs(apart.value) > apart.half_width)) return {};
  for (const bool rises : {true, false}) {
    const Estimate& lag = rises ? found.rise_s : found.fall_s;
    if (!outside(lag)) continue;
    return ImplausibleNumber{rises ? "rise_s" : "fall_s",
                             rises ? "rotor lag of growing thrust" : "rotor lag of falling thrust", "s", lag.value,
                             plausible::rotor_lag_s};
  }
  return {};
}

/// The effectiveness about an axis: of one rotor, and two turn the vehicle one way.
inline std::optional<ImplausibleNumber> implausible_effectiveness(const Identification& found, std::size_t axis) {
  constexpr std::array<const char*, 3> keys = {"roll_effectiveness_rad_s2", "pitch_effectiveness_rad_s2",
                                               "yaw_effectiveness_rad_s2"};
  constexpr std::array<const char*, 3> words = {"roll effectiveness", "pitch effectiveness", "yaw effectiveness"};
  const Estimate& turn = found.effectiveness_rad_s2[axis];
  const PlausibleRange both = plausible::turn_rad_s2[axis], one = {both.least / 2, both.most / 2};
  if (!detail::is_taken(turn) || one.holds(turn.value)) return {};
  return ImplausibleNumber{keys[axis], words[axis], "rad/s^2", turn.value, one};
}

/// The first number that no quadrotor has, with the arms of `like`. The delay, of which no airframe is made, counts
/// where its whole interval lies outside: the law that was fitted is then not the vehicle's. None: all are
/// plausible, or not told.
inline std::optional<ImplausibleNumber> implausible_number(const Identification& found, const Airframe<double>& like) {
  if (const auto lag = implausible_lag(found)) return lag;
  const PlausibleRange delays = plausible::delay_s;
  if (found.delay_s.low() > delays.most || found.delay_s.high() < delays.least) {
    return ImplausibleNumber{"delay_s", "delay before the rotor lag", "s", found.delay_s.value, delays};
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (const auto turn = implausible_effectiveness(found, axis)) return turn;
  }
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Estimate& turn = found.effectiveness_rad_s2[axis];
    if (!detail::is_taken(turn) || !detail::is_taken(found.thrust_m_s2)) continue;
    double arm_m = 0;
    for (const RotorMount<double>& rotor : like.rotors) {
      arm_m += std::abs(axis == 0 ? rotor.y_m : rotor.x_m) / rotor_count;
    }
    const double over_arms = found.thrust_m_s2.value / (turn.value * arm_m);
    if (plausible::inertia_over_arms.holds(over_arms)) continue;
    return ImplausibleNumber{axis == 0 ? "inertia_x" : "inertia_y",
                             axis == 0 ? "moment of inertia Jx over mass and arm squared"
                                       : "moment of inertia Jy over mass and arm squared",
                             "", over_arms, plausible::inertia_over_arms};
  }
  return {};
}

/// Effectiveness of roll over that of pitch, where both are told and further apart than a quadrotor's; none else.
inline std::optional<double> unlike_axes(const Identification& found) {
  const Estimate &roll = found.effectiveness_rad_s2[0], &pitch = found.effectiveness_rad_s2[1];
  if (!detail::is_taken(roll) || !detail::is_taken(pitch)) return {};
  const double ratio = roll.value / pitch.value;
  if (ratio <= plausible::roll_over_pitch && ratio * plausible::roll_over_pitch >= 1) return {};
  return ratio;
}

}  // namespace pinnquad
