// SPDX-License-Identifier: MIT
// One rotor with its motor: the meaning of its command; command <-> thrust and speed by its curve, clipped; thrust
// follows with a first-order lag, exact for commands held over a step.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/first_of.hpp"
#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/dynamics/airframe.hpp"

namespace pinnquad {

/// Thrust of each rotor over its thrust at command 1, in the air and at the battery of the moment. A command is one
/// where all curves are straight (RotorMount::thrust_curve 0).
template <class Scalar>
using ThrustFractions = std::array<Scalar, rotor_count>;

/// Thrust over that at command 1: s(u) = u ((1 - k) + k |u|), rising for k in 0..1, odd, so that an error keeps its
/// direction. The model of PX4's THR_MDL_FAC; k = 0 is a command that is (n / n_max)^2, k = 1 one that is a speed
/// fraction n / n_max, and a throttle of an electronic speed controller lies between.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE constexpr Scalar thrust_fraction(Scalar curve, Scalar command) noexcept {
  const Scalar magnitude = select(command < Scalar(0), Scalar(-command), command);
  return command * ((Scalar(1) - curve) + curve * magnitude);
}

/// ds/du of thrust_fraction(), 0 only for k = 1 at u = 0.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE constexpr Scalar thrust_fraction_slope(Scalar curve, Scalar command) noexcept {
  const Scalar magnitude = select(command < Scalar(0), Scalar(-command), command);
  return (Scalar(1) - curve) + Scalar(2) * curve * magnitude;
}

/// The command of a thrust fraction: u = 2 s / (1 - k + sqrt((1 - k)^2 + 4 k |s|)), s for k = 0; subtracts
/// no near numbers.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar command_of_fraction(Scalar curve, Scalar fraction) noexcept {
  const Mask<Scalar> straight = detail::equal(curve, Scalar(0));
  if (all_of(straight)) return fraction;
  const Scalar linear = Scalar(1) - curve;
  const Scalar magnitude = select(fraction < Scalar(0), Scalar(-fraction), fraction);
  const Scalar divisor = linear + detail::square_root(linear * linear + Scalar(4) * curve * magnitude);
  // 0 / 0 at k = 1, s = 0; NaN stays NaN
  return select(!straight && divisor > Scalar(0), Scalar(Scalar(2) * fraction / divisor), fraction);
}

namespace detail {
template <class Scalar>
PINNQUAD_ALWAYS_INLINE const RotorMount<Scalar>& rotor_of(const Airframe<Scalar>& airframe,
                                                          std::size_t rotor) noexcept {
  return first_of<RotorMount<Scalar>>(airframe.rotors)[rotor];
}
}  // namespace detail

/// Command of a rotor speed where thrust is proportional to the command, u = (n / n_max)^2 (docs/paper.md, deviation
/// 6): the thrust fraction of a speed, of any rotor.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE constexpr Scalar command_from_speed(const Airframe<Scalar>& airframe,
                                                           Scalar speed_rev_s) noexcept {
  const Scalar ratio = speed_rev_s / airframe.max_rotor_speed_rev_s;
  return ratio * ratio;
}

/// Rotor speed of a command in 0..1 where thrust is proportional to it, rev/s.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar speed_from_command(const Airframe<Scalar>& airframe, Scalar command) noexcept {
  return airframe.max_rotor_speed_rev_s * detail::square_root(command);
}

/// The command of a speed of one rotor by its own curve; it has the speed's sign.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar command_from_speed(const Airframe<Scalar>& airframe, std::size_t rotor,
                                                 Scalar speed_rev_s) noexcept {
  const Scalar fraction = command_from_speed(airframe, speed_rev_s);
  return command_of_fraction(detail::rotor_of(airframe, rotor).thrust_curve,
                             speed_rev_s < Scalar(0) ? -fraction : fraction);
}

