// SPDX-License-Identifier: MIT
// Flapping: the moment of a rotor in a sideways wind, which lifts more where the air comes from.
#pragma once

#include "pinnquad/aero/inflow.hpp"

namespace pinnquad {

/// tau_i = k T_i (v_i x a_i), v_i the hub's air-relative velocity, a_i the rotor's axis, FRD: nose up in forward
/// flight, the right side up in flight to the right. No force. In fast flight the rear rotors have more to do.
/// k [s] is a lever over a speed. A soft blade flaps: k_beta a_1s of Hoffmann, Huang, Waslander and Tomlin, Quadrotor
/// helicopter flight dynamics and control (AIAA 2007), linear in the speed as in Mahony, Kumar and Corke, Multirotor
/// aerial vehicles (IEEE RAM 2012). A stiff propeller has the same moment from its skewed wake: with Coleman's inflow
/// v_i (1 + tan(chi / 2) r / R cos(psi)) (1945; Leishman 2006, ch. 3) blade elements give
///   k = R gain w tan(chi / 2) / (4 V),  tan(chi) = x / u     (gain, w, x, u as in aero/inflow.hpp)
/// which falls from R gain / (8 v_h) at rest, 0.0023 s for a 9-inch propeller under a kilogram, to 0.0011 s at 10 m/s,
/// rounded as the default. The formula is theory's; its factor is ours to choose.
/// The rolling moment of the advancing blades has the sign of the spin and cancels between four equal rotors: left out.
struct BladeFlapping {
  static constexpr VariesWith varies_with = VariesWith::motion;
  double coefficient_s{0.001};

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> wrench(const RotorCondition<Scalar>& condition,
                                               const Airframe<Scalar>& airframe) const noexcept {
    const Scalar k = Scalar(coefficient_s);
    Wrench<Scalar> result;
    for (std::size_t i = 0; i < rotor_count; ++i) {
      const RotorMount<Scalar>& hub = airframe.rotors[i];
      const Vector3<Scalar> v = detail::hub_flow(condition, hub).velocity_m_s;
      const Scalar scale = k * condition.rotor_thrust_N[i];
      result.torque_N_m += Vector3<Scalar>(scale * (v[1] * hub.axis[2] - v[2] * hub.axis[1]),
                                           scale * (v[2] * hub.axis[0] - v[0] * hub.axis[2]),
                                           scale * (v[0] * hub.axis[1] - v[1] * hub.axis[0]));
    }
    return result;
  }

  /// `out_of_range` for a coefficient that is negative or no number.
  template <class Scalar>
  constexpr Status status(const Airframe<Scalar>&) const noexcept {
    return detail::plausible_or_zero(coefficient_s) ? Status::ok : Status::out_of_range;
  }
};

}  // namespace pinnquad
