// SPDX-License-Identifier: MIT
// The contract of an aerodynamic effect: a small value with one or both of two pure functions, each a
// `template <class Scalar>` and `const noexcept`.
//   void surroundings(Surroundings<Scalar>&)                                      wind, density, battery
//   Wrench<Scalar> wrench(const AeroCondition<Scalar>&, const Airframe<Scalar>&)  a force and a torque
// All `surroundings` run first, then the rotors, then each `wrench` in the order of the vehicle's effects.
// A wrench() that reads the rotors takes a RotorCondition instead. It should be affine in the rotors' thrusts: then the
// inverse (vehicle/inverse.hpp) is exact in one round. One that is affine on each of two branches has besides
//   Wrench<Scalar> wrench_on(ThrustBranch, const RotorCondition<Scalar>&, const Airframe<Scalar>&)
// which is its wrench as if the condition lay on that branch.
// Optional:
//   static constexpr VariesWith varies_with    less than place_and_time lets an inverse go without them
//   static constexpr bool is_battery = true    of one that reads and sets Surroundings::battery
//   static constexpr bool comes_last = true    of one that scales the forces of all others: a vehicle names it last
//   auto bound(const Airframe<Scalar>&)        the effect that a vehicle keeps in its place, of the airframe: it alone
//                                              may have the functions above
//   Status status(const Airframe<Scalar>&)     whether its values make sense and its model holds for the airframe: a
//                                              vehicle whose effect is not ok neither steps nor inverts. An
//                                              Outcome<Scalar> where lanes (core/lanes.hpp) can differ in it
// For vehicles in lanes a comparison of scalars is a mask: an effect chooses by select() (core/select.hpp).
#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/select.hpp"
#include "pinnquad/core/status.hpp"
#include "pinnquad/dynamics/actuator.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/dynamics/state.hpp"

namespace pinnquad {

/// Sea-level density of the standard atmosphere, p / (R T) = 101325 / (287.053 * 288.15), kg/m^3: the rho_0 by which
/// rotor thrust scales. rated_air_density_kg_m3, of which the numbers of an airframe are, is this rounded to 1.225.
template <class Scalar>
inline constexpr Scalar standard_air_density_kg_m3 = Scalar(101325.0 / (287.053 * 288.15));

/// A battery of a vehicle: charge and load are given, a Battery (aero/battery.hpp) sets the rest.
template <class Scalar>
struct BatteryUse {
  Scalar charge_used_C{0};         ///< since the start
  ThrustFractions<Scalar> load{};  ///< of the rotors as they turn; at rest where they are not known
  Scalar voltage_V{0};             ///< at its terminals; 0 without a battery
  Scalar current_A{0};
};

/// The air around the vehicle, and the battery in it. Time, position and altitude are given; effects set the rest. An
/// effect without an answer for a place or time sets `status`: a step or an inverse in this air is refused with it.
template <class Scalar>
struct Surroundings {
  Scalar time_s{0};
  Vector3<Scalar> position_m = Vector3<Scalar>::Zero();  ///< NED
  Scalar altitude_m{0};                                  ///< above sea level
  Vector3<Scalar> wind_m_s = Vector3<Scalar>::Zero();    ///< NED, the air's velocity over ground
  Scalar air_density_kg_m3{standard_air_density_kg_m3<Scalar>};
  Scalar thrust_scale{1};  ///< of all rotors, above 0: below 1 what a sagging battery leaves of thrust and torque
  BatteryUse<Scalar> battery{};
  Outcome<Scalar> status{Status::ok};
};

namespace detail {
/// Complete only for a reader of what an AeroCondition does not have.
template <class Scalar>
struct RotorsNotDeclared {
  static_assert(
      sizeof(Scalar) == 0,
      "pinnquad: this effect reads the rotors' wrench or thrusts without declaring it: let its wrench() take a "
      "RotorCondition<Scalar> instead of an AeroCondition<Scalar> (aero/effect.hpp)");
};
}  // namespace detail

/// The input of a force effect.
template <class Scalar>
struct AeroCondition {
  Vector3<Scalar> air_relative_velocity_m_s = Vector3<Scalar>::Zero();  ///< R^T (v - wind), FRD
  Vector3<Scalar> ground_velocity_m_s = Vector3<Scalar>::Zero();        ///< R^T v, FRD: what a foot on the ground feels
  Vector3<Scalar> body_rates_rad_s = Vector3<Scalar>::Zero();           ///< FRD
  Quaternion<Scalar> attitude{};                                        ///< body -> world
  Scalar height_above_ground_m{0};
  Scalar air_density_kg_m3{0};
  Scalar time_s{0};
  Wrench<Scalar> aerodynamic;  ///< sum of the effects before this one, body frame

