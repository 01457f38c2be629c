// SPDX-License-Identifier: MIT
// A payload picked up in flight: more mass, the same forces.
#pragma once

#include "pinnquad/aero/effect.hpp"

namespace pinnquad {

/// F = -m_p / (m + m_p) (F_rotors + F_before), from a time on: with it m a = m g + sum of forces has the solution of
/// (m + m_p) a = (m + m_p) g + forces, exactly. It is the last effect, as it scales those before it alone.
/// A point mass fixed at the centre of gravity: inertia and torques stay. It is taken up at the vehicle's velocity,
/// without a jolt. A load that hangs, lies off the centre or has an inertia is another airframe: fly one Simulator to
/// the time, then another from its last state.
struct Payload {
  static constexpr bool comes_last = true;
  double mass_kg{0};
  double from_s{0};

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> wrench(const RotorCondition<Scalar>& condition,
                                               const Airframe<Scalar>& airframe) const noexcept {
    const Wrench<Scalar> none;
    const Mask<Scalar> taken = !(condition.time_s < Scalar(from_s));
    if (!any_of(taken)) return none;
    Wrench<Scalar> result;
    const Scalar share = Scalar(mass_kg) / (airframe.mass_kg + Scalar(mass_kg));
    result.force_N = (condition.rotors.force_N + condition.aerodynamic.force_N) * -share;
    return select(taken, result, none);
  }

  /// `out_of_range` for a mass that is negative or no number, or such a time.
  template <class Scalar>
  constexpr Status status(const Airframe<Scalar>&) const noexcept {
    return detail::plausible_or_zero(mass_kg) && detail::bounded(from_s) ? Status::ok : Status::out_of_range;
  }
};

}  // namespace pinnquad
