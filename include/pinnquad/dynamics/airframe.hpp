// SPDX-License-Identifier: MIT
// The values of a quadrotor, with SI names: its body, four rotors with their motors, its drag. Each file of airframes/
// fills in one quadrotor with its source.
// Contract: `struct Vehicle { static constexpr const char* name; template <class Scalar> static constexpr
// Airframe<Scalar> value(); };`
#pragma once

#include <array>
#include <limits>
#include <type_traits>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/core/status.hpp"
#include "pinnquad/core/types.hpp"

namespace pinnquad {

/// Sense of rotation seen from the side to which the rotor pulls, from above for an upright one. The reaction torque on
/// the body has the opposite sense: a counter-clockwise upright rotor yaws the body clockwise, which is positive about
/// FRD z.
enum class Spin : int { counter_clockwise = 1, clockwise = -1 };

/// Stands for a rotor's own time constant where the airframe's `rotor_time_constant_s` holds.
template <class Scalar>
inline constexpr Scalar as_airframe = Scalar(-1);

/// Place, axis, thrust and lag of one rotor, body frame. `{x, y, spin}` is one of Eq. (2): upright, in the plane of the
/// centre of gravity, its thrust proportional to its command.
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
constexpr Mask<Scalar> is_upright(const RotorMount<Scalar>& rotor) noexcept {
  return detail::equal(rotor.axis[0], Scalar(0)) && detail::equal(rotor.axis[1], Scalar(0)) &&
         detail::equal(rotor.axis[2], Scalar(-1));
}

/// True for an axis of length 1, to 0.001.
template <class Scalar>
constexpr Mask<Scalar> has_unit_axis(const RotorMount<Scalar>& rotor) noexcept {
  const Scalar square = rotor.axis[0] * rotor.axis[0] + rotor.axis[1] * rotor.axis[1] + rotor.axis[2] * rotor.axis[2];
  return square >= Scalar(0.998) && square <= Scalar(1.002);
}

/// Air density at which thrust coefficients are rated.
template <class Scalar>
inline constexpr Scalar rated_air_density_kg_m3 = Scalar(1.225);

/// Standard gravity (ISO 80000-3).
template <class Scalar>
inline constexpr Scalar standard_gravity_m_s2 = Scalar(9.80665);

/// The values of Table 1 and what Table 1 leaves out. A literal type: usable in static_assert and in flash.
/// There are four rotors (core/types.hpp says why).
template <class Scalar>
struct Airframe {
  Scalar mass_kg{};
  std::array<Scalar, 3> inertia_kg_m2{};  ///< Jx, Jy, Jz: the diagonal of J, FRD
  std::array<Scalar, 3>
      inertia_products_kg_m2{};  ///< Jxy, Jxz, Jyz: the other entries of J, -integral x y dm and so on
  std::array<RotorMount<Scalar>, rotor_count> rotors{};  ///< in the order of the commands
  Scalar thrust_coefficient{};                           ///< C_T = thrust / (rho n^2 D^4), n in rev/s
  Scalar power_coefficient{};                            ///< C_P = 2 pi torque / (rho n^2 D^5)
  Scalar propeller_diameter_m{};                         ///< D
  Scalar max_rotor_speed_rev_s{};                        ///< n at command 1
  Scalar rotor_time_constant_s{};                        ///< first-order lag of the thrust, of rotors without their own
  std::array<Scalar, 3> drag_area_m2{};                  ///< k_i of F_i = -k_i rho |v_i| v_i
  Scalar drag_deadband_m_s{};                            ///< no drag along an axis at or below this speed

