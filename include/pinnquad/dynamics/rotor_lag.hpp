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

/// Thrust fractions at the start, in the middle and at the end of a step.
template <class Scalar>
struct LaggedStep {
  ThrustFractions<Scalar> start, middle, end;
};

/// A step under fractions held over it, with one time constant for all. A rotor without lag has the wanted thrust at once.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE LaggedStep<Scalar> lagged_step(const ThrustFractions<Scalar>& before,
                                                      const ThrustFractions<Scalar>& wanted, Scalar time_constant_s,
                                                      Scalar step_s) noexcept {
  const Scalar half_factor = lag_factor(time_constant_s, step_s / Scalar(2));
  LaggedStep<Scalar> result;
  result.middle = lagged(before, wanted, half_factor);
  result.end = lagged(result.middle, wanted, half_factor);
  result.start = time_constant_s > Scalar(0) ? before : result.end;
  return result;
}

/// The same with each rotor's own time constants. Thrust approaches what is held from one side: a rotor rises or falls all the
/// step long.
template <class Scalar>
LaggedStep<Scalar> lagged_step(const ThrustFractions<Scalar>& before, const ThrustFractions<Scalar>& wanted,
                               const Airframe<Scalar>& airframe, Scalar step_s) noexcept {
  LaggedStep<Scalar> result;
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const Scalar target = clip_command(wanted[i]);
    const Scalar time_constant_s =
        target >= before[i] ? airframe.rise_time_constant_s(i) : airframe.fall_time_constant_s(i);
    const Scalar half_factor = lag_factor(time_constant_s, step_s / Scalar(2));
    result.middle[i] = target + half_factor * (before[i] - target);
    result.end[i] = target + half_factor * (result.middle[i] - target);
    result.start[i] = time_constant_s > Scalar(0) ? before[i] : result.end[i];
  }
  return result;
}

}  // namespace pinnquad
