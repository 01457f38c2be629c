// SPDX-License-Identifier: MIT
// "Model 1" of Table 2: Eq. (3), the dynamics linearised about hover, inverted. Its commands are not clipped
// (docs/paper.md, deviation 17).
#pragma once

#include "pinnquad/dynamics/rigid_body.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad {

/// Eq. (3) inverted: T = m (g - v_dot_z) and tau = J omega_dot, by Eq. (2) to commands of rotors whose thrust has this
/// scale (Quadrotor::rotor_scale). v_dot_x and v_dot_y are not used: four rotors command no lateral force, a tilted
/// rotor's comes with its thrust.
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
