// SPDX-License-Identifier: MIT
// Torque before thrust: commands that leave 0..1 give up collective thrust first, so that the attitude stays in hand.
#pragma once

#include <limits>

#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad {

/// Shifts all commands together so that the largest is at most 1; then, where their range allows, so that the smallest
/// is at least 0. Equal rotors: the torques stay, thrust changes. Does nothing to commands in 0..1. A range above 1
/// can't fit: the rotors clip what is left. NaN passes through.
template <class Scalar>
constexpr Commands<Scalar> keep_torque(const Commands<Scalar>& commands) noexcept {
  Scalar smallest = commands[0];
  Scalar largest = commands[0];
  for (const Scalar u : commands) {
    if (u < smallest) smallest = u;
    if (u > largest) largest = u;
  }
  Scalar shift(0);
  if (largest > Scalar(1)) shift = Scalar(1) - largest;
  if (smallest + shift < Scalar(0)) {
    const Scalar rise = -(smallest + shift);
    const Scalar room = Scalar(1) - (largest + shift);
    shift += rise < room ? rise : room;
  }
  Commands<Scalar> result = commands;
  for (Scalar& u : result) u += shift;
  return result;
}

/// The same for rotors that may differ, sit anywhere and have curves: thrust fractions are shifted along those that make thrust
/// and no torque. Where these are alike and commands are thrust fractions it is the shift above.
template <class Scalar>
Commands<Scalar> keep_torque(const Rotors<Scalar>& rotors, const Commands<Scalar>& commands) noexcept {
  ThrustFractions<Scalar> fractions = rotors.fractions(commands);
  if (rotors.balanced()) return rotors.commands_of(keep_torque<Scalar>(fractions));
  const ThrustFractions<Scalar> along = rotors.fractions_of_pure_thrust_1_N();
  Scalar greatest(0);
  for (const Scalar step : along) greatest = step > greatest ? step : greatest;
  const Scalar nothing = greatest * Scalar(1e-3);
  // shifts at which the first rotor reaches its limit, and at which the last one leaves zero
  Scalar most = std::numeric_limits<Scalar>::max(), least = -most;
  for (std::size_t i = 0; i < rotor_count; ++i) {
    if (along[i] <= nothing && -along[i] <= nothing) continue;  // no shift of the others would bring this rotor back
    const Scalar to_zero = -fractions[i] / along[i], to_limit = (Scalar(1) - fractions[i]) / along[i];
    const Scalar upper = along[i] > Scalar(0) ? to_limit : to_zero, lower = along[i] > Scalar(0) ? to_zero : to_limit;
    if (upper < most) most = upper;
    if (lower > least) least = lower;
  }
  Scalar shift = most < Scalar(0) ? most : Scalar(0);
  if (least > shift) shift = least < most ? least : most;
  for (std::size_t i = 0; i < rotor_count; ++i) fractions[i] += shift * along[i];
  return rotors.commands_of(fractions);
}

/// True if a rotor is at its end: nothing, or its limit.
template <class Scalar>
constexpr bool saturated(const Commands<Scalar>& commands) noexcept {
  bool at_end = false;
  for (const Scalar u : commands) at_end |= !(u > Scalar(0) && u < Scalar(1));
  return at_end;
}

}  // namespace pinnquad
