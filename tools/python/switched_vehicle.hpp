// SPDX-License-Identifier: MIT
// A simulated quadrotor with every effect of the library, each switched while the program runs. Without those of
// rotors, battery, payload and legs it is the vehicle of the paper's flights, to the bit and at its speed.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <variant>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/battery_sag.hpp"
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
#include "pinnquad/simulation/switchable_quadrotor.hpp"

namespace python {

/// The choices: pinnquad.Effects of Python, which says what each is.
struct Effects {
  std::array<double, 3> wind_m_s{}, gust_m_s{};
  double gust_period_s = 10;
  double turbulence_m_s = 0, turbulence_height_m = 35;
  std::uint64_t turbulence_seed = 1;
  bool standard_atmosphere = true, drag = true;
  double linear_drag_N_s_m = 0, rate_damping_N_m_s = 0;
  std::string ground_effect = "none";
  bool rotor_drag = false, inflow = false, flapping = false, wake = false;
  double battery_endurance_s = 0, battery_full_V = 12.6, battery_empty_V = 10.5;
  unsigned fault_rotor = 0;
  double fault_share = 1, fault_from_s = 0;
  double payload_kg = 0, payload_from_s = 0;
  bool ground_contact = false;
  double leg_length_m = 0.18;
};

inline constexpr std::array<const char*, 4> ground_effects = {"none", "cheeseman_bennett", "conyers", "rotors"};

/// An effect and its switch. Off it changes nothing, and no value of it is asked.
template <class Effect>
struct SwitchedEffect {
  static constexpr pinnquad::VariesWith varies_with = pinnquad::varies_with<Effect>;
  Effect effect;
  bool on = false;

  template <class Scalar>
  pinnquad::Outcome<Scalar> status(const pinnquad::Airframe<Scalar>& airframe) const noexcept {
    return on ? pinnquad::effect_status(effect, airframe) : pinnquad::Outcome<Scalar>(pinnquad::Status::ok);
  }
};

/// One of the air.
template <class Effect>
struct SwitchedAir : SwitchedEffect<Effect> {
  template <class Scalar>
  void surroundings(pinnquad::Surroundings<Scalar>& air) const noexcept {
    if (this->on) this->effect.surroundings(air);
  }
};

/// One that makes a force; `Condition` is what it reads.
template <class Effect, template <class> class Condition = pinnquad::AeroCondition>
struct SwitchedForce : SwitchedEffect<Effect> {
  template <class Scalar>
  pinnquad::Wrench<Scalar> wrench(const Condition<Scalar>& condition,
                                  const pinnquad::Airframe<Scalar>& airframe) const noexcept {
    return this->on ? this->effect.wrench(condition, airframe) : pinnquad::Wrench<Scalar>{};
  }
  template <class Scalar>
  auto bound(const pinnquad::Airframe<Scalar>& airframe) const noexcept {
    using Bound = pinnquad::detail::BoundEffect<Effect, Scalar>;
    return SwitchedForce<Bound, Condition>{{pinnquad::detail::bound_effect(this->effect, airframe), this->on}};
  }
};

template <class Effect>
using SwitchedRotorForce = SwitchedForce<Effect, pinnquad::RotorCondition>;

/// One that is affine on two branches.
template <class Effect>
struct SwitchedLift : SwitchedEffect<Effect> {
  template <class Scalar>
  pinnquad::Wrench<Scalar> wrench(const pinnquad::RotorCondition<Scalar>& condition,
                                  const pinnquad::Airframe<Scalar>& airframe) const noexcept {
    return this->on ? this->effect.wrench(condition, airframe) : pinnquad::Wrench<Scalar>{};
  }
  template <class Scalar>
  pinnquad::Wrench<Scalar> wrench_on(pinnquad::ThrustBranch branch, const pinnquad::RotorCondition<Scalar>& condition,
                                     const pinnquad::Airframe<Scalar>& airframe) const noexcept {
    return this->on ? this->effect.wrench_on(branch, condition, airframe) : pinnquad::Wrench<Scalar>{};
  }
  template <class Scalar>
  auto bound(const pinnquad::Airframe<Scalar>& airframe) const noexcept {
    using Bound = pinnquad::detail::BoundEffect<Effect, Scalar>;
    return SwitchedLift<Bound>{{pinnquad::detail::bound_effect(this->effect, airframe), this->on}};
  }
};

/// The effects of the paper's flights, before the ground effect.
using PaperEffects =
    std::tuple<pinnquad::StandardAtmosphere, pinnquad::ConstantWind, pinnquad::PeriodicWind, pinnquad::QuadraticDrag>;

/// All, in the order of the contract: the air first, then forces; the payload last, as it scales those before it.
using AllEffects = std::tuple<SwitchedAir<pinnquad::StandardAtmosphere>, pinnquad::ConstantWind, pinnquad::PeriodicWind,
                              SwitchedAir<pinnquad::DrydenTurbulence<>>, SwitchedAir<pinnquad::BatterySag>,
                              SwitchedForce<pinnquad::QuadraticDrag>, SwitchedForce<pinnquad::LinearDamping>,
                              SwitchedRotorForce<pinnquad::RotorDrag>, SwitchedRotorForce<pinnquad::Inflow>,
                              SwitchedRotorForce<pinnquad::BladeFlapping>, SwitchedRotorForce<pinnquad::Wake>,
                              SwitchedRotorForce<pinnquad::RotorGroundEffect<pinnquad::CheesemanBennett>>,
                              SwitchedLift<pinnquad::CheesemanBennettGroundEffect>,
                              SwitchedLift<pinnquad::ConyersGroundEffect>, SwitchedRotorForce<pinnquad::RotorFault>,
                              SwitchedForce<pinnquad::GroundContact>, SwitchedRotorForce<pinnquad::Payload>>;

/// A vehicle (simulation/simulator.hpp) by the choices of Effects.
class SwitchedQuadrotor {
 public:
  SwitchedQuadrotor(const pinnquad::Airframe<double>& airframe, const pinnquad::Site<double>& site,
                    const Effects& effects)
      : airframe_(airframe), site_(site), effects_(effects), chosen_(chosen(airframe, site, effects)) {}

