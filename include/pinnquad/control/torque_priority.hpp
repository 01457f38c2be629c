// SPDX-License-Identifier: MIT
// Torque before thrust: commands that leave 0..1 give up collective thrust first, so that the attitude stays in hand.
#pragma once

#include "pinnquad/core/types.hpp"

namespace pinnquad {

/// Shifts all commands together so that the largest is at most 1; then, where the spread allows, so that the smallest
/// is at least 0. Equal rotors: the torques stay, thrust changes. Does nothing to commands in 0..1. A spread above 1
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

/// True if a rotor is at its end: nothing, or its limit.
template <class Scalar>
constexpr bool saturated(const Commands<Scalar>& commands) noexcept {
  bool at_end = false;
  for (const Scalar u : commands) at_end |= !(u > Scalar(0) && u < Scalar(1));
  return at_end;
}

}  // namespace pinnquad