  static const detail::RotorsNotDeclared<Scalar>& rotors;  ///< never defined: to read them is a compile error
  static const detail::RotorsNotDeclared<Scalar>& rotor_thrust_N;
};

/// The input of a force effect that depends on the rotors.
template <class Scalar>
struct RotorCondition : AeroCondition<Scalar> {
  Wrench<Scalar> rotors;                             ///< body wrench of all four
  std::array<Scalar, rotor_count> rotor_thrust_N{};  ///< of each, along its axis (body -z unless tilted)
};

/// The two branches of an effect that takes the absolute value of a force whose sign the thrust can turn.
enum class ThrustBranch : std::uint8_t {
  upper,  ///< more thrust makes more of the force: the branch of ordinary flight
  lower,  ///< more thrust makes less of it, until the force is zero and the upper branch begins
};

/// The inputs of an effect besides motion, attitude, airframe and the effects before it; each value has those above.
enum class VariesWith : std::uint8_t {
  motion,          ///< nothing else
  height,          ///< above ground or sea level
  place_and_time,  ///< anything
};

/// How a Switched effect stands in most flights. Where all stand so, a step flies that was compiled without questions
/// to those that are usually on or off.
enum class Usually : std::uint8_t { either, on, off };

/// An effect and its switch: one type for vehicles that differ in their effects. A vehicle passes over an effect that
/// is off, with the bits of a vehicle without it.
template <class Effect, Usually usually = Usually::either>
struct Switched {
  Effect effect{};
  bool on = false;
};

namespace detail {
template <class T>
const T& some() noexcept;  // never defined

template <class Effect>
struct Unswitched {
  using type = Effect;
};
template <class Effect, Usually usually>
struct Unswitched<Switched<Effect, usually>> {
  using type = Effect;
};
/// The effect itself.
template <class Effect>
using UnswitchedEffect = typename Unswitched<Effect>::type;

/// A call of the contract: whether it is noexcept; no type where it can't be made or returns something else.
template <class Effect>
using SurroundingsCall =
    std::bool_constant<noexcept(some<Effect>().surroundings(std::declval<Surroundings<double>&>()))>;
template <class Effect, class Condition = RotorCondition<double>>
using WrenchCall = std::enable_if_t<
    std::is_same_v<decltype(some<Effect>().wrench(some<Condition>(), some<Airframe<double>>())), Wrench<double>>,
    std::bool_constant<noexcept(some<Effect>().wrench(some<Condition>(), some<Airframe<double>>()))>>;
template <class Effect>
using WrenchOnCall = std::bool_constant<noexcept(
    some<Effect>().wrench_on(ThrustBranch::upper, some<RotorCondition<double>>(), some<Airframe<double>>()))>;
template <class Effect, class Scalar>
using BoundCall = std::bool_constant<noexcept(some<Effect>().bound(some<Airframe<Scalar>>()))>;
template <class Effect, class Scalar>
using StatusOf = decltype(some<Effect>().status(some<Airframe<Scalar>>()));
template <class Effect, class Scalar>
using StatusCall = std::enable_if_t<std::is_same_v<StatusOf<Effect, Scalar>, Status> ||
                                        std::is_same_v<StatusOf<Effect, Scalar>, Outcome<Scalar>>,
                                    std::bool_constant<noexcept(some<Effect>().status(some<Airframe<Scalar>>()))>>;

template <template <class...> class Call, class... Args>
constexpr bool noexcept_or_absent() noexcept {
  if constexpr (is_detected<Call, Args...>) {
    return Call<Args...>::value;
  } else {
    return true;
  }
}

/// The effect as a vehicle keeps it.
template <class Effect, class Scalar>
auto bound_effect(const Effect& effect, const Airframe<Scalar>& airframe) noexcept {
  if constexpr (is_detected<BoundCall, Effect, Scalar>) {
    return effect.bound(airframe);
  } else {
    return effect;
  }
}
template <class Effect, Usually usually, class Scalar>
auto bound_effect(const Switched<Effect, usually>& effect, const Airframe<Scalar>& airframe) noexcept {
  using Bound = decltype(bound_effect(effect.effect, airframe));
  return Switched<Bound, usually>{bound_effect(effect.effect, airframe), effect.on};
}

/// Its type: an effect too.
template <class Effect, class Scalar>
using BoundEffect = decltype(bound_effect(std::declval<const Effect&>(), std::declval<const Airframe<Scalar>&>()));
/// The effect that a vehicle asks: bound to an airframe, and without its switch.
template <class Effect>
using FlownEffect = UnswitchedEffect<BoundEffect<Effect, double>>;

/// Finds an effect's member by name, whatever its type: `&WithNames<Effect>::name` is ambiguous, and no type, where the
/// effect has one.
struct ContractNames {
  void surroundings();
  void wrench();
  void wrench_on();
  void bound();
  void status();
};
template <class Effect>
struct WithNames : Effect, ContractNames {};
template <class Effect>
using NoSurroundings = decltype(&WithNames<Effect>::surroundings);
template <class Effect>
using NoWrench = decltype(&WithNames<Effect>::wrench);
template <class Effect>
using NoWrenchOn = decltype(&WithNames<Effect>::wrench_on);
template <class Effect>
using NoBound = decltype(&WithNames<Effect>::bound);
template <class Effect>
using NoStatus = decltype(&WithNames<Effect>::status);
}  // namespace detail

namespace detail {
template <class Effect>
using IsBattery = std::enable_if_t<Effect::is_battery>;
template <class Effect>
using ComesLast = std::enable_if_t<Effect::comes_last>;
template <class... Effects>
constexpr bool require_last_ones_last() noexcept {
  constexpr bool comes_last[] = {is_detected<ComesLast, UnswitchedEffect<Effects>>..., false};
  constexpr auto followed = [](const bool* last) constexpr {
    for (std::size_t i = 0; i + 1 < sizeof...(Effects); ++i)
      if (last[i]) return true;
    return false;
  };
  static_assert(!followed(comes_last),
                "pinnquad: an effect that comes last, such as Payload, scales the forces of those before it: no other "
                "effect may follow it (aero/effect.hpp)");
  return true;
}
}  // namespace detail
/// True for an effect that reads and sets Surroundings::battery.
template <class Effect>
inline constexpr bool is_battery = is_detected<detail::IsBattery, detail::UnswitchedEffect<Effect>>;
template <class Effect>
inline constexpr bool changes_surroundings = is_detected<detail::SurroundingsCall, detail::FlownEffect<Effect>>;
template <class Effect>
inline constexpr bool makes_wrench = is_detected<detail::WrenchCall, detail::FlownEffect<Effect>>;

/// True for a type that fulfils the contract at the head of this file, but for `noexcept`.
template <class Effect>
inline constexpr bool is_effect = changes_surroundings<Effect> || makes_wrench<Effect> ||
                                  is_detected<detail::BoundCall, detail::UnswitchedEffect<Effect>, double>;

/// True for an effect with `wrench_on`.
template <class Effect>
inline constexpr bool has_thrust_branches = is_detected<detail::WrenchOnCall, detail::FlownEffect<Effect>>;

/// True for an effect whose `wrench` takes a RotorCondition.
template <class Effect>
inline constexpr bool uses_rotor_wrench =
    makes_wrench<Effect> && !is_detected<detail::WrenchCall, detail::FlownEffect<Effect>, AeroCondition<double>>;

/// False where the effect has a function of the contract's name that can't be called as the contract says, or returns
/// something else: it would be passed over in silence. A `final` class is not looked into: C++ does not list its names.
template <class Effect, class Scalar = double>
constexpr bool is_whole_effect() noexcept {
  using namespace detail;
  if constexpr (std::is_class_v<Effect> && !std::is_final_v<Effect>) {
    return is_detected<SurroundingsCall, Effect> != is_detected<NoSurroundings, Effect> &&
           is_detected<WrenchCall, Effect> != is_detected<NoWrench, Effect> &&
           is_detected<WrenchOnCall, Effect> != is_detected<NoWrenchOn, Effect> &&
           is_detected<BoundCall, Effect, Scalar> != is_detected<NoBound, Effect> &&
           is_detected<StatusCall, Effect, Scalar> != is_detected<NoStatus, Effect>;
  } else {
    return true;
  }
}

/// True if each of the effect's functions is noexcept: it runs in flight.
template <class Effect, class Scalar = double>
constexpr bool is_noexcept_effect() noexcept {
  using namespace detail;
  return noexcept_or_absent<SurroundingsCall, Effect>() && noexcept_or_absent<WrenchCall, Effect>() &&
         noexcept_or_absent<WrenchOnCall, Effect>() && noexcept_or_absent<BoundCall, Effect, Scalar>() &&
         noexcept_or_absent<StatusCall, Effect, Scalar>();
}

namespace detail {
template <class Effect, class Scalar>
inline constexpr bool flies =
    is_effect<Effect>&& is_whole_effect<Effect, Scalar>() && is_noexcept_effect<Effect, Scalar>();
template <class Effect, Usually usually, class Scalar>
inline constexpr bool flies<Switched<Effect, usually>, Scalar> = flies<Effect, Scalar>;
}  // namespace detail

/// Status of an effect for an airframe; ok for an effect that has no `status`.
template <class Effect, class Scalar>
constexpr Outcome<Scalar> effect_status(const Effect& effect, const Airframe<Scalar>& airframe) noexcept {
  if constexpr (is_detected<detail::StatusCall, Effect, Scalar>) {
    return effect.status(airframe);
  } else {
    static_cast<void>(effect);
    static_cast<void>(airframe);
    return Status::ok;
  }
}
/// Status of an effect that a run switches; ok where it is off.
template <class Effect, Usually usually, class Scalar>
constexpr Outcome<Scalar> effect_status(const Switched<Effect, usually>& effect,
                                        const Airframe<Scalar>& airframe) noexcept {
  return effect.on ? effect_status(effect.effect, airframe) : Outcome<Scalar>(Status::ok);
}

namespace detail {
template <class Effect, class Vehicle>
using StatusWhenCompiled = std::integral_constant<Status, Effect{}.status(Vehicle::template value<double>())>;

/// The status that an effect as it is by default gives an airframe known when compiled; ok for one that can be asked in
/// flight only.
template <class Effect, class Vehicle>
constexpr Status default_status() noexcept {
  if constexpr (is_detected<StatusWhenCompiled, Effect, Vehicle>) {
    return StatusWhenCompiled<Effect, Vehicle>::value;
  } else {
    return Status::ok;
  }
}

/// Calls `function` with an effect, unless it is switched off; `usual`: effects stand as usual.
template <bool usual, class Effect, class Function>
PINNQUAD_ALWAYS_INLINE void with_effect(const Effect& effect, const Function& function) noexcept {
  function(effect);
}
template <bool usual, class Effect, Usually usually, class Function>
PINNQUAD_ALWAYS_INLINE void with_effect(const Switched<Effect, usually>& effect, const Function& function) noexcept {
  if constexpr (!usual || usually == Usually::either) {
    if (effect.on) function(effect.effect);
  } else if constexpr (usually == Usually::on) {
    function(effect.effect);
  }
}

template <class Effect>
constexpr bool is_on(const Effect& /*effect*/) noexcept {
  return true;
}
template <class Effect, Usually usually>
constexpr bool is_on(const Switched<Effect, usually>& effect) noexcept {
  return effect.on;
}

template <class Effect>
constexpr bool stands_as_usual(const Effect& /*effect*/) noexcept {
  return true;
}
template <class Effect, Usually usually>
constexpr bool stands_as_usual(const Switched<Effect, usually>& effect) noexcept {
  return usually == Usually::either || effect.on == (usually == Usually::on);
}

template <class Effect>
inline constexpr bool is_switched = false;
template <class Effect, Usually usually>
inline constexpr bool is_switched<Switched<Effect, usually>> = true;
/// Whether a step is compiled without the questions.
template <class Effect>
inline constexpr bool has_usual_state = false;
template <class Effect, Usually usually>
inline constexpr bool has_usual_state<Switched<Effect, usually>> = usually != Usually::either;
}  // namespace detail

/// The effect's own `varies_with`. One that does not say is taken to depend on place and time.
template <class Effect, class = void>
inline constexpr VariesWith varies_with = VariesWith::place_and_time;
template <class Effect>
inline constexpr VariesWith varies_with<Effect, std::void_t<decltype(Effect::varies_with)>> = Effect::varies_with;
template <class Effect, Usually usually>
inline constexpr VariesWith varies_with<Switched<Effect, usually>, void> = varies_with<Effect>;

/// The most that any of these effects depends on.
template <class... Effects>
inline constexpr VariesWith widest_variation = std::max({VariesWith::motion, varies_with<Effects>...});

}  // namespace pinnquad
