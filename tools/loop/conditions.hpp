// SPDX-License-Identifier: MIT
// Things that a controller does not know of: wind, a payload, a weak rotor, an empty battery, wrong parameters. A
// condition by name and seed is the same for every controller.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "pinnquad/aero/dryden.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/simulation/tracking.hpp"

namespace programs {

/// Factors are of what the controller was told; wind in m/s.
struct LoopCondition {
  const char* name;
  const char* summary;
  double wind_m_s = 0;
  bool gusts = false;
  double mass = 1;
  double rotor = 1;    ///< thrust of one rotor
  double battery = 1;  ///< thrust of all
  double error = 0;    ///< of mass, inertia and thrust, either way by seed
  bool at_half = false;
};

inline constexpr std::array<LoopCondition, 12> loop_conditions = {{
    {"calm", "as the controller knows it"},
    {"wind_4", "wind of 4 m/s", 4},
    {"wind_8", "wind of 8 m/s", 8},
    {"wind_12", "wind of 12 m/s", 12},
    {"gusts", "wind of 6 m/s and the gusts of Dryden's spectra", 6, true},
    {"payload", "20 % heavier", 0, false, 1.2},
    {"weak_rotor", "one rotor makes 85 % of its thrust", 0, false, 1, 0.85},
    {"battery", "all rotors make 88 % of their thrust", 0, false, 1, 1, 0.88},
    {"parameters", "mass, inertia and thrust wrong by 10 %", 0, false, 1, 1, 1, 0.1},
    {"payload_half", "20 % heavier from half time on", 0, false, 1.2, 1, 1, 0, true},
    {"weak_rotor_half", "one rotor makes 80 % from half time on", 0, false, 1, 0.8, 1, 0, true},
    {"battery_half", "all rotors make 88 % from half time on", 0, false, 1, 1, 0.88, 0, true},
}};

/// White noise of what a controller sees, a standard deviation for each sample of each axis; and its delay.
struct LoopSensors {
  double position_m = 0.005, velocity_m_s = 0.02, attitude_rad = 0.002, body_rates_rad_s = 0.02;
  double delay_s = 0;
};

/// Gusts that may be missing.
struct MaybeGusts {
  std::optional<pinnquad::DrydenTurbulence<>> gusts{};

  template <class Scalar>
  void surroundings(pinnquad::Surroundings<Scalar>& air) const noexcept {
    if (gusts) gusts->surroundings(air);
  }
  template <class Scalar>
  pinnquad::Status status(const pinnquad::Airframe<Scalar>& airframe) const noexcept {
    return gusts ? gusts->status(airframe) : pinnquad::Status::ok;
  }
};

/// A world that flies (simulation/tracking.hpp). Vehicle: with ConstantWind and MaybeGusts among its effects.
template <class Vehicle>
class LoopWorld {
  using Commands = pinnquad::Commands<double>;
  using Engine = std::mt19937_64;

 public:
  /// `make(airframe, wind, gusts)` gives the vehicle.
  template <class Make>
  LoopWorld(const pinnquad::Airframe<double>& told, const LoopCondition& condition, const LoopSensors& sensors,
            double control_period_s, double half_s, std::uint64_t seed, const Make& make)
      : LoopWorld(Draw(told, condition, seed), condition, sensors, control_period_s, half_s, make) {}

  pinnquad::Status step(pinnquad::VehicleState<double>& state, const Commands& commands, double step_s) noexcept {
    const bool changed = !at_half_ || state.time_s >= half_s_;
    const Vehicle& vehicle = changed ? after_ : before_;
    pinnquad::ThrustFractions<double> thrusts = vehicle.rotors().fractions(pinnquad::clipped(commands));
    for (std::size_t i = 0; i < thrusts.size(); ++i) thrusts[i] *= changed ? strength_[i] : 1;
    return vehicle.step(state, vehicle.rotors().commands_of(thrusts), step_s);
  }

  pinnquad::State<double> sense(const pinnquad::VehicleState<double>& state) noexcept {
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

  const Vehicle& vehicle() const noexcept { return after_; }

 private:
  /// A condition as a seed draws it.
  struct Draw {
    pinnquad::Airframe<double> told, flown;
    pinnquad::ConstantWind wind{};
    MaybeGusts gusts{};
    Commands strength{1, 1, 1, 1};
    Engine engine;

    Draw(const pinnquad::Airframe<double>& airframe, const LoopCondition& condition, std::uint64_t seed)
        : told(airframe), flown(airframe), engine(0x6c6f6f70u + 7919 * seed) {
      const double heading = pinnquad::uniform(engine, 0, 6.283185307179586);
      const std::array<double, 2> to = {std::cos(heading), std::sin(heading)};
      wind.velocity_m_s = {condition.wind_m_s * to[0], condition.wind_m_s * to[1], 0};
      const auto weak = static_cast<std::size_t>(pinnquad::uniform_index(engine, pinnquad::rotor_count));
      for (double& each : strength) each = condition.battery;
      strength[weak] *= condition.rotor;
      const auto wrong = [&] { return 1 + (engine() >> 63 != 0 ? condition.error : -condition.error); };
      flown.mass_kg *= condition.mass * wrong();
      const double inertia = wrong();
      for (double& each : flown.inertia_kg_m2) each *= inertia;
      const double thrust = wrong();
      flown.thrust_coefficient *= thrust;
      flown.power_coefficient *= thrust;
      if (!condition.gusts) return;
      constexpr double height_m = 20;
      gusts.gusts.emplace(engine, pinnquad::DrydenParameters::low_altitude(condition.wind_m_s, height_m),
                          condition.wind_m_s, to);
    }
  };

  template <class Make>
  LoopWorld(const Draw& draw, const LoopCondition& condition, const LoopSensors& sensors, double control_period_s,
            double half_s, const Make& make)
      : before_(make(draw.told, draw.wind, draw.gusts)),
        after_(make(draw.flown, draw.wind, draw.gusts)),
        strength_(draw.strength),
        at_half_(condition.at_half),
        half_s_(half_s),
        sensors_(sensors),
        engine_(draw.engine),
        late_(static_cast<std::size_t>(std::lround(sensors.delay_s / control_period_s))) {}

  Vehicle before_, after_;
  Commands strength_;
  bool at_half_;
  double half_s_;
  LoopSensors sensors_;
  Engine engine_;
  std::vector<pinnquad::State<double>> late_;
  std::size_t ticks_ = 0;
};

}  // namespace programs
