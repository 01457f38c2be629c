// SPDX-License-Identifier: MIT
// Eq. (3): the dynamics linearised about hover, both ways. Inverted it is "Model 1" of Table 2.
// docs/paper.md, deviation 17: v_dot_z gives T, omega_dot gives tau, Eq. (2) inverted gives the commands, which are not
// clipped.
#pragma once

#include "pinnquad/dynamics/rigid_body.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad {

/// Eq. (3): v_dot = (-theta T / m, phi T / m, g - T / m), omega_dot = J^-1 tau. `wrench.force_N` is (F_x, F_y, -T);
/// F_x / m and F_y / m of tilted rotors are added, upright ones have none.
template <class Scalar>
Accelerations<Scalar> linearized_accelerations(const Airframe<Scalar>& airframe, Scalar roll_rad, Scalar pitch_rad,
                                               const Wrench<Scalar>& wrench, Scalar gravity_m_s2) noexcept {
  const Scalar specific_thrust = -wrench.force_N[2] / airframe.mass_kg;
  Accelerations<Scalar> result;
  result.linear_m_s2 =
      Vector3<Scalar>(-pitch_rad * specific_thrust, roll_rad * specific_thrust, gravity_m_s2 - specific_thrust);
  result.linear_m_s2[0] += wrench.force_N[0] / airframe.mass_kg;
  result.linear_m_s2[1] += wrench.force_N[1] / airframe.mass_kg;
  result.angular_rad_s2 = inertia_solved(airframe, wrench.torque_N_m);
  return result;
}

/// Model 1, Eq. (3) inverted: T = m (g - v_dot_z), tau = J omega_dot, to commands of rotors whose thrust has this scale
/// (Quadrotor::rotor_scale). v_dot_x and v_dot_y are not used: four rotors command no lateral force, a tilted rotor's
/// comes with its thrust.
template <class Scalar>
Commands<Scalar> linearized_commands(const Airframe<Scalar>& airframe, const Rotors<Scalar>& rotors,
                                     const Accelerations<Scalar>& motion, Scalar gravity_m_s2,
                                     Scalar rotor_scale) noexcept {
  Wrench<Scalar> wrench;
  wrench.force_N = Vector3<Scalar>(Scalar(0), Scalar(0), airframe.mass_kg * (motion.linear_m_s2[2] - gravity_m_s2));
  wrench.torque_N_m = inertia_times(airframe, motion.angular_rad_s2);
  return rotors.commands(wrench, rotor_scale);
}

}  // namespace pinnquad