  /// c_T of Eq. (2) at the rated density: thrust = c_T n^2, N s^2.
  constexpr Scalar dimensional_thrust_coefficient() const noexcept {
    const Scalar d = propeller_diameter_m;
    return thrust_coefficient * rated_air_density_kg_m3<Scalar> * d * d * d * d;
  }
  /// c_Q of Eq. (2) at the rated density: torque = c_Q n^2, N m s^2 (C_Q = C_P / 2 pi, docs/paper.md, deviation 5).
  constexpr Scalar dimensional_torque_coefficient() const noexcept {
    constexpr Scalar two_pi = Scalar(6.283185307179586);
    const Scalar d = propeller_diameter_m;
    return power_coefficient * rated_air_density_kg_m3<Scalar> * d * d * d * d * d / two_pi;
  }
  /// Thrust of a rotor of scale 1 at command 1 and rated density, N.
  constexpr Scalar max_rotor_thrust_N() const noexcept {
    return dimensional_thrust_coefficient() * max_rotor_speed_rev_s * max_rotor_speed_rev_s;
  }
  /// Reaction torque of a rotor of scale 1 at command 1 and rated density, N m.
  constexpr Scalar max_rotor_torque_N_m() const noexcept {
    return dimensional_torque_coefficient() * max_rotor_speed_rev_s * max_rotor_speed_rev_s;
  }
  /// Thrust-to-weight ratio at the rated density: what all rotors together pull up, along -z.
  constexpr Scalar thrust_to_weight() const noexcept {
    Scalar upward(0);
    for (const RotorMount<Scalar>& rotor : rotors) upward -= rotor.thrust_scale * rotor.axis[2];
    return upward * max_rotor_thrust_N() / (mass_kg * standard_gravity_m_s2<Scalar>);
  }
  /// Time constant of a rotor's growing thrust, s.
  constexpr Scalar rise_time_constant_s(std::size_t rotor) const noexcept {
    const Scalar own = rotors[rotor].rise_time_constant_s;
    return select(detail::equal(own, as_airframe<Scalar>), rotor_time_constant_s, own);
  }
  /// Time constant of a rotor's falling thrust, s.
  constexpr Scalar fall_time_constant_s(std::size_t rotor) const noexcept {
    const Scalar own = rotors[rotor].fall_time_constant_s;
    return select(detail::equal(own, as_airframe<Scalar>), rotor_time_constant_s, own);
  }
};

/// Calls `visit(number)` for every number of an airframe, in the order in which files and hashes hold them; a Spin is
/// one of them.
template <class AirframeType, class Visit>
constexpr void each_number(AirframeType& airframe, const Visit& visit) {
  const auto all = [&visit](auto& numbers) {
    for (auto& number : numbers) visit(number);
  };
  visit(airframe.mass_kg);
  all(airframe.inertia_kg_m2);
  all(airframe.inertia_products_kg_m2);
  for (auto& rotor : airframe.rotors) {
    visit(rotor.x_m);
    visit(rotor.y_m);
    visit(rotor.spin);
    visit(rotor.z_m);
    all(rotor.axis);
    visit(rotor.thrust_scale);
    visit(rotor.thrust_curve);
    visit(rotor.rise_time_constant_s);
    visit(rotor.fall_time_constant_s);
  }
  visit(airframe.thrust_coefficient);
  visit(airframe.power_coefficient);
  visit(airframe.propeller_diameter_m);
  visit(airframe.max_rotor_speed_rev_s);
  visit(airframe.rotor_time_constant_s);
  all(airframe.drag_area_m2);
  visit(airframe.drag_deadband_m_s);
}
/// How many those are.
inline constexpr int airframe_number_count = 16 + 11 * rotor_count;

/// True for a body whose principal axes are those of the body frame.
template <class Scalar>
constexpr Mask<Scalar> has_diagonal_inertia(const Airframe<Scalar>& airframe) noexcept {
  const auto& products = airframe.inertia_products_kg_m2;
  return detail::equal(products[0], Scalar(0)) && detail::equal(products[1], Scalar(0)) &&
         detail::equal(products[2], Scalar(0));
}

/// True for upright rotors whose commands are thrust fractions, with one lag, and a diagonal inertia: code for such an
/// airframe leaves out the rest (`template <bool plain>`).
template <class Scalar>
constexpr Mask<Scalar> is_plain(const Airframe<Scalar>& airframe) noexcept {
  Mask<Scalar> plain = has_diagonal_inertia(airframe);
  for (std::size_t i = 0; i < rotor_count; ++i) {
    plain = plain && is_upright(airframe.rotors[i]) && detail::equal(airframe.rotors[i].thrust_curve, Scalar(0)) &&
            detail::equal(airframe.rise_time_constant_s(i), airframe.rise_time_constant_s(0)) &&
            detail::equal(airframe.fall_time_constant_s(i), airframe.rise_time_constant_s(0));
  }
  return plain;
}

namespace detail {
/// Above zero and no larger than anything that was ever built; false for NaN and Inf.
template <class Scalar>
constexpr Mask<Scalar> plausible(Scalar value) noexcept {
  return value > Scalar(0) && value <= Scalar(1e9);
}
template <class Scalar>
constexpr Mask<Scalar> plausible_or_zero(Scalar value) noexcept {
  return value >= Scalar(0) && value <= Scalar(1e9);
}
/// True if |value| is plausible; either sign.
template <class Scalar>
constexpr Mask<Scalar> bounded(Scalar value) noexcept {
  return plausible_or_zero(select(value < Scalar(0), -value, value));
}
template <class Scalar, std::size_t Size>
constexpr Mask<Scalar> all_bounded(const std::array<Scalar, Size>& values) noexcept {
  Mask<Scalar> all(true);
  for (const Scalar& value : values) all = all && bounded(value);
  return all;
}

/// True for products of inertia that a body can have: S = tr(J) / 2 - J, the second moments of the mass, has no
/// negative eigenvalue (the triangle inequality of the principal moments), and J is invertible.
template <class Scalar>
constexpr Mask<Scalar> plausible_products(const Airframe<Scalar>& a) noexcept {
  const Mask<Scalar> diagonal = has_diagonal_inertia(a);
  if (all_of(diagonal)) return diagonal;
  const Scalar size = a.inertia_kg_m2[0] + a.inertia_kg_m2[1] + a.inertia_kg_m2[2];
  const auto determinant = [](Scalar x, Scalar y, Scalar z, Scalar xy, Scalar xz, Scalar yz) {
    return x * (y * z - yz * yz) - xy * (xy * z - yz * xz) + xz * (xy * yz - y * xz);
  };
  const Scalar jx = a.inertia_kg_m2[0] / size, jy = a.inertia_kg_m2[1] / size, jz = a.inertia_kg_m2[2] / size;
  const Scalar xy = a.inertia_products_kg_m2[0] / size, xz = a.inertia_products_kg_m2[1] / size,
               yz = a.inertia_products_kg_m2[2] / size;
  const Scalar half = Scalar(0.5), rounding = Scalar(64) * Scalar(std::numeric_limits<Scalar>::epsilon());
  const Scalar sx = half - jx, sy = half - jy, sz = half - jz;
  const Mask<Scalar> products = sx * sy - xy * xy >= -rounding && sx * sz - xz * xz >= -rounding &&
                                sy * sz - yz * yz >= -rounding && determinant(sx, sy, sz, -xy, -xz, -yz) >= -rounding &&
                                determinant(jx, jy, jz, xy, xz, yz) > rounding;
  return diagonal || (all_bounded(a.inertia_products_kg_m2) && products);
}

/// A rotor that can be built: bounded place, an axis of length 1 (to 0.001), a scale above 0, a rising curve, and time
/// constants of its own that are no less than 0.
template <class Scalar>
constexpr Mask<Scalar> plausible_rotor(const RotorMount<Scalar>& r) noexcept {
  const auto time_constant = [](Scalar own) { return equal(own, as_airframe<Scalar>) || plausible_or_zero(own); };
  return bounded(r.x_m) && bounded(r.y_m) && bounded(r.z_m) && has_unit_axis(r) &&
         (r.spin == Spin::clockwise || r.spin == Spin::counter_clockwise) && plausible(r.thrust_scale) &&
         r.thrust_curve >= Scalar(0) && r.thrust_curve <= Scalar(1) && time_constant(r.rise_time_constant_s) &&
         time_constant(r.fall_time_constant_s);
}
}  // namespace detail

/// Ok if such a body can exist and hover: positive mass, inertia that meets the triangle inequality about its principal
/// axes, positive rotor values, rotors at a place with an axis and a rising curve, thrust-to-weight above 1. Rotors
/// checks the allocation (rotor.hpp).
template <class Scalar>
constexpr Outcome<Scalar> check_airframe(const Airframe<Scalar>& a) noexcept {
  using detail::plausible;
  using detail::plausible_or_zero;
  const Scalar jx = a.inertia_kg_m2[0], jy = a.inertia_kg_m2[1], jz = a.inertia_kg_m2[2];
  const Mask<Scalar> body = plausible(a.mass_kg) && plausible(jx) && plausible(jy) && plausible(jz) && jx + jy >= jz &&
                            jy + jz >= jx && jz + jx >= jy && detail::plausible_products(a);
  const Mask<Scalar> rotors = plausible(a.thrust_coefficient) && plausible(a.power_coefficient) &&
                              plausible(a.propeller_diameter_m) && plausible(a.max_rotor_speed_rev_s) &&
                              plausible_or_zero(a.rotor_time_constant_s);
  const Mask<Scalar> drag = plausible_or_zero(a.drag_area_m2[0]) && plausible_or_zero(a.drag_area_m2[1]) &&
                            plausible_or_zero(a.drag_area_m2[2]) && plausible_or_zero(a.drag_deadband_m_s);
  Mask<Scalar> mounts(true);
  for (const RotorMount<Scalar>& rotor : a.rotors) mounts = mounts && detail::plausible_rotor(rotor);
  return select(body && rotors && mounts && drag && a.thrust_to_weight() > Scalar(1), Status::ok,
                Status::invalid_airframe);
}

namespace detail {
template <class Vehicle>
using AirframeOf = std::enable_if_t<(static_cast<void>(Vehicle::name),
                                     std::is_same_v<decltype(Vehicle::template value<double>()), Airframe<double>>)>;
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class T>
inline constexpr bool is_airframe = is_detected<detail::AirframeOf, T>;

}  // namespace pinnquad
