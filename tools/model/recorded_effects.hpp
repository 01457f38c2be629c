// SPDX-License-Identifier: MIT
// The effects of the analytic inverse's vehicle, as a record names them at run time (CoreSettings::effects).
#pragma once

#include <cstdint>
#include <stdexcept>

#include "command_line/in_words.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/control/autopilot/core_record.hpp"

namespace programs {

/// The sum of the effects in their order, as a vehicle of their types has it.
struct RecordedEffects {
  static constexpr pinnquad::VariesWith varies_with = pinnquad::VariesWith::motion;
  std::uint32_t effects{0};
  pinnquad::LinearDamping damping{0, 0};

  template <class Scalar>
  pinnquad::Wrench<Scalar> wrench(const pinnquad::AeroCondition<Scalar>& condition,
                                  const pinnquad::Airframe<Scalar>& airframe) const noexcept {
    pinnquad::Wrench<Scalar> sum;
    for (std::uint32_t code = effects; code != 0; code >>= 4) {
      if ((code & 15u) == pinnquad::autopilot::CoreSettings::quadratic_drag) {
        sum = sum + pinnquad::QuadraticDrag{}.wrench(condition, airframe);
      } else {
        sum = sum + damping.wrench(condition, airframe);
      }
    }
    return sum;
  }
};

/// Throws std::invalid_argument, one line, for an effect that is not known here.
inline RecordedEffects recorded_effects(const pinnquad::autopilot::CoreSettings& settings) {
  using pinnquad::autopilot::CoreSettings;
  for (std::uint32_t code = settings.effects; code != 0; code >>= 4) {
    const std::uint32_t effect = code & 15u;
    if (effect == CoreSettings::quadratic_drag || effect == CoreSettings::linear_damping) continue;
    throw std::invalid_argument(
        in_words("the analytic inverse that flew knew an effect that replay does not (effects %x): QuadraticDrag and "
                 "LinearDamping are known",
                 settings.effects));
  }
  return {settings.effects,
          {static_cast<double>(settings.drag_n_s_m), static_cast<double>(settings.rate_damping_n_m_s)}};
}

}  // namespace programs
