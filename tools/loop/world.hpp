// SPDX-License-Identifier: MIT
// The vehicle of a comparison under a condition, and what a controller sees of it.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "loop/conditions.hpp"
#include "loop/drawn_wind.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/simulation/switched_quadrotor.hpp"
#include "pinnquad/simulation/tracking.hpp"

namespace programs {

/// A world that flies (simulation/tracking.hpp).
class LoopWorld {
  using Commands = pinnquad::Commands<double>;
  using Engine = std::mt19937_64;

 public:
  /// `still`: the vehicle's effects but for the wind. Steps are `how`'s. `voltage_V`: where a model reads the
  /// battery's, or null.
  LoopWorld(const pinnquad::Airframe<double>& told, const pinnquad::SwitchedEffects& still,
            const pinnquad::Site<double>& site, const LoopCondition& condition, const LoopSensors& sensors,
            const pinnquad::TrackingPlan<double>& how, std::uint64_t seed, double* voltage_V)
      : LoopWorld(Draw(told, still, condition, seed), site, condition, sensors, how, voltage_V) {}

  /// Factors of mass, inertia, all thrust and the weakest rotor's, and the wind, m/s towards north and east.
  struct Drawn {
    double mass = 1, inertia = 1, thrust = 1, rotor = 1, wind_north_m_s = 0, wind_east_m_s = 0;
  };
  const Drawn& drawn() const noexcept { return drawn_; }

  pinnquad::Status step(pinnquad::VehicleState<double>& state, const Commands& commands, double /*step_s*/) noexcept {
    const bool changed = !at_half_ || state.time_s >= half_s_;
    const pinnquad::SwitchedQuadrotor& vehicle = changed ? after_ : before_;
    pinnquad::ThrustFractions<double> thrusts = vehicle.rotors().fractions(pinnquad::clipped(commands));
    for (std::size_t i = 0; i < thrusts.size(); ++i) thrusts[i] *= changed ? strength_[i] : 1;
    return vehicle.step(state, vehicle.rotors().commands_of(thrusts), changed ? step_after_ : step_before_);
  }

  pinnquad::State<double> sense(const pinnquad::VehicleState<double>& state) noexcept {
    if (voltage_V_ != nullptr) *voltage_V_ = before_.surroundings(state).battery.voltage_V;
    pinnquad::State<double> seen = state.body;
    if (!late_.empty()) {
      seen = ticks_ < late_.size() ? (ticks_ == 0 ? state.body : late_.front()) : late_[ticks_ % late_.size()];
      late_[ticks_ % late_.size()] = state.body;
      ++ticks_;
    }
    pinnquad::Vector3<double> turn;
    for (int i = 0; i < 3; ++i) {
      seen.position_m[i] += sensors_.position_m * pinnquad::standard_normal(engine_);
      seen.velocity_m_s[i] += sensors_.velocity_m_s * pinnquad::standard_normal(engine_);
      seen.body_rates_rad_s[i] += sensors_.body_rates_rad_s * pinnquad::standard_normal(engine_);
      turn[i] = 0.5 * sensors_.attitude_rad * pinnquad::standard_normal(engine_);
    }
    seen.attitude = pinnquad::normalized(seen.attitude * pinnquad::Quaternion<double>{1, turn[0], turn[1], turn[2]});
    return seen;
  }

 private:
  /// A condition as a seed draws it.
  struct Draw {
    pinnquad::Airframe<double> told, flown;
    pinnquad::SwitchedEffects effects;
    Commands strength{1, 1, 1, 1};
    Engine engine;
    Drawn drawn;

    Draw(const pinnquad::Airframe<double>& airframe, const pinnquad::SwitchedEffects& still,
         const LoopCondition& condition, std::uint64_t seed)
        : told(airframe), flown(airframe), effects(still), engine(0x6c6f6f70u + 7919 * seed) {
      DrawnWind wind(engine);
      wind.mean_m_s = condition.wind_m_s * (condition.drawn ? pinnquad::uniform_01(engine) : 1);
      drawn.wind_north_m_s = wind.mean_m_s * wind.to[0];
      drawn.wind_east_m_s = wind.mean_m_s * wind.to[1];
      wind.blow(effects);
      const auto weak = static_cast<std::size_t>(pinnquad::uniform_index(engine, pinnquad::rotor_count));
      drawn.rotor = condition.drawn ? pinnquad::uniform(engine, condition.rotor, 1) : condition.rotor;
      for (double& each : strength) each = condition.battery;
      strength[weak] *= drawn.rotor;
      const auto wrong = [&] {
        if (condition.drawn) return 1 + pinnquad::uniform(engine, -condition.error, condition.error);
        return 1 + (engine() >> 63 != 0 ? condition.error : -condition.error);
      };
      drawn.mass = condition.mass * wrong();
      flown.mass_kg *= drawn.mass;
      drawn.inertia = wrong();
      for (double& each : flown.inertia_kg_m2) each *= drawn.inertia;
      drawn.thrust = wrong();
      flown.thrust_coefficient *= drawn.thrust;
      flown.power_coefficient *= drawn.thrust;
      if (condition.gusts) wind.gust(effects, engine, wind.mean_m_s);
    }
  };

  LoopWorld(const Draw& draw, const pinnquad::Site<double>& site, const LoopCondition& condition,
            const LoopSensors& sensors, const pinnquad::TrackingPlan<double>& how, double* voltage_V)
      : before_(quadrotor_with(draw.effects, draw.told, site)),
        after_(quadrotor_with(draw.effects, draw.flown, site)),
        step_before_(before_.time_step(how.physics_step_s)),
        step_after_(after_.time_step(how.physics_step_s)),
        drawn_(draw.drawn),
        strength_(draw.strength),
        at_half_(condition.at_half),
        half_s_(0.5 * how.duration_s),
        sensors_(sensors),
        engine_(draw.engine),
        voltage_V_(voltage_V),
        late_(static_cast<std::size_t>(std::lround(sensors.delay_s / how.control_period_s()))) {}

  pinnquad::SwitchedQuadrotor before_, after_;
  pinnquad::SwitchedQuadrotor::TimeStep step_before_, step_after_;
  Drawn drawn_;
  Commands strength_;
  bool at_half_;
  double half_s_;
  LoopSensors sensors_;
  Engine engine_;
  double* voltage_V_;
  std::vector<pinnquad::State<double>> late_;
  std::size_t ticks_ = 0;
};

}  // namespace programs
