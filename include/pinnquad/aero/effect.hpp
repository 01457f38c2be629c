// SPDX-License-Identifier: MIT
// The contract of an aerodynamic effect: a small value with one or both of two pure functions.
//   template <class Scalar> void surroundings(Surroundings<Scalar>&) const noexcept;      wind, density, battery
//   template <class Scalar> Wrench<Scalar> wrench(const AeroCondition<Scalar>&, const Airframe<Scalar>&) const noexcept;
// All `surroundings` run first, then the rotors, then each `wrench` in the order of the vehicle's effects.
// What an effect reads beyond an AeroCondition it declares by what its wrench() takes: a RotorCondition for the rotors, see also
// `has_thrust_branches`; a PlaceCondition for position and ground velocity; a PlaceAndRotorCondition for both. One that is the
// same at every place and time may say so, see `varies_with`.
// Optional: `template <class Scalar> auto bound(const Airframe<Scalar>&) const noexcept;` returns the effect that a vehicle
// keeps in its place, with what follows from the airframe worked out once; and
// `template <class Scalar> constexpr Status status(const Airframe<Scalar>&) const noexcept;` says whether the effect's
// values make sense and its model holds for the airframe: a vehicle whose effect isn't ok neither steps nor inverts.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "pinnquad/core/status.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/dynamics/site.hpp"
#include "pinnquad/dynamics/state.hpp"

namespace pinnquad {

/// Sea-level density of the standard atmosphere, p / (R T) = 101325 / (287.053 * 288.15); the rho_0 by which rotor thrust
/// scales.
template <class Scalar>
inline constexpr Scalar standard_air_density_kg_m3 = Scalar(101325.0 / (287.053 * 288.15));

/// The air around the vehicle, and the battery in it. The first three are given; effects set the rest. An effect that has no
/// answer for a place or time sets `status`, and what was to come of this air (a step, an inverse) is refused with it.
template <class Scalar>
struct Surroundings {
  Scalar time_s{0};
  Vector3<Scalar> position_m = Vector3<Scalar>::Zero();  ///< NED
  Scalar altitude_m{0};                                  ///< above sea level
  Vector3<Scalar> wind_m_s = Vector3<Scalar>::Zero();    ///< NED, the air's velocity over ground
  Scalar air_density_kg_m3{standard_air_density_kg_m3<Scalar>};
  Scalar thrust_scale{1};  ///< of all rotors, above 0: below 1 what a sagging battery leaves of thrust and torque
  Status status{Status::ok};
};

namespace detail {
/// Complete only for a reader of what an AeroCondition doesn't have.
template <class Scalar>
struct RotorsNotDeclared {
  static_assert(
      sizeof(Scalar) == 0,
      "pinnquad: this effect reads the rotors' wrench or thrusts without declaring it: let its wrench() take a "
      "RotorCondition<Scalar> instead of an AeroCondition<Scalar> (aero/effect.hpp)");
};
template <class Scalar>
struct PlaceNotDeclared {
  static_assert(
      sizeof(Scalar) == 0,
      "pinnquad: this effect reads the position or the ground velocity without declaring it: let its wrench() "
      "take a PlaceCondition<Scalar> or a PlaceAndRotorCondition<Scalar> (aero/effect.hpp)");
};
}  // namespace detail

/// What a force effect is given.
template <class Scalar>
struct AeroCondition {
  Vector3<Scalar> air_relative_velocity_m_s = Vector3<Scalar>::Zero();  ///< R^T (v - wind), FRD
  Vector3<Scalar> body_rates_rad_s = Vector3<Scalar>::Zero();           ///< FRD
  Quaternion<Scalar> attitude{};                                        ///< body -> world
  Scalar height_above_ground_m{0};
  Scalar air_density_kg_m3{0};
  Scalar time_s{0};
  Wrench<Scalar> aerodynamic;  ///< sum of the effects before this one, body frame

