// SPDX-License-Identifier: MIT
// Bodies of plausible_vehicle.hpp.
#pragma once

#include "pinnquad/regression/plausible_vehicle.hpp"

namespace pinnquad {

PINNQUAD_BODY bool is_told(const Estimate& estimate, double share) noexcept {
  return estimate.half_width <= share * std::abs(estimate.value);
}

PINNQUAD_BODY std::optional<ImplausibleNumber> implausible_lag(const Identification& found) {
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

PINNQUAD_BODY std::optional<ImplausibleNumber> implausible_effectiveness(const Identification& found,
                                                                         std::size_t axis) {
  constexpr std::array<const char*, 3> keys = {"roll_effectiveness_rad_s2", "pitch_effectiveness_rad_s2",
                                               "yaw_effectiveness_rad_s2"};
  constexpr std::array<const char*, 3> words = {"roll effectiveness", "pitch effectiveness", "yaw effectiveness"};
  const Estimate& turn = found.effectiveness_rad_s2[axis];
  const detail::PlausibleRange both = plausible::turn_rad_s2[axis], one = {both.least / 2, both.most / 2};
  if (!detail::is_taken(turn) || one.holds(turn.value)) return {};
  return ImplausibleNumber{keys[axis], words[axis], "rad/s^2", turn.value, one};
}

PINNQUAD_BODY std::optional<ImplausibleNumber> implausible_number(const Identification& found,
                                                                  const Airframe<double>& like) {
  if (const auto lag = implausible_lag(found)) return lag;
  const detail::PlausibleRange delays = plausible::delay_s;
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
    return ImplausibleNumber{
        axis == 0 ? "inertia_x" : "inertia_y",
        axis == 0 ? "moment of inertia Jx over mass and arm squared" : "moment of inertia Jy over mass and arm squared",
        "", over_arms, plausible::inertia_over_arms};
  }
  return {};
}

PINNQUAD_BODY std::optional<double> unlike_axes(const Identification& found) {
  const Estimate &roll = found.effectiveness_rad_s2[0], &pitch = found.effectiveness_rad_s2[1];
  if (!detail::is_taken(roll) || !detail::is_taken(pitch)) return {};
  const double ratio = roll.value / pitch.value;
  if (ratio <= plausible::roll_over_pitch && ratio * plausible::roll_over_pitch >= 1) return {};
  return ratio;
}

}  // namespace pinnquad
