// SPDX-License-Identifier: MIT
// Things that a controller does not know of: wind, a payload, a weak rotor, an empty battery, wrong parameters. A
// condition by name and seed is the same for every controller.
#pragma once

#include <array>
#include <cmath>
#include <random>

#include "pinnquad/core/random.hpp"
#include "pinnquad/simulation/switched_quadrotor.hpp"

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
  bool drawn = false;  ///< wind, rotor and errors are bounds, within which a seed draws each
};

inline constexpr std::array<LoopCondition, 13> loop_conditions = {{
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
    {"drawn", "gusty wind to 8 m/s, one rotor at 85 to 100 %, mass, inertia, thrust within 15 %", 8, true, 1, 0.85, 1,
     0.15, false, true},
}};

/// A wind that blows where an engine draws.
struct DrawnWind {
  std::array<double, 2> to;  ///< north, east; of unit length
  double mean_m_s = 0;

  explicit DrawnWind(std::mt19937_64& engine) {
    const double heading = pinnquad::uniform(engine, 0, 6.283185307179586);
    to = {std::cos(heading), std::sin(heading)};
  }
  pinnquad::ConstantWind mean() const { return {{mean_m_s * to[0], mean_m_s * to[1], 0}}; }
  /// 20 m above ground, by the wind at 20 ft.
  pinnquad::DrydenTurbulence<> gusts(std::mt19937_64& engine, double at_20_ft_m_s) const {
    return {engine, pinnquad::DrydenParameters::low_altitude(at_20_ft_m_s, 20), mean_m_s, to};
  }
};

/// White noise of what a controller sees, a standard deviation for each sample of each axis; and its delay.
struct LoopSensors {
  double position_m = 0.005, velocity_m_s = 0.02, attitude_rad = 0.002, body_rates_rad_s = 0.02;
  double delay_s = 0;
};

}  // namespace programs
