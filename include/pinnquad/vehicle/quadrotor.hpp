// SPDX-License-Identifier: MIT
// A quadrotor: airframe, rotors and aerodynamic effects composed by type. Forward dynamics and one step in time.
#pragma once

#include <array>
#include <tuple>
#include <utility>

#include "pinnquad/aero/effect.hpp"
#include "pinnquad/core/attributes.hpp"
#include "pinnquad/dynamics/actuator.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/dynamics/integrator.hpp"
#include "pinnquad/dynamics/rigid_body.hpp"
#include "pinnquad/dynamics/rotor.hpp"
#include "pinnquad/vehicle/axes.hpp"
#include "pinnquad/vehicle/site.hpp"
#include "pinnquad/vehicle/vehicle_state.hpp"

namespace pinnquad {

/// Eqs. (1) and (2) with effects, in their order (aero/effect.hpp). World NED, body FRD, SI units.
template <class Scalar, class... Effects>
class Quadrotor {
  static_assert((is_effect<Effects> && ...),
                "pinnquad: this type is not an aerodynamic effect: it needs wrench() or more (aero/effect.hpp)");
  static_assert((is_whole_effect<detail::UnswitchedEffect<Effects>, Scalar>() && ...),
                "pinnquad: an effect's surroundings(), wrench(), wrench_on(), bound() or status() can't be called as "
                "the contract says, or returns something else: it would be passed over (aero/effect.hpp)");
  static_assert((is_noexcept_effect<detail::UnswitchedEffect<Effects>, Scalar>() && ...),
                "pinnquad: an effect flies: its surroundings(), wrench(), wrench_on(), bound() and status() must be "
                "noexcept (aero/effect.hpp)");
  static_assert(
      (detail::flies<detail::BoundEffect<Effects, Scalar>, Scalar> && ...),
      "pinnquad: what an effect's bound() returns flies in its place: it must be an effect whose functions are "
      "as the contract says and noexcept (aero/effect.hpp)");
  static_assert(detail::require_last_ones_last<Effects...>());

 public:
  /// One evaluation of the dynamics, taken apart.
  struct Evaluation {
    Surroundings<Scalar> surroundings;
    Wrench<Scalar> rotors;       ///< body
    Wrench<Scalar> aerodynamic;  ///< body, all effects
    Accelerations<Scalar> motion;
  };

  /// The vehicle of an airframe known when compiled, `Quadrotor<double, QuadraticDrag>::of<Crazyflie>(site)`: what
  /// airframe_value() refuses is a compile error. status() says whether the effects suit the airframe.
  template <class Vehicle>
  static Quadrotor of(const Site<Scalar>& site, const Effects&... effects) noexcept {
    return Quadrotor(airframe_value<Vehicle, Scalar>(), site, effects...);
  }
  /// The same with effects as they are by default: one that refuses the airframe is a compile error too.
  template <class Vehicle, std::size_t Count = sizeof...(Effects), std::enable_if_t<(Count > 0), int> = 0>
  static Quadrotor of(const Site<Scalar>& site = {}) noexcept {
    static_assert(
        ((detail::default_status<Effects, Vehicle>() == Status::ok) && ...),
        "pinnquad: an effect, as it is by default, refuses this airframe (its status()): a ground effect's fit "
        "that has a pole or an implausible ratio at its motor spacing and propeller radius, for example "
        "(aero/ground_effect.hpp)");
    return of<Vehicle>(site, Effects{}...);
  }

