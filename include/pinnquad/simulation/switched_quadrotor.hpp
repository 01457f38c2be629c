// SPDX-License-Identifier: MIT
// A quadrotor with every effect of the library, each with a switch: one type, compiled once, for programs whose user
// chooses the effects at run time. Its bits are those of the Quadrotor that names the effects that are on.
#pragma once

#include <tuple>
#include <type_traits>
#include <utility>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/battery.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/dryden.hpp"
#include "pinnquad/aero/flapping.hpp"
#include "pinnquad/aero/ground_contact.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/inflow.hpp"
#include "pinnquad/aero/payload.hpp"
#include "pinnquad/aero/rotor_fault.hpp"
#include "pinnquad/aero/wake.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace pinnquad {

/// All effects, off, in the order of the contract: the air first, then forces; the payload last, as it scales those
/// before it.
using SwitchedEffects =
    std::tuple<Switched<StandardAtmosphere, Usually::on>, Switched<ConstantWind>, Switched<PeriodicWind>,
               Switched<DrydenTurbulence<>, Usually::off>, Switched<Battery, Usually::off>,
               Switched<QuadraticDrag, Usually::on>, Switched<LinearDamping, Usually::off>,
               Switched<RotorDrag, Usually::off>, Switched<Inflow, Usually::off>, Switched<BladeFlapping, Usually::off>,
               Switched<Wake, Usually::off>, Switched<RotorGroundEffect<CheesemanBennett>, Usually::off>,
               Switched<GroundEffect<CheesemanBennett>>, Switched<GroundEffect<Conyers>>,
               Switched<RotorFault, Usually::off>, Switched<GroundContact, Usually::off>,
               Switched<Payload, Usually::off>>;

namespace detail {
template <class Effect, Usually usually>
void set_where(Switched<Effect, usually>& place, const Effect& effect, bool on) {
  place = {effect, on};
}
template <class Other, Usually usually, class Effect>
void set_where(Switched<Other, usually>& /*place*/, const Effect& /*effect*/, bool /*on*/) {}
}  // namespace detail

/// Sets an effect, on unless said otherwise.
template <class... Effects, class Effect>
void switch_effect(std::tuple<Effects...>& effects, const Effect& effect, bool on = true) {
  static_assert((std::is_same_v<detail::UnswitchedEffect<Effects>, Effect> || ...),
                "pinnquad: this effect is none of those that are switched");
  std::apply([&](Effects&... each) { (detail::set_where(each, effect, on), ...); }, effects);
}

/// The quadrotor with these effects; of SwitchedEffects a SwitchedQuadrotor.
template <class Scalar, class... Effects>
Quadrotor<Scalar, Effects...> quadrotor_with(const std::tuple<Effects...>& effects, const Airframe<Scalar>& airframe,
                                             const Site<Scalar>& site) {
  return std::apply([&](const Effects&... each) { return Quadrotor<Scalar, Effects...>(airframe, site, each...); },
                    effects);
}

using SwitchedQuadrotor = decltype(quadrotor_with(std::declval<SwitchedEffects>(), std::declval<Airframe<double>>(),
                                                  std::declval<Site<double>>()));

namespace detail {
template <class Vehicle>
struct EffectsOf;
template <class Scalar, class... Effects>
struct EffectsOf<Quadrotor<Scalar, Effects...>> {
  template <class All>
  static void switch_on(All& all) {
    (switch_effect(all, Effects{}), ...);
  }
};
}  // namespace detail

/// The effects that a Quadrotor names, as they are by default, on; all others off.
template <class Vehicle, class Effects = SwitchedEffects>
Effects switched_effects() {
  Effects effects;
  detail::EffectsOf<Vehicle>::switch_on(effects);
  return effects;
}

/// Ground effect of the vehicle as a whole.
enum class GroundEffectModel { none, cheeseman_bennett, conyers };

/// Switches the model of ground effect named on and the other off.
template <class Effects>
void set_ground_effect(Effects& effects, GroundEffectModel model) {
  switch_effect(effects, GroundEffect<CheesemanBennett>{}, model == GroundEffectModel::cheeseman_bennett);
  switch_effect(effects, GroundEffect<Conyers>{}, model == GroundEffectModel::conyers);
}

}  // namespace pinnquad
