// SPDX-License-Identifier: MIT
// The rotors' lag: thrust follows what is commanded with a first-order time constant, rising and falling.
// Exact for commands held over a step; it acts on thrust fractions, whatever a command means.
#pragma once

#include <cmath>

#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad {

/// a = exp(-dt / tau) of u_f <- a u_f + (1 - a) u. A time constant of zero means no lag.
template <class Scalar>
Scalar lag_factor(Scalar time_constant_s, Scalar step_s) noexcept {
  using std::exp;
  return time_constant_s > Scalar(0) ? Scalar(exp(-step_s / time_constant_s)) : Scalar(0);
}

/// Each rotor's thrust fraction on its way from `filtered` to the fraction wanted, which is clipped.
template <class Scalar>
constexpr ThrustFractions<Scalar> lagged(const ThrustFractions<Scalar>& filtered, const ThrustFractions<Scalar>& wanted,
                                         Scalar factor) noexcept {
  ThrustFractions<Scalar> result{};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const Scalar target = clip_command(wanted[i]);
    result[i] = target + factor * (filtered[i] - target);
  }
  return result;
}

/// The same with a factor for each rotor.
template <class Scalar>
constexpr ThrustFractions<Scalar> lagged(const ThrustFractions<Scalar>& filtered, const ThrustFractions<Scalar>& wanted,
                                         const std::array<Scalar, rotor_count>& factors) noexcept {
  ThrustFractions<Scalar> result{};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const Scalar target = clip_command(wanted[i]);
    result[i] = target + factors[i] * (filtered[i] - target);
  }
  return result;
}

/// The time constant of each rotor's way from `before` to the fraction wanted: thrust approaches what is held from one side, a
/// rotor rises or falls all the step long.
template <class Scalar>
constexpr std::array<Scalar, rotor_count> time_constants_s(const Airframe<Scalar>& airframe,
                                                           const ThrustFractions<Scalar>& before,
                                                           const ThrustFractions<Scalar>& wanted) noexcept {
  std::array<Scalar, rotor_count> result{};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    result[i] =
        clip_command(wanted[i]) >= before[i] ? airframe.rise_time_constant_s(i) : airframe.fall_time_constant_s(i);
  }
  return result;
}

/// lag_factor() of each.
template <class Scalar>
std::array<Scalar, rotor_count> lag_factor(const std::array<Scalar, rotor_count>& time_constants_s,
                                           Scalar step_s) noexcept {
  std::array<Scalar, rotor_count> result{};
  for (std::size_t i = 0; i < rotor_count; ++i) result[i] = lag_factor(time_constants_s[i], step_s);
  return result;
}

/// The fractions at the start of a step: a rotor without lag has what it has at the end at once.
template <class Scalar>
constexpr ThrustFractions<Scalar> at_start(const ThrustFractions<Scalar>& before, const ThrustFractions<Scalar>& end,
                                           Scalar time_constant_s) noexcept {
  return time_constant_s > Scalar(0) ? before : end;
}
template <class Scalar>
constexpr ThrustFractions<Scalar> at_start(const ThrustFractions<Scalar>& before, const ThrustFractions<Scalar>& end,
                                           const std::array<Scalar, rotor_count>& time_constants_s) noexcept {
  ThrustFractions<Scalar> result{};
  for (std::size_t i = 0; i < rotor_count; ++i) result[i] = time_constants_s[i] > Scalar(0) ? before[i] : end[i];
  return result;
}

}  // namespace pinnquad