  /// Effects as they are by default.
  template <std::size_t Count = sizeof...(Effects), std::enable_if_t<(Count > 0), int> = 0>
  explicit Quadrotor(const Airframe<Scalar>& airframe, const Site<Scalar>& site = {}) noexcept
      : Quadrotor(airframe, site, Effects{}...) {}
  template <std::size_t Count = sizeof...(Effects), std::enable_if_t<Count == 0, int> = 0>
  explicit Quadrotor(const Airframe<Scalar>& airframe) noexcept : Quadrotor(airframe, Site<Scalar>{}) {}
  explicit Quadrotor(const Airframe<Scalar>& airframe, const Site<Scalar>& site, Effects... effects) noexcept
      : airframe_(airframe),
        inverse_mass_(Scalar(1) / airframe.mass_kg),
        site_(site),
        effects_(detail::bound_effect(effects, airframe)...),
        rotors_(airframe),
        plain_(is_plain(airframe)),
        usual_((detail::stands_as_usual(effects) && ...)),
        rotor_effect_(((uses_rotor_wrench<Effects> && detail::is_on(effects)) || ...)),
        branched_effect_(((has_thrust_branches<Effects> && detail::is_on(effects)) || ...)),
        status_(first_fault(effects...)) {}

  const Airframe<Scalar>& airframe() const noexcept { return airframe_; }
  const Site<Scalar>& site() const noexcept { return site_; }
  const Rotors<Scalar>& rotors() const noexcept { return rotors_; }
  /// In the order of `Effects`, bound to the airframe.
  const std::tuple<detail::BoundEffect<Effects, Scalar>...>& effects() const noexcept { return effects_; }

  /// Unless ok, step() and the inverse refuse with it: `invalid_airframe`, `no_solution` for an allocation that can't
  /// be inverted, `out_of_range` for a site that is no place, or what an effect's status() says of the airframe.
  Outcome<Scalar> status() const noexcept { return status_; }

  /// Whether an effect that is not switched off takes a RotorCondition; whether one has branches.
  bool has_rotor_effect() const noexcept { return rotor_effect_; }
  bool has_branched_effect() const noexcept { return branched_effect_; }

  /// The air at a place and time, as the effects set it; of a battery at the start and at rest unless its use is given.
  template <bool usual = false>
  PINNQUAD_ALWAYS_INLINE Surroundings<Scalar> surroundings(const State<Scalar>& state, Scalar time_s,
                                                           const BatteryUse<Scalar>& use = {}) const noexcept {
    Surroundings<Scalar> air;
    air.time_s = time_s;
    air.position_m = state.position_m;
    air.altitude_m = site_.elevation_m - state.position_m[2];
    if constexpr (has_battery) air.battery = use;
    each_effect<usual>([&air](const auto& effect) PINNQUAD_INLINE_LAMBDA {
      if constexpr (changes_surroundings<std::decay_t<decltype(effect)>>) effect.surroundings(air);
    });
    return air;
  }
  /// The same with the battery as the flight has left it, under the rotors as they turn.
  Surroundings<Scalar> surroundings(const VehicleState<Scalar>& vehicle) const noexcept {
    return surroundings(vehicle.body, Scalar(vehicle.time_s), detail::battery_use(vehicle, rotors_));
  }

  /// Body wrench of all effects at thrust fractions of the rotors (not clipped), in which an effect should be affine.
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> aerodynamic_wrench(const State<Scalar>& state, const Surroundings<Scalar>& air,
                                                           const ThrustFractions<Scalar>& thrusts) const noexcept {
    if constexpr (has_usual) {
      if (usual_) return aerodynamic<false, true>(state, air, thrusts);
    }
    return aerodynamic<false, false>(state, air, thrusts);
  }

  /// The same with every effect that has branches on this one, whether the condition lies on it or not.
  Wrench<Scalar> aerodynamic_wrench_on(ThrustBranch branch, const State<Scalar>& state, const Surroundings<Scalar>& air,
                                       const ThrustFractions<Scalar>& thrusts) const noexcept {
    const auto on_branch = [this, branch](const auto& effect, const auto& condition) noexcept {
      if constexpr (has_thrust_branches<std::decay_t<decltype(effect)>>) {
        return effect.wrench_on(branch, condition, airframe_);
      } else {
        return effect.wrench(condition, airframe_);
      }
    };
    if constexpr (has_usual) {
      if (usual_) return sum_of_effects<false, true>(state, air, thrusts, on_branch);
    }
    return sum_of_effects<false, false>(state, air, thrusts, on_branch);
  }

