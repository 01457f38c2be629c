// SPDX-License-Identifier: MIT
// What a quadrotor is made of: literal values with SI names, each filled in by one file of airframes/ with its source.
// Contract: `struct Vehicle { static constexpr const char* name; template <class Scalar> static constexpr
// Airframe<Scalar> value(); };`
#pragma once

#include <array>
#include <type_traits>

#include "pinnquad/core/status.hpp"
#include "pinnquad/core/types.hpp"

namespace pinnquad {

/// Sense of rotation seen from above. The reaction torque on the body has the opposite sense: a counter-clockwise rotor
/// yaws the body clockwise, which is positive about FRD z.
enum class Spin : int { counter_clockwise = 1, clockwise = -1 };

/// Place and sense of one rotor, body frame; thrust acts along -z.
template <class Scalar>
struct RotorMount {
  Scalar x_m{};  ///< forward of the centre of gravity
  Scalar y_m{};  ///< right of the centre of gravity
  Spin spin{Spin::counter_clockwise};
};

/// Air density at which thrust coefficients are rated.
template <class Scalar>
inline constexpr Scalar rated_air_density_kg_m3 = Scalar(1.225);

/// Standard gravity (ISO 80000-3).
template <class Scalar>
inline constexpr Scalar standard_gravity_m_s2 = Scalar(9.80665);

/// The values of Table 1 and what Table 1 leaves out. A literal type: usable in static_assert and in flash.
template <class Scalar>
struct Airframe {
  Scalar mass_kg{};
  std::array<Scalar, 3> inertia_kg_m2{};                 ///< J = diag(Jx, Jy, Jz), FRD
  std::array<RotorMount<Scalar>, rotor_count> rotors{};  ///< in the order of the commands
  Scalar thrust_coefficient{};                           ///< C_T = thrust / (rho n^2 D^4), n in rev/s
  Scalar power_coefficient{};                            ///< C_P = 2 pi torque / (rho n^2 D^5)
  Scalar propeller_diameter_m{};                         ///< D
  Scalar max_rotor_speed_rev_s{};                        ///< n at command 1
  Scalar rotor_time_constant_s{};                        ///< first-order lag of the thrust command
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
  /// Thrust of one rotor at command 1 and rated density, N.
  constexpr Scalar max_rotor_thrust_N() const noexcept {
    return dimensional_thrust_coefficient() * max_rotor_speed_rev_s * max_rotor_speed_rev_s;
  }
  /// Reaction torque of one rotor at command 1 and rated density, N m.
  constexpr Scalar max_rotor_torque_N_m() const noexcept {
    return dimensional_torque_coefficient() * max_rotor_speed_rev_s * max_rotor_speed_rev_s;
  }
  /// Thrust-to-weight ratio at the rated density.
  constexpr Scalar thrust_to_weight() const noexcept {
    return Scalar(rotor_count) * max_rotor_thrust_N() / (mass_kg * standard_gravity_m_s2<Scalar>);
  }
};

namespace detail {
/// Above zero and no larger than anything that was ever built; false for NaN and Inf.
template <class Scalar>
constexpr bool plausible(Scalar value) noexcept {
  return value > Scalar(0) && value <= Scalar(1e9);
}
template <class Scalar>
constexpr bool plausible_or_zero(Scalar value) noexcept {
  return value >= Scalar(0) && value <= Scalar(1e9);
}
/// Of either sign.
template <class Scalar>
constexpr bool bounded(Scalar value) noexcept {
  return plausible_or_zero(value < Scalar(0) ? -value : value);
}
template <class Scalar, std::size_t Size>
constexpr bool all_bounded(const std::array<Scalar, Size>& values) noexcept {
  for (const Scalar value : values) {
    if (!bounded(value)) return false;
  }
  return true;
}
}  // namespace detail

/// Ok if such a body can exist and hover: positive mass, inertia that meets the triangle inequality, positive rotor
/// values, rotors at a place, thrust-to-weight above 1. The allocation is checked where it is built (rotor.hpp).
template <class Scalar>
constexpr Status check_airframe(const Airframe<Scalar>& a) noexcept {
  using detail::bounded;
  using detail::plausible;
  using detail::plausible_or_zero;
  const Scalar jx = a.inertia_kg_m2[0], jy = a.inertia_kg_m2[1], jz = a.inertia_kg_m2[2];
  const bool body = plausible(a.mass_kg) && plausible(jx) && plausible(jy) && plausible(jz) && jx + jy >= jz &&
                    jy + jz >= jx && jz + jx >= jy;
  const bool rotors = plausible(a.thrust_coefficient) && plausible(a.power_coefficient) &&
                      plausible(a.propeller_diameter_m) && plausible(a.max_rotor_speed_rev_s) &&
                      plausible_or_zero(a.rotor_time_constant_s);
  const bool drag = plausible_or_zero(a.drag_area_m2[0]) && plausible_or_zero(a.drag_area_m2[1]) &&
                    plausible_or_zero(a.drag_area_m2[2]) && plausible_or_zero(a.drag_deadband_m_s);
  bool mounts = true;
  for (const RotorMount<Scalar>& rotor : a.rotors) {
    mounts = mounts && bounded(rotor.x_m) && bounded(rotor.y_m) &&
             (rotor.spin == Spin::clockwise || rotor.spin == Spin::counter_clockwise);
  }
  if (!(body && rotors && mounts && drag)) return Status::invalid_airframe;
  return a.thrust_to_weight() > Scalar(1) ? Status::ok : Status::invalid_airframe;
}

namespace detail {
template <class T, class = void>
struct IsAirframe : std::false_type {};
template <class T>
struct IsAirframe<T, std::void_t<decltype(T::name), decltype(T::template value<double>())>>
    : std::is_same<decltype(T::template value<double>()), Airframe<double>> {};
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class T>
inline constexpr bool is_airframe = detail::IsAirframe<T>::value;

}  // namespace pinnquad