  static const detail::RotorsNotDeclared<Scalar>& rotors;  ///< never defined: a compile error for who reads them
  static const detail::RotorsNotDeclared<Scalar>& rotor_thrust_N;
  static const detail::PlaceNotDeclared<Scalar>& position_m;
  static const detail::PlaceNotDeclared<Scalar>& ground_velocity_m_s;
};

/// What a force effect is given whose `wrench` takes it: the rotors too, without effects.
template <class Scalar>
struct RotorCondition : AeroCondition<Scalar> {
  Wrench<Scalar> rotors;                             ///< body wrench of all four
  std::array<Scalar, rotor_count> rotor_thrust_N{};  ///< of each, along its axis (body -z unless tilted)
};

/// What a force effect is given that depends on where the vehicle is: obstacles, other vehicles.
template <class Scalar>
struct PlaceCondition : AeroCondition<Scalar> {
  Vector3<Scalar> position_m = Vector3<Scalar>::Zero();           ///< NED
  Vector3<Scalar> ground_velocity_m_s = Vector3<Scalar>::Zero();  ///< NED
};

/// Both.
template <class Scalar>
struct PlaceAndRotorCondition : RotorCondition<Scalar> {
  Vector3<Scalar> position_m = Vector3<Scalar>::Zero();           ///< NED
  Vector3<Scalar> ground_velocity_m_s = Vector3<Scalar>::Zero();  ///< NED
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
  static Surroundings<double>& surroundings() noexcept;
  static const RotorCondition<double>& rotor_condition() noexcept;
  static const Airframe<double>& airframe() noexcept;
};
template <class Effect, class = void>
struct HasSurroundings : std::false_type {
  static constexpr bool is_noexcept = true;
};
template <class Effect>
struct HasSurroundings<Effect,
                       std::void_t<decltype(std::declval<const Effect&>().surroundings(EffectProbe::surroundings()))>>
    : std::true_type {
  static constexpr bool is_noexcept = noexcept(std::declval<const Effect&>().surroundings(EffectProbe::surroundings()));
};
template <class Effect, class Condition, class = void>
struct HasWrench : std::false_type {
  static constexpr bool is_noexcept = true;
};
template <class Effect, class Condition>
struct HasWrench<Effect, Condition,
                 std::void_t<decltype(std::declval<const Effect&>().wrench(std::declval<const Condition&>(),
                                                                           EffectProbe::airframe()))>>
    : std::is_same<decltype(std::declval<const Effect&>().wrench(std::declval<const Condition&>(),
                                                                 EffectProbe::airframe())),
                   Wrench<double>> {
  static constexpr bool is_noexcept =
      noexcept(std::declval<const Effect&>().wrench(std::declval<const Condition&>(), EffectProbe::airframe()));
};
template <class Effect, class Scalar, class = void>
struct IsBindable : std::false_type {
  static constexpr bool is_noexcept = true;
};
template <class Effect, class Scalar>
struct IsBindable<Effect, Scalar,
                  std::void_t<decltype(std::declval<const Effect&>().bound(std::declval<const Airframe<Scalar>&>()))>>
    : std::true_type {
  static constexpr bool is_noexcept =
      noexcept(std::declval<const Effect&>().bound(std::declval<const Airframe<Scalar>&>()));
};
template <class Effect, class Scalar, class = void>
struct HasStatus : std::false_type {
  static constexpr bool is_noexcept = true;
};
template <class Effect, class Scalar>
struct HasStatus<Effect, Scalar,
                 std::void_t<decltype(std::declval<const Effect&>().status(std::declval<const Airframe<Scalar>&>()))>>
    : std::is_same<Status, decltype(std::declval<const Effect&>().status(std::declval<const Airframe<Scalar>&>()))> {
  static constexpr bool is_noexcept =
      noexcept(std::declval<const Effect&>().status(std::declval<const Airframe<Scalar>&>()));
};
/// Whether a class has a member of this name, whatever it is: two of one name can't be told apart.
struct SurroundingsName {
  void surroundings();
};
struct WrenchName {
  void wrench();
};
struct WrenchOnName {
  void wrench_on();
};
struct BoundName {
  void bound();
};
struct StatusName {
  void status();
};
template <class Effect, class Name>
struct Joined : Effect, Name {};
template <class Effect, class = void>
struct NamesSurroundings : std::true_type {};
template <class Effect>
struct NamesSurroundings<Effect, std::void_t<decltype(&Joined<Effect, SurroundingsName>::surroundings)>>
    : std::false_type {};
template <class Effect, class = void>
struct NamesWrench : std::true_type {};
template <class Effect>
struct NamesWrench<Effect, std::void_t<decltype(&Joined<Effect, WrenchName>::wrench)>> : std::false_type {};
template <class Effect, class = void>
struct NamesWrenchOn : std::true_type {};
template <class Effect>
struct NamesWrenchOn<Effect, std::void_t<decltype(&Joined<Effect, WrenchOnName>::wrench_on)>> : std::false_type {};
template <class Effect, class = void>
struct NamesBound : std::true_type {};
template <class Effect>
struct NamesBound<Effect, std::void_t<decltype(&Joined<Effect, BoundName>::bound)>> : std::false_type {};
template <class Effect, class = void>
struct NamesStatus : std::true_type {};
template <class Effect>
struct NamesStatus<Effect, std::void_t<decltype(&Joined<Effect, StatusName>::status)>> : std::false_type {};

template <class Effect, class = void>
struct Variation : std::integral_constant<VariesWith, VariesWith::place_and_time> {};
template <class Effect>
struct Variation<Effect, std::void_t<decltype(Effect::varies_with)>>
    : std::integral_constant<VariesWith, Effect::varies_with> {};
template <class Effect, class = void>
struct HasBranches : std::false_type {
  static constexpr bool is_noexcept = true;
};
template <class Effect>
struct HasBranches<Effect, std::void_t<decltype(std::declval<const Effect&>().wrench_on(
                               ThrustBranch::upper, EffectProbe::rotor_condition(), EffectProbe::airframe()))>>
    : std::true_type {
  static constexpr bool is_noexcept = noexcept(std::declval<const Effect&>().wrench_on(
      ThrustBranch::upper, EffectProbe::rotor_condition(), EffectProbe::airframe()));
};
}  // namespace detail