  /// Wrenches and accelerations of settled rotors: `rotor_commands` are clipped to 0..1, without lag. Unchecked: valid
  /// where status() and the surroundings' status are ok.
  Evaluation evaluate(const State<Scalar>& state, const Commands<Scalar>& rotor_commands, Scalar time_s,
                      const BatteryUse<Scalar>& use = {}) const noexcept {
    Evaluation result = loads(state, rotors_.fractions(rotor_commands), time_s, use);
    result.motion = accelerations(airframe_, state, total(result), site_.gravity_m_s2);
    return result;
  }
  Evaluation evaluate(const VehicleState<Scalar>& vehicle) const noexcept {
    return evaluate(vehicle.body, vehicle.rotors, Scalar(vehicle.time_s), detail::battery_use(vehicle, rotors_));
  }

  /// The length of a step, and what the rotors' lag leaves over half of it: worked out once where steps are alike.
  struct TimeStep {
    Scalar step_s;
    std::array<Scalar, rotor_count> rise_factor, fall_factor;  ///< of a plain airframe the first is every rotor's
  };
  TimeStep time_step(Scalar step_s) const noexcept {
    TimeStep result{step_s, {}, {}};
    const Scalar half_s = step_s / Scalar(2);
    if (all_of(plain_)) {
      result.rise_factor[0] = lag_factor(airframe_.rise_time_constant_s(0), half_s);
    } else {
      result.rise_factor = lag_factor(rise_time_constants_s(airframe_), half_s);
      result.fall_factor = lag_factor(fall_time_constants_s(airframe_), half_s);
    }
    return result;
  }

  /// Advances by one RK4 step under commands held over the step. The rotor lag is integrated exactly; a battery gives
  /// the current at the step's end, under the load at its start. Errors: status(); `not_finite` for a bad input;
  /// `out_of_range` for a step backwards, more than half a turn of the body in one step, a clock so late that the step
  /// doesn't move it, air that has no answer (Surroundings) or a battery that is less than empty;
  /// `not_unit_quaternion`; `output_not_finite` for a diverged result. The state is untouched unless the Status is ok.
  Outcome<Scalar> step(VehicleState<Scalar>& state, const Commands<Scalar>& commands,
                       const TimeStep& step) const noexcept {
    const Outcome<Scalar> input = check_input(state, commands, step.step_s);
    if (!any_of(input == Status::ok)) return input;
    if constexpr (has_usual) {
      if (all_of(plain_) && usual_) return advance<true, true>(state, commands, step, input);
    }
    if (all_of(plain_)) return advance<true>(state, commands, step, input);
    if (!any_of(plain_)) return advance<false>(state, commands, step, input);
    // lanes of both kinds: each by the build of its own
    const Outcome<Scalar> of_plain =
        advance<true>(state, commands, step, detail::refused_where(!plain_, Status::invalid_airframe, input));
    const Outcome<Scalar> of_others =
        advance<false>(state, commands, step, detail::refused_where(plain_, Status::invalid_airframe, input));
    return select(plain_, of_plain, of_others);
  }
  /// The same for a step of this length.
  Outcome<Scalar> step(VehicleState<Scalar>& state, const Commands<Scalar>& commands, Scalar step_s) const noexcept {
    return step(state, commands, time_step(step_s));
  }

  /// Thrust and torque of the rotors over those in the standard atmosphere with a full battery: rho / rho_0 times the
  /// thrust scale.
  static constexpr Scalar rotor_scale(const Surroundings<Scalar>& air) noexcept {
    constexpr Scalar inverse = Scalar(1) / standard_air_density_kg_m3<Scalar>;
    return air.air_density_kg_m3 * inverse * air.thrust_scale;
  }

