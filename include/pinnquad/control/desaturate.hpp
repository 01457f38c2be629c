// SPDX-License-Identifier: MIT
// Desaturation: commands that leave their range give up thrust first, then yaw torque, then roll and pitch torque, so
// that the attitude stays in hand.
#pragma once

#include <limits>

#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad {

namespace detail {

/// Ends of the thrust fractions, and the fractions that make thrust and no torque. A rotor whose part is below
/// `nothing` has no part in pure thrust.
template <class Scalar>
struct ThrustRoom {
  ThrustFractions<Scalar> lower, upper, along;
  Scalar nothing;

  constexpr bool carries(std::size_t rotor) const noexcept { return along[rotor] > nothing; }
};

template <class Scalar>
ThrustRoom<Scalar> thrust_room(const Rotors<Scalar>& rotors, Scalar lower, Scalar upper) noexcept {
  ThrustRoom<Scalar> room{rotors.fractions({lower, lower, lower, lower}),
                          rotors.fractions({upper, upper, upper, upper}),
                          {Scalar(1), Scalar(1), Scalar(1), Scalar(1)},
                          Scalar(0)};
  if (!rotors.balanced()) room.along = rotors.fractions_of_pure_thrust_1_N();
  for (const Scalar part : room.along) {
    if (Scalar(1e-3) * part > room.nothing) room.nothing = Scalar(1e-3) * part;
  }
  return room;
}

/// The steps t for which fractions + t along lies within the ends; empty where least > most.
template <class Scalar>
struct ThrustSteps {
  Scalar least{-std::numeric_limits<Scalar>::max()};
  Scalar most{std::numeric_limits<Scalar>::max()};
};
template <class Scalar>
ThrustSteps<Scalar> thrust_steps(const ThrustRoom<Scalar>& room, const ThrustFractions<Scalar>& fractions) noexcept {
  ThrustSteps<Scalar> result;
  for (std::size_t i = 0; i < rotor_count; ++i) {
    if (!room.carries(i)) continue;
    const Scalar least = (room.lower[i] - fractions[i]) / room.along[i];
    const Scalar most = (room.upper[i] - fractions[i]) / room.along[i];
    if (least > result.least) result.least = least;
    if (most < result.most) result.most = most;
  }
  return result;
}

template <class Scalar>
struct TorqueShares {
  Scalar tilt{1};
  Scalar yaw{1};
};

/// The greatest share, 0 to 1, of `tilt` that some share of `yaw` and some thrust can carry on top of `base`; then the
/// greatest share of `yaw`. For each pair of rotors the lower end of the one must not lie above the upper end of the
/// other:
///   tilt share * row.tilt + yaw share * row.yaw <= row.room
/// The yaw share is eliminated from each two rows that bound it from both sides (Fourier and Motzkin).
template <class Scalar>
TorqueShares<Scalar> shares_that_fit(const ThrustRoom<Scalar>& room, const ThrustFractions<Scalar>& base,
                                     const ThrustFractions<Scalar>& tilt, const ThrustFractions<Scalar>& yaw) noexcept {
  struct Row {
    Scalar tilt, yaw, room;
  };
  constexpr std::size_t most_rows = 2 + rotor_count * (rotor_count - 1);
  Row rows[most_rows] = {{Scalar(0), Scalar(-1), Scalar(0)}, {Scalar(0), Scalar(1), Scalar(1)}};
  std::size_t count = 2;
  Scalar largest(0);
  for (std::size_t i = 0; i < rotor_count; ++i) {
    for (std::size_t j = 0; j < rotor_count; ++j) {
      if (i == j || !(room.carries(i) && room.carries(j))) continue;
      const Row row{tilt[j] / room.along[j] - tilt[i] / room.along[i], yaw[j] / room.along[j] - yaw[i] / room.along[i],
                    (room.upper[j] - base[j]) / room.along[j] - (room.lower[i] - base[i]) / room.along[i]};
      if (row.yaw > largest) largest = row.yaw;
      rows[count++] = row;
    }
  }
  constexpr Scalar rounding = Scalar(64) * std::numeric_limits<Scalar>::epsilon();
  for (std::size_t i = 2; i < count; ++i) {  // rotors that yaw alike
    const Scalar magnitude = rows[i].yaw < Scalar(0) ? -rows[i].yaw : rows[i].yaw;
    if (magnitude <= rounding * largest) rows[i].yaw = Scalar(0);
  }
  TorqueShares<Scalar> share;
  const auto at_most = [](Scalar& value, Scalar taken, Scalar left) noexcept {
    if (taken * value > left) value = left > Scalar(0) ? left / taken : Scalar(0);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const Row& below = rows[i];
    if (detail::equal(below.yaw, Scalar(0))) at_most(share.tilt, below.tilt, below.room);
    if (!(below.yaw < Scalar(0))) continue;
    for (std::size_t j = 0; j < count; ++j) {
      const Row& above = rows[j];
      if (!(above.yaw > Scalar(0))) continue;
      at_most(share.tilt, below.tilt * above.yaw - above.tilt * below.yaw,
              below.room * above.yaw - above.room * below.yaw);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (rows[i].yaw > Scalar(0)) at_most(share.yaw, rows[i].yaw, rows[i].room - share.tilt * rows[i].tilt);
  }
  return share;
}

}  // namespace detail

/// Commands from `lower` to `upper` that keep the given torque as far as they can; rotors may differ, sit anywhere and
/// have curves. Thrust gives way first, then yaw torque, then roll and pitch torque by one share, so that their
/// direction stays. No torque is greater than asked or of the other sign. Commands within the range stay, to the bit. A
/// rotor that has no part in pure thrust is clipped. NaN passes through. A lower end above 0 keeps the rotors turning.
template <class Scalar>
Commands<Scalar> desaturate(const Rotors<Scalar>& rotors, const Commands<Scalar>& commands, Scalar lower = Scalar(0),
                            Scalar upper = Scalar(1)) noexcept {
  bool within = true;
  for (const Scalar u : commands) within = within && !(u < lower) && !(u > upper);
  if (within) return commands;
  const detail::ThrustRoom<Scalar> room = detail::thrust_room(rotors, lower, upper);
  ThrustFractions<Scalar> fractions = rotors.fractions(commands);
  detail::ThrustSteps<Scalar> steps = detail::thrust_steps(room, fractions);
  if (steps.least > steps.most) {  // no thrust carries this torque
    const Wrench<Scalar> wanted = rotors.wrench_of(fractions, Scalar(1));
    Wrench<Scalar> tilting, yawing;
    tilting.torque_N_m = Vector3<Scalar>(wanted.torque_N_m[0], wanted.torque_N_m[1], Scalar(0));
    yawing.torque_N_m[2] = wanted.torque_N_m[2];
    const ThrustFractions<Scalar> tilt = rotors.fractions_for(tilting, Scalar(1));
    const ThrustFractions<Scalar> yaw = rotors.fractions_for(yawing, Scalar(1));
    ThrustFractions<Scalar> base{};
    for (std::size_t i = 0; i < rotor_count; ++i) base[i] = fractions[i] - tilt[i] - yaw[i];
    const detail::TorqueShares<Scalar> share = detail::shares_that_fit(room, base, tilt, yaw);
    for (std::size_t i = 0; i < rotor_count; ++i) {
      fractions[i] = base[i] + share.tilt * tilt[i] + share.yaw * yaw[i];
    }
    steps = detail::thrust_steps(room, fractions);
  }
  Scalar step = steps.most < Scalar(0) ? steps.most : Scalar(0);
  if (steps.least > step) step = steps.least;
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const Scalar s = fractions[i] + step * room.along[i];
    fractions[i] = s < room.lower[i] ? room.lower[i] : (s > room.upper[i] ? room.upper[i] : s);
  }
  Commands<Scalar> result = rotors.commands_of(fractions);
  for (Scalar& u : result) {  // a curve's rounding
    u = u < lower ? lower : (u > upper ? upper : u);
  }
  return result;
}

/// True if a command is 0 or 1, beyond it or NaN.
template <class Scalar>
constexpr bool saturated(const Commands<Scalar>& commands) noexcept {
  bool at_end = false;
  for (const Scalar u : commands) at_end |= !(u > Scalar(0) && u < Scalar(1));
  return at_end;
}

}  // namespace pinnquad
