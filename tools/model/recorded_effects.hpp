// SPDX-License-Identifier: MIT
// The effects of the analytic inverse's vehicle, as a record names them at run time (FlownEffects in
// pinnquad/control/autopilot/core_settings.hpp).
#pragma once

#include <cstdint>
#include <stdexcept>

#include "command_line/listed.hpp"
#include "model/replayed_row.hpp"
#include "pinnquad/control/autopilot/core_settings.hpp"

namespace programs {

/// The sum of the effects in their order, as a vehicle of their types has it.
struct RecordedEffects {
  static constexpr pinnquad::VariesWith varies_with = pinnquad::VariesWith::motion;
  pinnquad::autopilot::FlownEffects flown{};

  template <class Scalar>
  pinnquad::Wrench<Scalar> wrench(const pinnquad::AeroCondition<Scalar>& condition,
                                  const pinnquad::Airframe<Scalar>& airframe) const noexcept {
    pinnquad::Wrench<Scalar> sum;
    for (std::uint32_t code = flown.code; code != 0; code >>= 4) {
      if ((code & 15u) == pinnquad::autopilot::FlownEffects::quadratic_drag) {
        sum = sum + pinnquad::QuadraticDrag{}.wrench(condition, airframe);
      } else {
        const pinnquad::LinearDamping damping{static_cast<double>(flown.drag_N_s_m),
                                              static_cast<double>(flown.rate_damping_N_m_s)};
        sum = sum + damping.wrench(condition, airframe);
      }
    }
    return sum;
  }
};

/// Throws std::invalid_argument, one line, for an effect that is not known here.
inline RecordedEffects recorded_effects(const pinnquad::autopilot::CoreSettings& settings) {
  using pinnquad::autopilot::FlownEffects;
  for (std::uint32_t code = settings.effects; code != 0; code >>= 4) {
    const std::uint32_t effect = code & 15u;
    if (effect == FlownEffects::quadratic_drag || effect == FlownEffects::linear_damping) continue;
    throw std::invalid_argument(
        in_words("the analytic inverse that flew knew an effect that replay does not (effects %x): QuadraticDrag and "
                 "LinearDamping are known",
                 settings.effects));
  }
  return {{settings.effects, settings.drag_n_s_m, settings.rate_damping_n_m_s}};
}

}  // namespace programs