 private:
  Outcome<Scalar> first_fault(const Effects&... effects) const noexcept {
    Outcome<Scalar> fault = check_airframe(airframe_);
    fault = select(fault == Status::ok, rotors_.status(), fault);
    const Mask<Scalar> place =
        detail::bounded(site_.elevation_m) && detail::bounded(site_.ground_z_m) && detail::bounded(site_.gravity_m_s2);
    fault = detail::refused_where(!place, Status::out_of_range, fault);
    ((fault = select(fault == Status::ok, Outcome<Scalar>(effect_status(effects, airframe_)), fault)), ...);
    return fault;
  }

  /// A step where the input is good.
  template <bool plain, bool usual = false>
  PINNQUAD_FLATTEN Outcome<Scalar> advance(VehicleState<Scalar>& state, const Commands<Scalar>& commands,
                                           const TimeStep& step, const Outcome<Scalar>& input) const noexcept {
    const Scalar step_s = step.step_s;
    const ThrustFractions<Scalar> before = rotors_.template fractions<plain>(state.rotors);
    const ThrustFractions<Scalar> wanted = rotors_.template fractions<plain>(commands);
    const auto [time_constant_s, half_factor] = lag_of<plain>(before, wanted, step);
    const ThrustFractions<Scalar> middle = lagged(before, wanted, half_factor);
    const ThrustFractions<Scalar> end = lagged(middle, wanted, half_factor);
    const ThrustFractions<Scalar> start = at_start(before, end, time_constant_s);
    Outcome<Scalar> status = input;
    BatteryUse<Scalar> use{Scalar(state.charge_used_C), before};
    int calls = 0;
    const auto rate = [&](const State<Scalar>& body, Scalar offset_s) noexcept {
      const ThrustFractions<Scalar>& now = calls == 0 ? start : (calls < 3 ? middle : end);
      ++calls;
      const auto time_s = Scalar(state.time_s + Wide<Scalar>(offset_s));
      if constexpr (is_switched && !usual) return asked_rate_of_change<plain>(body, now, time_s, use, status);
      return rate_of_change<plain, usual>(body, now, time_s, use, status);
    };
    const State<Scalar> next = detail::rk4_step(state.body, step_s, rate);
    status = detail::refused_where(!(all_finite(next) && is_unit(next.attitude)), Status::output_not_finite, status);
    status = detail::refused_where(!detail::can_follow(next, step_s), Status::out_of_range, status);
    const Mask<Scalar> good = status == Status::ok;
    if (!any_of(good)) return status;
    state.body = select(good, next, state.body);
    state.rotors = select(good, rotors_.template commands_of<plain>(end), state.rotors);
    const Mask<Wide<Scalar>> done(good);
    state.time_s = select(done, Wide<Scalar>(state.time_s + Wide<Scalar>(step_s)), state.time_s);
    state.charge_used_C =
        select(done, Wide<Scalar>(state.charge_used_C + Wide<Scalar>(use.current_A * step_s)), state.charge_used_C);
    return status;
  }

  /// Time constant and factor over half a step: one for all, or each rotor's own.
  template <bool plain>
  auto lag_of(const ThrustFractions<Scalar>& before, const ThrustFractions<Scalar>& wanted,
              const TimeStep& step) const noexcept {
    if constexpr (plain) {
      static_cast<void>(before), static_cast<void>(wanted);
      return std::pair(airframe_.rise_time_constant_s(0), step.rise_factor[0]);
    } else {
      return std::pair(time_constants_s(airframe_, before, wanted),
                       by_direction(before, wanted, step.rise_factor, step.fall_factor));
    }
  }

