// SPDX-License-Identifier: MIT
// A wind of which an engine draws where it blows to, and its gusts.
#pragma once

#include <array>
#include <cmath>
#include <random>

#include "pinnquad/core/random.hpp"
#include "pinnquad/simulation/switched_quadrotor.hpp"

namespace programs {

struct DrawnWind {
  std::array<double, 2> to;  ///< north, east; of unit length
  double mean_m_s = 0;

  explicit DrawnWind(std::mt19937_64& engine) {
    const double heading = pinnquad::uniform(engine, 0, 6.283185307179586);
    to = {std::cos(heading), std::sin(heading)};
  }
  void blow(pinnquad::SwitchedEffects& effects) const {
    switch_effect(effects, pinnquad::ConstantWind{{mean_m_s * to[0], mean_m_s * to[1], 0}});
  }
  /// Of a wind of `strength_m_s` at 20 ft.
  void gust(pinnquad::SwitchedEffects& effects, std::mt19937_64& engine, double strength_m_s) const {
    constexpr double height_m = 20;
    const auto parameters = pinnquad::DrydenParameters::low_altitude(strength_m_s, height_m);
    switch_effect(effects, pinnquad::DrydenTurbulence<>(engine, parameters, mean_m_s, to));
  }
};

}  // namespace programs