/// Its slope, s: du/dn = 2 r / (n_max sqrt((1 - k)^2 + 4 k r^2)) with r = |n| / n_max; 1 / n_max for k = 1.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar command_slope_of_speed(const Airframe<Scalar>& airframe, std::size_t rotor,
                                                     Scalar speed_rev_s) noexcept {
  const Scalar curve = detail::rotor_of(airframe, rotor).thrust_curve;
  const Scalar n_max = airframe.max_rotor_speed_rev_s;
  const Scalar magnitude = speed_rev_s < Scalar(0) ? -speed_rev_s : speed_rev_s;
  const Scalar straight = Scalar(2) * magnitude / (n_max * n_max);
  if (detail::equal(curve, Scalar(0))) return straight;
  const Scalar ratio = magnitude / n_max, linear = Scalar(1) - curve;
  const Scalar bend = detail::square_root(linear * linear + Scalar(4) * curve * (ratio * ratio));
  return detail::equal(bend, Scalar(0)) ? Scalar(1) / n_max : straight / bend;  // 0 / 0 at k = 1, n = 0; NaN stays NaN
}

/// The speed of a command in 0..1 of one rotor by its own curve, rev/s.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar speed_from_command(const Airframe<Scalar>& airframe, std::size_t rotor,
                                                 Scalar command) noexcept {
  return speed_from_command(airframe, thrust_fraction(detail::rotor_of(airframe, rotor).thrust_curve, command));
}

/// The command, or all four, held between 0 and 1. NaN stays NaN.
template <class Scalar>
constexpr Scalar clip_command(Scalar command) noexcept {
  return select(command < Scalar(0), Scalar(0), select(command > Scalar(1), Scalar(1), command));
}
/// All four commands, each held between 0 and 1.
template <class Scalar>
constexpr Commands<Scalar> clipped(const Commands<Scalar>& commands) noexcept {
  return {clip_command(commands[0]), clip_command(commands[1]), clip_command(commands[2]), clip_command(commands[3])};
}

/// a = exp(-dt / tau) of s <- a s + (1 - a) s_wanted, for all rotors or for each. A time constant of 0 means no lag.
template <class Scalar>
Scalar lag_factor(Scalar time_constant_s, Scalar step_s) noexcept {
  using std::exp;
  const Mask<Scalar> lags = time_constant_s > Scalar(0);
  return any_of(lags) ? select(lags, Scalar(exp(-step_s / time_constant_s)), Scalar(0)) : Scalar(0);
}
/// Lag factor of each rotor.
template <class Scalar>
std::array<Scalar, rotor_count> lag_factor(const std::array<Scalar, rotor_count>& time_constants_s,
                                           Scalar step_s) noexcept {
  std::array<Scalar, rotor_count> result{};
  for (std::size_t i = 0; i < rotor_count; ++i) result[i] = lag_factor(time_constants_s[i], step_s);
  return result;
}

namespace detail {
/// The value of one rotor, of one for all or one for each.
template <class Scalar>
constexpr Scalar of_rotor(Scalar all, std::size_t /*rotor*/) noexcept {
  return all;
}
template <class Scalar>
constexpr Scalar of_rotor(const std::array<Scalar, rotor_count>& each, std::size_t rotor) noexcept {
  return each[rotor];
}
}  // namespace detail

/// Each rotor's thrust fraction on its way from `filtered` to the fraction wanted, which is clipped. `factor` of
/// lag_factor(): one for all rotors or one for each.
template <class Scalar, class Factor>
constexpr ThrustFractions<Scalar> lagged(const ThrustFractions<Scalar>& filtered, const ThrustFractions<Scalar>& wanted,
                                         const Factor& factor) noexcept {
  ThrustFractions<Scalar> result{};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const Scalar target = clip_command(wanted[i]);
    result[i] = target + detail::of_rotor(factor, i) * (filtered[i] - target);
  }
  return result;
}