  const pinnquad::Airframe<double>& airframe() const noexcept { return airframe_; }
  const pinnquad::Site<double>& site() const noexcept { return site_; }
  const Effects& effects() const noexcept { return effects_; }

  /// `function(effects, ground_effect)` for the vehicle of the paper's flights, `function(effects)` for that with all
  /// effects: their values, not bound to the airframe.
  template <class Function>
  auto with_effects(const Function& function) const {
    const Plain* const plain = std::get_if<Plain>(&chosen_);
    return plain != nullptr ? function(plain->effects(), plain->ground_effect())
                            : function(std::get<Full>(chosen_).effects);
  }

  /// Another airframe under the same effects.
  SwitchedQuadrotor with(const pinnquad::Airframe<double>& airframe) const {
    SwitchedQuadrotor other = *this;
    other.airframe_ = airframe;
    other.chosen_ = with_effects([&](const auto& effects, auto... ground_effect) -> Chosen {
      return made(airframe, site_, effects, ground_effect...);
    });
    return other;
  }

  template <class Function>
  decltype(auto) visit(Function&& function) const {
    return std::visit(
        [&](const auto& vehicle) -> decltype(auto) {
          return with_quadrotor(vehicle, std::forward<Function>(function));
        },
        chosen_);
  }

 private:
  template <class Values>
  struct QuadrotorWith;
  template <class... Effect>
  struct QuadrotorWith<std::tuple<Effect...>> {
    using Switchable = pinnquad::SwitchableQuadrotor<Effect...>;
    using Alone = pinnquad::Quadrotor<double, Effect...>;
  };
  using Plain = QuadrotorWith<PaperEffects>::Switchable;
  struct Full {
    AllEffects effects;
    QuadrotorWith<AllEffects>::Alone quadrotor;
  };
  using Chosen = std::variant<Plain, Full>;

  template <class Function>
  friend decltype(auto) with_quadrotor(const Full& full, Function&& function) {
    return std::forward<Function>(function)(full.quadrotor);
  }

  static Plain made(const pinnquad::Airframe<double>& airframe, const pinnquad::Site<double>& site,
                    const PaperEffects& effects, pinnquad::GroundEffectModel ground_effect) {
    Plain plain = std::apply([&](const auto&... each) { return Plain(airframe, site, each...); }, effects);
    plain.set_ground_effect(ground_effect);
    return plain;
  }
  static Full made(const pinnquad::Airframe<double>& airframe, const pinnquad::Site<double>& site,
                   const AllEffects& effects) {
    return {effects,
            std::apply([&](const auto&... each) { return QuadrotorWith<AllEffects>::Alone(airframe, site, each...); },
                       effects)};
  }

