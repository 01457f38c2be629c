// SPDX-License-Identifier: MIT
// Body drag, quadratic in the air-relative velocity of each body axis.
#pragma once

#include "pinnquad/aero/effect.hpp"

namespace pinnquad {

/// F_i = -k_i rho |v_i| v_i for |v_i| above the airframe's deadband, else 0; body axes, no torque.
/// v is relative to the air, k from Airframe::drag_area_m2. Source: the paper's simulator.
struct QuadraticDrag {
  static constexpr VariesWith varies_with = VariesWith::motion;

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> wrench(const AeroCondition<Scalar>& condition,
                                               const Airframe<Scalar>& airframe) const noexcept {
    Wrench<Scalar> result;
    for (int i = 0; i < 3; ++i) {
      const Scalar v = condition.air_relative_velocity_m_s[i];
      const Scalar speed = v < Scalar(0) ? -v : v;
      const Scalar k = airframe.drag_area_m2[static_cast<std::size_t>(i)];
      // chosen, not branched: near the deadband a branch would be guessed wrong
      const Scalar drag = -(k * condition.air_density_kg_m3) * (speed * v);
      result.force_N[i] = speed <= airframe.drag_deadband_m_s ? Scalar(0) : drag;
    }
    return result;
  }
};

}  // namespace pinnquad