template <class Effect>
inline constexpr bool changes_surroundings = detail::HasSurroundings<Effect>::value;
template <class Effect>
inline constexpr bool makes_wrench = detail::HasWrench<Effect, RotorCondition<double>>::value ||
                                     detail::HasWrench<Effect, PlaceCondition<double>>::value ||
                                     detail::HasWrench<Effect, PlaceAndRotorCondition<double>>::value;

/// True for a type that fulfils the contract at the head of this file, but for `noexcept`.
template <class Effect>
inline constexpr bool is_effect = changes_surroundings<Effect> || makes_wrench<Effect>;

/// An effect that is affine on each of two branches only also has
///   template <class Scalar>
///   Wrench<Scalar> wrench_on(ThrustBranch, const RotorCondition<Scalar>&, const Airframe<Scalar>&) const noexcept;
/// its wrench as if the condition lay on that branch.
template <class Effect>
inline constexpr bool has_thrust_branches = detail::HasBranches<Effect>::value;

/// False where the effect has a function of the contract's name that can't be called as the contract says, or returns
/// something else: it would be passed over in silence. A `final` class is not looked into: C++ tells its names to nobody.
template <class Effect, class Scalar = double>
constexpr bool is_whole_effect() noexcept {
  if constexpr (std::is_class_v<Effect> && !std::is_final_v<Effect>) {
    return changes_surroundings<Effect> == detail::NamesSurroundings<Effect>::value &&
           makes_wrench<Effect> == detail::NamesWrench<Effect>::value &&
           has_thrust_branches<Effect> == detail::NamesWrenchOn<Effect>::value &&
           detail::IsBindable<Effect, Scalar>::value == detail::NamesBound<Effect>::value &&
           detail::HasStatus<Effect, Scalar>::value == detail::NamesStatus<Effect>::value;
  } else {
    return true;
  }
}

/// True if each of the effect's functions is noexcept: it runs in flight.
template <class Effect, class Scalar = double>
inline constexpr bool is_noexcept_effect = detail::HasSurroundings<Effect>::is_noexcept&& detail::HasWrench<
    Effect, RotorCondition<double>>::is_noexcept&& detail::HasWrench<Effect, PlaceCondition<double>>::is_noexcept&&
    detail::HasWrench<Effect, PlaceAndRotorCondition<double>>::is_noexcept&& detail::HasBranches<Effect>::is_noexcept&&
        detail::IsBindable<Effect, Scalar>::is_noexcept&& detail::HasStatus<Effect, Scalar>::is_noexcept;

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

/// Its type: an effect too.
template <class Effect, class Scalar>
using BoundEffect = decltype(bound_effect(std::declval<const Effect&>(), std::declval<const Airframe<Scalar>&>()));

/// Status of an effect for an airframe; ok for an effect that has no `status`.
template <class Effect, class Scalar>
constexpr Status effect_status(const Effect& effect, const Airframe<Scalar>& airframe) noexcept {
  if constexpr (detail::HasStatus<Effect, Scalar>::value) {
    return effect.status(airframe);
  } else {
    static_cast<void>(effect);
    static_cast<void>(airframe);
    return Status::ok;
  }
}

/// True for an effect whose `wrench` takes a RotorCondition or a PlaceAndRotorCondition: it depends on the rotors. It should be
/// affine in the rotors' thrusts, as most are: then the inverse (vehicle/rotor_equation.hpp) is exact in one round.
template <class Effect>
inline constexpr bool uses_rotor_wrench =
    makes_wrench<Effect> && !detail::HasWrench<Effect, PlaceCondition<double>>::value;

/// True for an effect whose `wrench` takes a PlaceCondition or a PlaceAndRotorCondition.
template <class Effect>
inline constexpr bool uses_place = makes_wrench<Effect> && !detail::HasWrench<Effect, RotorCondition<double>>::value;

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