  static bool is_plain(const Effects& e) {
    return e.standard_atmosphere && e.drag && !(e.turbulence_m_s > 0) && !(e.battery_endurance_s > 0) &&
           !(e.linear_drag_N_s_m > 0) && !(e.rate_damping_N_m_s > 0) && !e.rotor_drag && !e.inflow && !e.flapping &&
           !e.wake && e.ground_effect != "rotors" && !(e.fault_share < 1) && !(e.payload_kg > 0) && !e.ground_contact;
  }

  static Chosen chosen(const pinnquad::Airframe<double>& airframe, const pinnquad::Site<double>& site,
                       const Effects& e) {
    using pinnquad::GroundEffectModel;
    const pinnquad::ConstantWind wind{e.wind_m_s};
    pinnquad::PeriodicWind gust;
    gust.mean_m_s = 0;
    gust.amplitude_m_s = std::hypot(e.gust_m_s[0], e.gust_m_s[1], e.gust_m_s[2]);
    gust.period_s = e.gust_period_s;
    for (std::size_t i = 0; i < 3 && gust.amplitude_m_s > 0; ++i) {
      gust.direction[i] = e.gust_m_s[i] / gust.amplitude_m_s;
    }
    if (is_plain(e)) {
      const GroundEffectModel ground_effect =
          e.ground_effect == "conyers" ? GroundEffectModel::conyers
                                       : (e.ground_effect == "cheeseman_bennett" ? GroundEffectModel::cheeseman_bennett
                                                                                 : GroundEffectModel::none);
      return made(airframe, site, PaperEffects({}, wind, gust, {}), ground_effect);
    }
    std::mt19937_64 engine(e.turbulence_seed);
    const double along_m_s = std::hypot(e.wind_m_s[0], e.wind_m_s[1]);
    const std::array<double, 2> direction = {along_m_s > 0 ? e.wind_m_s[0] / along_m_s : 1.0,
                                             along_m_s > 0 ? e.wind_m_s[1] / along_m_s : 0.0};
    const pinnquad::DrydenTurbulence<> turbulence(
        engine, pinnquad::DrydenParameters::low_altitude(e.turbulence_m_s, e.turbulence_height_m), along_m_s,
        direction);
    const pinnquad::BatterySag battery{e.battery_full_V, e.battery_empty_V, e.battery_endurance_s};
    const pinnquad::LinearDamping damping{e.linear_drag_N_s_m, e.rate_damping_N_m_s};
    const pinnquad::RotorFault fault{e.fault_rotor, e.fault_share, e.fault_from_s};
    pinnquad::GroundContact legs;
    legs.leg_length_m = e.leg_length_m;
    AllEffects all({{{}, e.standard_atmosphere}}, wind, gust, {{turbulence, e.turbulence_m_s > 0}},
                   {{battery, e.battery_endurance_s > 0}}, {{{}, e.drag}},
                   {{damping, e.linear_drag_N_s_m > 0 || e.rate_damping_N_m_s > 0}}, {{{}, e.rotor_drag}},
                   {{{}, e.inflow}}, {{{}, e.flapping}}, {{{}, e.wake}}, {{{}, e.ground_effect == "rotors"}},
                   {{{}, e.ground_effect == "cheeseman_bennett"}}, {{{}, e.ground_effect == "conyers"}},
                   {{fault, e.fault_share < 1}}, {{legs, e.ground_contact}},
                   {{{e.payload_kg, e.payload_from_s}, e.payload_kg > 0}});
    return made(airframe, site, all);
  }

  pinnquad::Airframe<double> airframe_;
  pinnquad::Site<double> site_;
  Effects effects_;
  Chosen chosen_;
};

/// A SwitchedQuadrotor as a simulator's vehicle.
template <class Function>
decltype(auto) with_quadrotor(const SwitchedQuadrotor& quadrotor, Function&& function) {
  return quadrotor.visit(std::forward<Function>(function));
}

}  // namespace python