  /// Out of line: the integers of its bit tests would cost the step a tenth of its time.
  PINNQUAD_NOINLINE Outcome<Scalar> check_input(const VehicleState<Scalar>& state, const Commands<Scalar>& commands,
                                                Scalar step_s) const noexcept {
    const Mask<Scalar> finite = all_finite(state.body) && all_finite(state.rotors) &&
                                Mask<Scalar>(is_finite(state.time_s)) && Mask<Scalar>(is_finite(state.charge_used_C)) &&
                                all_finite(commands) && is_finite(step_s);
    constexpr Wide<Scalar> latest_s(1e12);  // beyond, no clock in seconds tells milliseconds apart
    const Wide<Scalar> start_s = state.time_s, end_s = start_s + Wide<Scalar>(step_s);
    const Mask<Scalar> clock_moves = Mask<Scalar>(end_s > start_s) || detail::equal(step_s, Scalar(0));
    const Mask<Scalar> in_time(start_s >= -latest_s && end_s <= latest_s);
    Outcome<Scalar> status = detail::refused_where(!finite, Status::not_finite, status_);
    status = detail::refused_where(!(clock_moves && in_time && detail::can_follow(state.body, step_s)),
                                   Status::out_of_range, status);
    return detail::refused_where(!is_unit(state.body.attitude), Status::not_unit_quaternion, status);
  }

  static constexpr bool is_switched = (detail::is_switched<Effects> || ...), has_battery = (is_battery<Effects> || ...);
  static constexpr bool has_usual = (detail::has_usual_state<Effects> || ...);
  template <bool plain, bool usual>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> aerodynamic(const State<Scalar>& state, const Surroundings<Scalar>& air,
                                                    const ThrustFractions<Scalar>& thrusts) const noexcept {
    return sum_of_effects<plain, usual>(state, air, thrusts,
                                        [this](const auto& effect, const auto& condition)
                                            PINNQUAD_INLINE_LAMBDA { return effect.wrench(condition, airframe_); });
  }

  /// Folds the effects in their order; `wrench_of(effect, condition)` evaluates one.
  template <bool plain, bool usual, class WrenchOf>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> sum_of_effects(const State<Scalar>& state, const Surroundings<Scalar>& air,
                                                       const ThrustFractions<Scalar>& thrusts,
                                                       const WrenchOf& wrench_of) const noexcept {
    RotorCondition<Scalar> condition;
    const detail::Axes<Scalar> axes(state.attitude);
    const Vector3<Scalar>& v = state.velocity_m_s;
    condition.air_relative_velocity_m_s =
        axes.to_body(v[0] - air.wind_m_s[0], v[1] - air.wind_m_s[1], v[2] - air.wind_m_s[2]);
    condition.ground_velocity_m_s = axes.to_body(v[0], v[1], v[2]);
    condition.body_rates_rad_s = state.body_rates_rad_s;
    condition.attitude = state.attitude;
    condition.height_above_ground_m = site_.ground_z_m - state.position_m[2];
    condition.air_density_kg_m3 = air.air_density_kg_m3;
    condition.time_s = air.time_s;
    const auto show_rotors = [&]() PINNQUAD_INLINE_LAMBDA {
      condition.rotors = rotors_.template wrench_of<plain>(thrusts, rotor_scale(air));
      condition.rotor_thrust_N = rotors_.thrusts_of(thrusts, rotor_scale(air));
    };
    constexpr bool asked = is_switched && !usual;  // the compiler merges what all others show
    if (asked && rotor_effect_) show_rotors();
    each_effect<usual>([&](const auto& effect) PINNQUAD_INLINE_LAMBDA {
      using Effect = std::decay_t<decltype(effect)>;
      if constexpr (uses_rotor_wrench<Effect>) {
        if constexpr (!asked) show_rotors();
        condition.aerodynamic = condition.aerodynamic + wrench_of(effect, condition);
      } else if constexpr (makes_wrench<Effect>) {
        const AeroCondition<Scalar>& without_rotors = condition;
        condition.aerodynamic = condition.aerodynamic + wrench_of(effect, without_rotors);
      }
    });
    return condition.aerodynamic;
  }

  /// Adding no effects is no addition: the compiler may not leave out x + 0.
  static PINNQUAD_ALWAYS_INLINE Wrench<Scalar> total(const Evaluation& e) noexcept {
    if constexpr ((makes_wrench<Effects> || ...)) {
      return e.rotors + e.aerodynamic;
    } else {
      return e.rotors;
    }
  }

