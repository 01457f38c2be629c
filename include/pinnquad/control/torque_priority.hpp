// SPDX-License-Identifier: MIT
// Torque before thrust: commands that leave their range give up collective thrust first, so that the attitude stays in hand.
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

/// What commands may be. A floor above 0 keeps the rotors turning.
template <class Scalar>
struct CommandRange {
  Scalar lower{0};
  Scalar upper{1};
};

namespace detail {

/// The thrusts t, in N, for which t along + turning lies within the ends for each rotor that has a part in pure thrust.
template <class Scalar>
struct ThrustInterval {
  Scalar least;
  Scalar most;
};
template <class Scalar>
ThrustInterval<Scalar> thrust_interval(const ThrustFractions<Scalar>& along, const ThrustFractions<Scalar>& turning,
                                       const ThrustFractions<Scalar>& lower, const ThrustFractions<Scalar>& upper,
                                       Scalar nothing) noexcept {
  ThrustInterval<Scalar> result{-std::numeric_limits<Scalar>::max(), std::numeric_limits<Scalar>::max()};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    if (!(along[i] > nothing)) continue;
    const Scalar least = (lower[i] - turning[i]) / along[i], most = (upper[i] - turning[i]) / along[i];
    if (least > result.least) result.least = least;
    if (most < result.most) result.most = most;
  }
  return result;
}

/// The greatest share, 0 to 1, of `part` that some thrust can carry on top of `base`: for each pair of rotors the floor of the
/// one must not lie above the ceiling of the other. 0 where `base` alone does not fit.
template <class Scalar>
Scalar share_that_fits(const ThrustFractions<Scalar>& along, const ThrustFractions<Scalar>& base,
                       const ThrustFractions<Scalar>& part, const ThrustFractions<Scalar>& lower,
                       const ThrustFractions<Scalar>& upper, Scalar nothing) noexcept {
  Scalar share(1);
  for (std::size_t i = 0; i < rotor_count; ++i) {
    for (std::size_t j = 0; j < rotor_count; ++j) {
      if (!(along[i] > nothing && along[j] > nothing)) continue;
      const Scalar room = (upper[j] - base[j]) / along[j] - (lower[i] - base[i]) / along[i];
      const Scalar taken = part[j] / along[j] - part[i] / along[i];
      if (taken * share > room) share = room > Scalar(0) ? room / taken : Scalar(0);
    }
  }
  return share;
}

}  // namespace detail

/// Commands within a range that make the torque of those given, of rotors that may differ, sit anywhere and have curves. What
/// does not fit gives way in this order: thrust, then yaw torque, then roll and pitch torque together, whose direction stays.
/// Commands within the range stay, to the bit. A rotor that has no part in pure thrust is clipped. NaN passes through.
template <class Scalar>
Commands<Scalar> keep_torque(const Rotors<Scalar>& rotors, const CommandRange<Scalar>& range,
                             const Commands<Scalar>& commands) noexcept {
  bool within = true;
  for (const Scalar u : commands) within = within && !(u < range.lower) && !(u > range.upper);
  if (within) return commands;
  const ThrustFractions<Scalar> lower = rotors.fractions({range.lower, range.lower, range.lower, range.lower}),
                                upper = rotors.fractions({range.upper, range.upper, range.upper, range.upper}),
                                along = rotors.fractions_of_pure_thrust_1_N();
  Scalar nothing(0);
  for (const Scalar step : along) nothing = Scalar(1e-3) * step > nothing ? Scalar(1e-3) * step : nothing;

  const Wrench<Scalar> wanted = rotors.wrench(commands, Scalar(1));
  Wrench<Scalar> tilting, yawing;
  tilting.torque_N_m = Vector3<Scalar>(wanted.torque_N_m[0], wanted.torque_N_m[1], Scalar(0));
  yawing.torque_N_m[2] = wanted.torque_N_m[2];
  ThrustFractions<Scalar> turning = rotors.fractions_for(tilting, Scalar(1));
  const ThrustFractions<Scalar> yaw = rotors.fractions_for(yawing, Scalar(1));
  const Scalar tilt_share = detail::share_that_fits<Scalar>(along, {}, turning, lower, upper, nothing);
  for (Scalar& s : turning) s *= tilt_share;
  const Scalar yaw_share = detail::share_that_fits(along, turning, yaw, lower, upper, nothing);
  for (std::size_t i = 0; i < rotor_count; ++i) turning[i] += yaw_share * yaw[i];

  const auto [least, most] = detail::thrust_interval(along, turning, lower, upper, nothing);
  Scalar thrust_N = -wanted.force_N[2];
  if (thrust_N > most) thrust_N = most;
  if (thrust_N < least) thrust_N = least;
  Commands<Scalar> result{};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const Scalar s = thrust_N * along[i] + turning[i];
    result[i] = s < lower[i] ? lower[i] : (s > upper[i] ? upper[i] : s);
  }
  result = rotors.commands_of(result);
  for (Scalar& u : result)
    u = u < range.lower ? range.lower : (u > range.upper ? range.upper : u);  // a curve's rounding
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
