// SPDX-License-Identifier: MIT
// A rotor that is weak from a time on: a chipped propeller, a tired motor.
#pragma once

#include "pinnquad/aero/effect.hpp"
#include "pinnquad/dynamics/allocation.hpp"

namespace pinnquad {

/// (share - 1) times the wrench of one rotor, thrust and reaction torque, from a time on; none before it.
/// Exact for the rotors. Effects that read the rotors' thrusts (drag, inflow) see the rotor as it was: their error is
/// their share of its thrust times 1 - share. A rotor that is weak from the start is RotorMount::thrust_scale, without
/// that error. The inverse knows the fault; share 0 leaves three rotors, for which it has `no_solution`.
struct RotorFault {
  unsigned rotor{0};  ///< in the order of the commands
  double share{1};    ///< of thrust and torque at the same command
  double from_s{0};

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> wrench(const RotorCondition<Scalar>& condition,
                                               const Airframe<Scalar>& airframe) const noexcept {
    const Wrench<Scalar> none;
    const Mask<Scalar> weak = !(condition.time_s < Scalar(from_s));
    if (!any_of(weak)) return none;
    Wrench<Scalar> result;
    const RotorMount<Scalar>& hub = airframe.rotors[rotor % rotor_count];
    const Scalar along_N = Scalar(share - 1) * condition.rotor_thrust_N[rotor % rotor_count];
    const Scalar torque_over_thrust_m = airframe.max_rotor_torque_N_m() / airframe.max_rotor_thrust_N();
    result.force_N = to_vector(hub.axis) * along_N;
    result.torque_N_m = to_vector(detail::rotor_torque_N_m(hub, along_N, torque_over_thrust_m * along_N));
    return select(weak, result, none);
  }

  /// `out_of_range` for a rotor that is not there, a share outside 0 to 1, or a time that is no number.
  template <class Scalar>
  constexpr Status status(const Airframe<Scalar>&) const noexcept {
    const bool holds = rotor < rotor_count && share >= 0 && share <= 1 && detail::bounded(from_s);
    return holds ? Status::ok : Status::out_of_range;
  }
};

}  // namespace pinnquad
