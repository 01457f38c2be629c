// SPDX-License-Identifier: MIT
// The contract of an aerodynamic effect: a small value with one or both of two pure functions.
//   template <class Scalar> void surroundings(Surroundings<Scalar>&) const noexcept;      wind, density: what the air is
//   template <class Scalar> Wrench<Scalar> wrench(const AeroCondition<Scalar>&, const Airframe<Scalar>&) const noexcept;
// All `surroundings` run first, then the rotors, then each `wrench` in the order of the vehicle's effects.
// Optional: `template <class Scalar> auto bound(const Airframe<Scalar>&) const noexcept;` returns the effect that a vehicle
// keeps in its place, with what follows from the airframe worked out once.
// An effect whose wrench depends on the rotors says so, see `uses_rotor_wrench` and `has_thrust_branches`; one that is the same
// at every place and time may say so, see `varies_with`.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/dynamics/site.hpp"
#include "pinnquad/dynamics/state.hpp"

namespace pinnquad {

/// Sea-level density of the standard atmosphere, p / (R T) = 101325 / (287.053 * 288.15); the rho_0 by which rotor thrust
/// scales.
template <class Scalar>
inline constexpr Scalar standard_air_density_kg_m3 = Scalar(101325.0 / (287.053 * 288.15));

/// The air around the vehicle. The first three are given; effects set the rest.
template <class Scalar>
struct Surroundings {
  Scalar time_s{0};
  Vector3<Scalar> position_m = Vector3<Scalar>::Zero();  ///< NED
  Scalar altitude_m{0};                                  ///< above sea level
  Vector3<Scalar> wind_m_s = Vector3<Scalar>::Zero();    ///< NED, the air's velocity over ground
  Scalar air_density_kg_m3{standard_air_density_kg_m3<Scalar>};
};

/// What a force effect is given.
template <class Scalar>
struct AeroCondition {
  Vector3<Scalar> air_relative_velocity_m_s = Vector3<Scalar>::Zero();  ///< R^T (v - wind), FRD
  Vector3<Scalar> body_rates_rad_s = Vector3<Scalar>::Zero();           ///< FRD
  Quaternion<Scalar> attitude{};                                        ///< body -> world
  Scalar height_above_ground_m{0};
  Scalar air_density_kg_m3{0};
  Scalar time_s{0};
  /// Of the rotors, without effects. These two are zero unless the effect `uses_rotor_wrench`.
  Wrench<Scalar> rotors;                             ///< body wrench of all four
  std::array<Scalar, rotor_count> rotor_thrust_N{};  ///< of each, along body -z
  Wrench<Scalar> aerodynamic;                        ///< sum of the effects before this one, body frame
};

/// Where an effect takes the absolute value of a force that the thrust can turn round, its wrench has two branches.
enum class ThrustBranch : std::uint8_t {
  upper,  ///< more thrust makes more of the force: the branch of ordinary flight
  lower,  ///< more thrust makes less of it, until the force is zero and the upper branch begins
};

/// What an effect's air and wrench depend on besides motion, attitude and airframe, and on the effects before it.
enum class VariesWith : std::uint8_t {
  motion,          ///< nothing else
  height,          ///< above ground or sea level
  place_and_time,  ///< anything
};

namespace detail {
struct EffectProbe {
  static Surroundings<double>& surroundings();
  static const AeroCondition<double>& condition();
  static const Airframe<double>& airframe();
};
template <class Effect, class = void>
struct HasSurroundings : std::false_type {};
template <class Effect>
struct HasSurroundings<Effect,
                       std::void_t<decltype(std::declval<const Effect&>().surroundings(EffectProbe::surroundings()))>>
    : std::true_type {};
template <class Effect, class = void>
struct HasWrench : std::false_type {};
template <class Effect>
struct HasWrench<Effect, std::void_t<decltype(std::declval<const Effect&>().wrench(EffectProbe::condition(),
                                                                                   EffectProbe::airframe()))>>
    : std::is_same<decltype(std::declval<const Effect&>().wrench(EffectProbe::condition(), EffectProbe::airframe())),
                   Wrench<double>> {};
template <class Effect, class Scalar, class = void>
struct IsBindable : std::false_type {};
template <class Effect, class Scalar>
struct IsBindable<Effect, Scalar,
                  std::void_t<decltype(std::declval<const Effect&>().bound(std::declval<const Airframe<Scalar>&>()))>>
    : std::true_type {};
template <class Effect, class = void>
struct UsesRotors : std::false_type {};
template <class Effect>
struct UsesRotors<Effect, std::enable_if_t<Effect::uses_rotor_wrench>> : std::true_type {};
template <class Effect, class = void>
struct Variation : std::integral_constant<VariesWith, VariesWith::place_and_time> {};
template <class Effect>
struct Variation<Effect, std::void_t<decltype(Effect::varies_with)>>
    : std::integral_constant<VariesWith, Effect::varies_with> {};
template <class Effect, class = void>
struct HasBranches : std::false_type {};
template <class Effect>
struct HasBranches<Effect, std::void_t<decltype(std::declval<const Effect&>().wrench_on(
                               ThrustBranch::upper, EffectProbe::condition(), EffectProbe::airframe()))>>
    : std::true_type {};
}  // namespace detail

template <class Effect>
inline constexpr bool changes_surroundings = detail::HasSurroundings<Effect>::value;
template <class Effect>
inline constexpr bool makes_wrench = detail::HasWrench<Effect>::value;

/// True for a type that fulfils the contract at the head of this file.
template <class Effect>
inline constexpr bool is_effect = changes_surroundings<Effect> || makes_wrench<Effect>;

/// True for what has `bound(airframe)`, see the head of this file.
template <class Effect, class Scalar>
inline constexpr bool is_bindable = detail::IsBindable<Effect, Scalar>::value;

/// The effect as a vehicle keeps it.
template <class Effect, class Scalar>
auto bound_effect(const Effect& effect, const Airframe<Scalar>& airframe) noexcept {
  if constexpr (is_bindable<Effect, Scalar>) {
    return effect.bound(airframe);
  } else {
    return effect;
  }
}

/// An effect whose wrench depends on the rotors' says `static constexpr bool uses_rotor_wrench = true;`. Its wrench should
/// be affine in the rotors' thrusts, as most are: then the inverse (vehicle/rotor_equation.hpp) is exact in one round.
template <class Effect>
inline constexpr bool uses_rotor_wrench = detail::UsesRotors<Effect>::value;

/// An effect that is affine on each of two branches only also has
///   template <class Scalar>
///   Wrench<Scalar> wrench_on(ThrustBranch, const AeroCondition<Scalar>&, const Airframe<Scalar>&) const noexcept;
/// its wrench as if the condition lay on that branch.
template <class Effect>
inline constexpr bool has_thrust_branches = detail::HasBranches<Effect>::value;

/// `static constexpr VariesWith varies_with = VariesWith::motion;` lets an inverse go without place and time. An effect that
/// says nothing is taken to depend on both.
template <class Effect>
inline constexpr VariesWith varies_with = detail::Variation<Effect>::value;

/// The most that any of these effects depends on.
template <class... Effects>
inline constexpr VariesWith widest_variation = ((varies_with<Effects> == VariesWith::place_and_time) || ...)
                                                   ? VariesWith::place_and_time
                                               : ((varies_with<Effects> == VariesWith::height) || ...)
                                                   ? VariesWith::height
                                                   : VariesWith::motion;

}  // namespace pinnquad
