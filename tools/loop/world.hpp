// SPDX-License-Identifier: MIT
// The vehicle of a comparison under a condition, and what a controller sees of it.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "loop/conditions.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/simulation/switched_quadrotor.hpp"
#include "pinnquad/simulation/tracking.hpp"

namespace programs {

/// A world that flies (simulation/tracking.hpp).
class LoopWorld {
  using Commands = pinnquad::Commands<double>;

 public:
  /// `still`: the vehicle's effects but for the wind. Steps are `how`'s. `voltage_V`: where a model reads the
  /// battery's, or null.
  LoopWorld(const pinnquad::Airframe<double>& told, const pinnquad::SwitchedEffects& still,
            const pinnquad::Site<double>& site, const LoopCondition& condition, const LoopSensors& sensors,
            const pinnquad::TrackingPlan<double>& how, std::uint64_t seed, double* voltage_V)
      : draw_(told, still, condition, seed),
        before_(quadrotor_with(draw_.effects, told, site)),
        after_(quadrotor_with(draw_.effects, draw_.flown, site)),
        step_before_(before_.time_step(how.physics_step_s)),
        step_after_(after_.time_step(how.physics_step_s)),
        at_half_(condition.at_half),
        half_s_(0.5 * how.duration_s),
        sensors_(sensors),
        voltage_V_(voltage_V),
        late_(static_cast<std::size_t>(std::lround(sensors.delay_s / how.control_period_s()))) {}

  /// A condition as a seed draws it.
  struct Draw {
    pinnquad::Airframe<double> flown;
    pinnquad::SwitchedEffects effects;
    Commands strength{1, 1, 1, 1};
    /// Factors of mass, inertia, all thrust and the weakest rotor's, and the wind, m/s towards north and east.
    double mass = 1, inertia = 1, thrust = 1, rotor = 1, wind_north_m_s = 0, wind_east_m_s = 0;
    std::mt19937_64 engine;

    Draw(const pinnquad::Airframe<double>& told, const pinnquad::SwitchedEffects& still, const LoopCondition& condition,
         std::uint64_t seed)
        : flown(told), effects(still), engine(0x6c6f6f70u + 7919 * seed) {
      DrawnWind wind(engine);
      wind.mean_m_s = condition.wind_m_s * (condition.drawn ? pinnquad::uniform_01(engine) : 1);
      wind_north_m_s = wind.mean_m_s * wind.to[0];
      wind_east_m_s = wind.mean_m_s * wind.to[1];
      switch_effect(effects, wind.mean());
      const auto weak = static_cast<std::size_t>(pinnquad::uniform_index(engine, pinnquad::rotor_count));
      rotor = condition.drawn ? pinnquad::uniform(engine, condition.rotor, 1) : condition.rotor;
      for (double& each : strength) each = condition.battery;
      strength[weak] *= rotor;
      const auto wrong = [&] {
        if (condition.drawn) return 1 + pinnquad::uniform(engine, -condition.error, condition.error);
        return 1 + (engine() >> 63 != 0 ? condition.error : -condition.error);
      };
      mass = condition.mass * wrong();
      flown.mass_kg *= mass;
      inertia = wrong();
      for (double& each : flown.inertia_kg_m2) each *= inertia;
      thrust = wrong();
      flown.thrust_coefficient *= thrust;
      flown.power_coefficient *= thrust;
      if (condition.gusts) switch_effect(effects, wind.gusts(engine, wind.mean_m_s));
    }
  };
  const Draw& drawn() const noexcept { return draw_; }

  pinnquad::Status step(pinnquad::VehicleState<double>& state, const Commands& commands, double /*step_s*/) noexcept {
    const bool changed = !at_half_ || state.time_s >= half_s_;
    const pinnquad::SwitchedQuadrotor& vehicle = changed ? after_ : before_;
    pinnquad::ThrustFractions<double> thrusts = vehicle.rotors().fractions(pinnquad::clipped(commands));
    for (std::size_t i = 0; i < thrusts.size(); ++i) thrusts[i] *= changed ? draw_.strength[i] : 1;
    return vehicle.step(state, vehicle.rotors().commands_of(thrusts), changed ? step_after_ : step_before_);
  }

  pinnquad::State<double> sense(const pinnquad::VehicleState<double>& state) noexcept {
    if (voltage_V_ != nullptr) *voltage_V_ = before_.surroundings(state).battery.voltage_V;
    pinnquad::State<double> seen = state.body;
    if (ticks_ == 0) late_.assign(late_.size(), state.body);
    if (!late_.empty()) std::swap(seen, late_[ticks_++ % late_.size()]);
    pinnquad::Vector3<double> turn;
    for (int i = 0; i < 3; ++i) {
      seen.position_m[i] += sensors_.position_m * pinnquad::standard_normal(draw_.engine);
      seen.velocity_m_s[i] += sensors_.velocity_m_s * pinnquad::standard_normal(draw_.engine);
      seen.body_rates_rad_s[i] += sensors_.body_rates_rad_s * pinnquad::standard_normal(draw_.engine);
      turn[i] = 0.5 * sensors_.attitude_rad * pinnquad::standard_normal(draw_.engine);
    }
    seen.attitude = pinnquad::normalized(seen.attitude * pinnquad::Quaternion<double>{1, turn[0], turn[1], turn[2]});
    return seen;
  }

 private:
  Draw draw_;
  pinnquad::SwitchedQuadrotor before_, after_;
  pinnquad::SwitchedQuadrotor::TimeStep step_before_, step_after_;
  bool at_half_;
  double half_s_;
  LoopSensors sensors_;
  double* voltage_V_;
  std::vector<pinnquad::State<double>> late_;
  std::size_t ticks_ = 0;
};

}  // namespace programs