/// Each rotor's value for its way from `before` to the fraction wanted, of two: thrust approaches a held fraction from
/// one side, so that a rotor rises or falls all the step long.
template <class Scalar>
constexpr std::array<Scalar, rotor_count> by_direction(const ThrustFractions<Scalar>& before,
                                                       const ThrustFractions<Scalar>& wanted,
                                                       const std::array<Scalar, rotor_count>& rising,
                                                       const std::array<Scalar, rotor_count>& falling) noexcept {
  std::array<Scalar, rotor_count> result{};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    result[i] = select(clip_command(wanted[i]) >= before[i], rising[i], falling[i]);
  }
  return result;
}

/// Each rotor's time constant of growing thrust.
template <class Scalar>
constexpr std::array<Scalar, rotor_count> rise_time_constants_s(const Airframe<Scalar>& a) noexcept {
  return {a.rise_time_constant_s(0), a.rise_time_constant_s(1), a.rise_time_constant_s(2), a.rise_time_constant_s(3)};
}
/// Time constant of each rotor's falling thrust, s.
template <class Scalar>
constexpr std::array<Scalar, rotor_count> fall_time_constants_s(const Airframe<Scalar>& a) noexcept {
  return {a.fall_time_constant_s(0), a.fall_time_constant_s(1), a.fall_time_constant_s(2), a.fall_time_constant_s(3)};
}

/// The time constant of each rotor's way from `before` to the fraction wanted.
template <class Scalar>
constexpr std::array<Scalar, rotor_count> time_constants_s(const Airframe<Scalar>& airframe,
                                                           const ThrustFractions<Scalar>& before,
                                                           const ThrustFractions<Scalar>& wanted) noexcept {
  return by_direction(before, wanted, rise_time_constants_s(airframe), fall_time_constants_s(airframe));
}

/// The fractions at the start of a step: a rotor without lag has those of the end at once. One time constant for all
/// rotors or one for each.
template <class Scalar>
constexpr ThrustFractions<Scalar> at_start(const ThrustFractions<Scalar>& before, const ThrustFractions<Scalar>& end,
                                           Scalar time_constant_s) noexcept {
  return select(time_constant_s > Scalar(0), before, end);
}
/// Each rotor's fraction at the start of the step.
template <class Scalar>
constexpr ThrustFractions<Scalar> at_start(const ThrustFractions<Scalar>& before, const ThrustFractions<Scalar>& end,
                                           const std::array<Scalar, rotor_count>& time_constants_s) noexcept {
  ThrustFractions<Scalar> result{};
  for (std::size_t i = 0; i < rotor_count; ++i) result[i] = select(time_constants_s[i] > Scalar(0), before[i], end[i]);
  return result;
}

/// The meaning of a motor command. A model flies a vehicle only where both mean the same. The values are those of a
/// model block (exported/model_block.hpp).
enum class CommandMeaning : std::uint8_t {
  thrust = 0,    ///< u = (n / n_max)^2, the thrust over that at full command
  throttle = 1,  ///< the share of a speed controller's pulse range: thrust between a share and its square
  speed = 2,     ///< u = n / n_max
};

/// Number of meanings; values from here on are none.
inline constexpr unsigned command_meaning_count = 3;

/// By an airframe's curves (thrust_fraction()): all straight, all squares, or between.
template <class Scalar>
constexpr CommandMeaning command_meaning_of(const Airframe<Scalar>& airframe) noexcept {
  bool thrust = true, speed = true;
  for (const RotorMount<Scalar>& rotor : airframe.rotors) {
    thrust = thrust && detail::equal(rotor.thrust_curve, Scalar(0));
    speed = speed && detail::equal(rotor.thrust_curve, Scalar(1));
  }
  return thrust ? CommandMeaning::thrust : (speed ? CommandMeaning::speed : CommandMeaning::throttle);
}

/// In words.
constexpr const char* to_string(CommandMeaning meaning) noexcept {
  switch (meaning) {
    case CommandMeaning::thrust: return "thrust";
    case CommandMeaning::throttle: return "throttle";
    case CommandMeaning::speed: return "speed";
  }
  return "unknown";
}

}  // namespace pinnquad
