// SPDX-License-Identifier: MIT
// Eq. (3): the dynamics linearised about hover, of which linearized_commands() is the inverse.
#pragma once

#include "pinnquad/dynamics/rigid_body.hpp"

namespace pinnquad::test {

/// v_dot = (-theta T / m, phi T / m, g - T / m), omega_dot = J^-1 tau. `wrench.force_N` is (F_x, F_y, -T); F_x / m and
/// F_y / m of tilted rotors are added, upright ones have none.
template <class Scalar>
Accelerations<Scalar> linearized_accelerations(const Airframe<Scalar>& airframe, Scalar roll_rad, Scalar pitch_rad,
                                               const Wrench<Scalar>& wrench, Scalar gravity_m_s2) {
  const Scalar specific_thrust = -wrench.force_N[2] / airframe.mass_kg;
  Accelerations<Scalar> result;
  result.linear_m_s2 =
      Vector3<Scalar>(-pitch_rad * specific_thrust, roll_rad * specific_thrust, gravity_m_s2 - specific_thrust);
  result.linear_m_s2[0] += wrench.force_N[0] / airframe.mass_kg;
  result.linear_m_s2[1] += wrench.force_N[1] / airframe.mass_kg;
  result.angular_rad_s2 = inertia_solved(airframe, wrench.torque_N_m);
  return result;
}

}  // namespace pinnquad::test
