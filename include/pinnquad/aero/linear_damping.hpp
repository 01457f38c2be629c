// SPDX-License-Identifier: MIT
// Damping that is linear in the motion: the drag of a simple simulator, and what a slow vehicle's drag is near hover.
#pragma once

#include "pinnquad/aero/effect.hpp"

namespace pinnquad {

/// F = -k v, tau = -c omega: v the air-relative velocity, body axes, the same along each of them. PX4's simulation in
/// hardware has both (its parameters SIH_KDV and SIH_KDW, whose values are the default here; it has no wind).
struct LinearDamping {
  static constexpr VariesWith varies_with = VariesWith::motion;
  double drag_N_s_m{1.0};
  double rate_damping_N_m_s{0.025};

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> wrench(const AeroCondition<Scalar>& condition,
                                               const Airframe<Scalar>&) const noexcept {
    Wrench<Scalar> result;
    result.force_N = condition.air_relative_velocity_m_s * Scalar(-drag_N_s_m);
    result.torque_N_m = condition.body_rates_rad_s * Scalar(-rate_damping_N_m_s);
    return result;
  }

  /// `out_of_range` for a coefficient that is negative or no number.
  template <class Scalar>
  constexpr Status status(const Airframe<Scalar>&) const noexcept {
    return detail::plausible_or_zero(drag_N_s_m) && detail::plausible_or_zero(rate_damping_N_m_s)
               ? Status::ok
               : Status::out_of_range;
  }
};

}  // namespace pinnquad
