// SPDX-License-Identifier: MIT
// Which aerodynamic effects the formula's vehicle has, as a record can say it: a number, and the coefficients of those that have
// some of their own.
#pragma once

#include <cstdint>
#include <tuple>
#include <type_traits>

#include "pinnquad/aero/drag.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace pinnquad::autopilot {

/// `code` has four bits for each effect, the first in the lowest; 0 ends it.
struct FlownEffects {
  static constexpr std::uint32_t quadratic_drag = 1, linear_damping = 2, another = 15;

  std::uint32_t code{0};
  float drag_N_s_m{0};          ///< of LinearDamping
  float rate_damping_N_m_s{0};  ///< of LinearDamping
};

/// Of more than eight effects the last stand for themselves and are `another`.
template <class... Effects>
FlownEffects flown_effects(const Quadrotor<float, Effects...>& vehicle) noexcept {
  FlownEffects flown;
  unsigned place = 0;
  const auto add = [&](const auto& effect) noexcept {
    using Effect = std::decay_t<decltype(effect)>;
    std::uint32_t code = FlownEffects::another;
    if constexpr (std::is_same_v<Effect, QuadraticDrag>) code = FlownEffects::quadratic_drag;
    if constexpr (std::is_same_v<Effect, LinearDamping>) {
      code =
          flown.drag_N_s_m > 0 || flown.rate_damping_N_m_s > 0 ? FlownEffects::another : FlownEffects::linear_damping;
      flown.drag_N_s_m = static_cast<float>(effect.drag_N_s_m);
      flown.rate_damping_N_m_s = static_cast<float>(effect.rate_damping_N_m_s);
    }
    flown.code |= (place < 8 ? code << (4 * place) : FlownEffects::another << 28);
    ++place;
  };
  static_cast<void>(add);
  std::apply([&add](const auto&... effect) noexcept { (add(effect), ...); }, vehicle.effects());
  return flown;
}

}  // namespace pinnquad::autopilot
