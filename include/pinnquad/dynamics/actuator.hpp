// SPDX-License-Identifier: MIT
// One rotor with its motor: where it sits, which way it pulls, how its thrust answers a command.
// Four of them make an airframe (dynamics/airframe.hpp); allocation and inverse are in dynamics/rotor.hpp.
#pragma once

#include <array>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/core/types.hpp"

namespace pinnquad {

/// Sense of rotation seen from the side to which the rotor pulls, from above for an upright one. The reaction torque on the
/// body has the opposite sense: a counter-clockwise upright rotor yaws the body clockwise, which is positive about FRD z.
enum class Spin : int { counter_clockwise = 1, clockwise = -1 };

/// In place of a rotor's time constant: the airframe's `rotor_time_constant_s` holds.
template <class Scalar>
inline constexpr Scalar as_airframe = Scalar(-1);

/// Place, axis and answer of one rotor, body frame. `{x, y, spin}` is an upright rotor in the plane of the centre of gravity
/// whose thrust is proportional to its command, as all of Eq. (2) are.
template <class Scalar>
struct RotorMount {
  Scalar x_m{};  ///< forward of the centre of gravity
  Scalar y_m{};  ///< right of the centre of gravity
  Spin spin{Spin::counter_clockwise};
  Scalar z_m{};                                                  ///< below the centre of gravity
  std::array<Scalar, 3> axis{Scalar(0), Scalar(0), Scalar(-1)};  ///< unit vector along the thrust, FRD
  Scalar thrust_scale{1};  ///< its thrust and torque over those of the airframe's coefficients
  Scalar thrust_curve{0};  ///< k of thrust_fraction(): 0 thrust proportional to the command, 1 to its square
  Scalar rise_time_constant_s{as_airframe<Scalar>};  ///< first-order lag of growing thrust
  Scalar fall_time_constant_s{as_airframe<Scalar>};  ///< and of falling thrust: propellers slow down by drag alone
};

/// True for thrust along -z, without lateral force.
template <class Scalar>
constexpr bool is_upright(const RotorMount<Scalar>& rotor) noexcept {
  return detail::equal(rotor.axis[0], Scalar(0)) && detail::equal(rotor.axis[1], Scalar(0)) &&
         detail::equal(rotor.axis[2], Scalar(-1));
}

/// True for an axis of length 1, to 0.001.
template <class Scalar>
constexpr bool has_unit_axis(const RotorMount<Scalar>& rotor) noexcept {
  const Scalar square = rotor.axis[0] * rotor.axis[0] + rotor.axis[1] * rotor.axis[1] + rotor.axis[2] * rotor.axis[2];
  return square >= Scalar(0.998) && square <= Scalar(1.002);
}

/// Thrust over that at command 1: s(u) = u ((1 - k) + k |u|), rising for k in 0..1, odd, so that an error keeps its direction.
/// The model of PX4's THR_MDL_FAC; k = 0 is a command that is (n / n_max)^2, k = 1 one that is a speed fraction n / n_max, and
/// a throttle of an electronic speed controller lies between.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE constexpr Scalar thrust_fraction(Scalar curve, Scalar command) noexcept {
  const Scalar magnitude = command < Scalar(0) ? -command : command;
  return command * ((Scalar(1) - curve) + curve * magnitude);
}

/// ds/du of thrust_fraction(), 0 only for k = 1 at u = 0.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE constexpr Scalar thrust_fraction_slope(Scalar curve, Scalar command) noexcept {
  const Scalar magnitude = command < Scalar(0) ? -command : command;
  return (Scalar(1) - curve) + Scalar(2) * curve * magnitude;
}

/// The command of a thrust fraction: u = 2 s / (1 - k + sqrt((1 - k)^2 + 4 k |s|)), which subtracts nothing and is s for k = 0.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar command_of_fraction(Scalar curve, Scalar fraction) noexcept {
  if (detail::equal(curve, Scalar(0))) return fraction;
  const Scalar linear = Scalar(1) - curve;
  const Scalar magnitude = fraction < Scalar(0) ? -fraction : fraction;
  const Scalar divisor = linear + detail::square_root(linear * linear + Scalar(4) * curve * magnitude);
  return divisor > Scalar(0) ? Scalar(2) * fraction / divisor : fraction;  // 0 / 0 at k = 1, s = 0; NaN stays NaN
}

}  // namespace pinnquad