  /// An evaluation up to the wrenches.
  template <bool plain = false, bool usual = false>
  PINNQUAD_ALWAYS_INLINE Evaluation loads(const State<Scalar>& state, const ThrustFractions<Scalar>& thrusts,
                                          Scalar time_s, const BatteryUse<Scalar>& use) const noexcept {
    Evaluation result;
    result.surroundings = surroundings<usual>(state, time_s, use);
    const ThrustFractions<Scalar> turning = clipped(thrusts);
    result.rotors = rotors_.template wrench_of<plain>(turning, rotor_scale(result.surroundings));
    result.aerodynamic = aerodynamic<plain, usual>(state, result.surroundings, turning);
    return result;
  }

  /// The same motion as evaluate()'s, in world axes as the integrator wants it. v_dot = R f / m + g directly: Eq. (1)'s
  /// omega x v_B would be subtracted only to be added again.
  template <bool plain, bool usual>
  PINNQUAD_ALWAYS_INLINE detail::StateDerivative<Scalar> rate_of_change(const State<Scalar>& state,
                                                                        const ThrustFractions<Scalar>& thrusts,
                                                                        Scalar time_s, BatteryUse<Scalar>& use,
                                                                        Outcome<Scalar>& status) const noexcept {
    const Evaluation e = loads<plain, usual>(state, thrusts, time_s, use);
    if constexpr (has_battery) use.current_A = e.surroundings.battery.current_A;
    status = select(status == Status::ok, e.surroundings.status, status);
    // a battery can't reverse thrust
    status = detail::refused_where(!(e.surroundings.thrust_scale >= Scalar(0)), Status::out_of_range, status);
    const Wrench<Scalar> wrench = total(e);
    detail::StateDerivative<Scalar> d;
    d.velocity_m_s = state.velocity_m_s;
    const detail::Axes<Scalar> axes(state.attitude);
    if constexpr (plain && !(makes_wrench<Effects> || ...)) {
      d.acceleration_m_s2 = axes.to_world(wrench.force_N[2] * inverse_mass_);
    } else {
      d.acceleration_m_s2 = axes.to_world(wrench.force_N[0] * inverse_mass_, wrench.force_N[1] * inverse_mass_,
                                          wrench.force_N[2] * inverse_mass_);
    }
    d.acceleration_m_s2[2] += site_.gravity_m_s2;
    d.attitude_rate = attitude_rate(state.attitude, state.body_rates_rad_s);
    d.angular_acceleration_rad_s2 = angular_acceleration<plain>(airframe_, state.body_rates_rad_s, wrench.torque_N_m);
    return d;
  }

  /// Out of line: a step would hold four copies of all effects, more than an instruction cache does.
  template <bool plain>
  PINNQUAD_NOINLINE PINNQUAD_FLATTEN detail::StateDerivative<Scalar> asked_rate_of_change(
      const State<Scalar>& state, const ThrustFractions<Scalar>& thrusts, Scalar time_s, BatteryUse<Scalar>& use,
      Outcome<Scalar>& status) const noexcept {
    return rate_of_change<plain, false>(state, thrusts, time_s, use, status);
  }

  template <bool usual, class Function>
  PINNQUAD_ALWAYS_INLINE void each_effect(const Function& function) const noexcept {
    each_effect<usual>(function, std::index_sequence_for<Effects...>{});
  }
  template <bool usual, class Function, std::size_t... Index>
  PINNQUAD_ALWAYS_INLINE void each_effect(const Function& function, std::index_sequence<Index...>) const noexcept {
    (detail::with_effect<usual>(std::get<Index>(effects_), function), ...);
  }

  Airframe<Scalar> airframe_;
  Scalar inverse_mass_;
  Site<Scalar> site_;
  std::tuple<detail::BoundEffect<Effects, Scalar>...> effects_;
  Rotors<Scalar> rotors_;
  Mask<Scalar> plain_;
  bool usual_;  ///< Switched effects stand as usual
  bool rotor_effect_, branched_effect_;
  Outcome<Scalar> status_;
};

}  // namespace pinnquad
