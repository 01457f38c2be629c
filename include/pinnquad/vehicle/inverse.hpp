// SPDX-License-Identifier: MIT
// Inverse dynamics by formula: motion -> wrench -> commands, through the same effects that fly.
#pragma once

#include "pinnquad/vehicle/quadrotor.hpp"

namespace pinnquad {

/// Commands (not clipped) that make the motion in this state at this time.
/// The wrench of Eq. (1) less the aerodynamic one, through the inverted Eq. (2). Lateral force can't be made by the rotors;
/// what the motion demands of it is ignored. If an effect uses the rotors' wrench (ground effect), thrust and effect are
/// iterated to agreement within 1e-6 of thrust and weight; `no_solution` if they don't agree in 50 rounds.
/// `not_finite` for NaN or Inf in state or motion, `not_unit_quaternion`, and what Quadrotor::status() says; the commands are untouched unless the Status is ok.
template <class Scalar, class... Effects>
Status inverse_commands(const Quadrotor<Scalar, Effects...>& quadrotor, const State<Scalar>& state,
                        const Accelerations<Scalar>& motion, Scalar time_s, Commands<Scalar>& commands) noexcept {
  if (quadrotor.status() != Status::ok) return quadrotor.status();
  if (!(all_finite(state) && all_finite(motion.linear_m_s2) && all_finite(motion.angular_rad_s2) && is_finite(time_s))) {
    return Status::not_finite;
  }
  if (!is_unit(state.attitude)) return Status::not_unit_quaternion;
  const Surroundings<Scalar> air = quadrotor.surroundings(state, time_s);
  const Wrench<Scalar> required =
      required_wrench(quadrotor.airframe(), state, motion, quadrotor.site().gravity_m_s2);
  Wrench<Scalar> rotors = required;
  rotors.force_N = Vector3<Scalar>(Scalar(0), Scalar(0), required.force_N[2]);
  constexpr bool coupled = (uses_rotor_wrench<Effects> || ...);
  constexpr int rounds = coupled ? 50 : 1;
  bool agreed = !coupled;
  for (int round = 0; round < rounds; ++round) {
    const Wrench<Scalar> effects = quadrotor.aerodynamic_wrench(state, air, rotors);
    const Scalar thrust_before = rotors.force_N[2];
    rotors.force_N[2] = required.force_N[2] - effects.force_N[2];
    rotors.torque_N_m = required.torque_N_m - effects.torque_N_m;
    if constexpr (coupled) {
      const Scalar change = rotors.force_N[2] - thrust_before;
      const Scalar weight_N = quadrotor.airframe().mass_kg * quadrotor.site().gravity_m_s2;
      const Scalar scale = Scalar(1e-6) * ((rotors.force_N[2] < Scalar(0) ? -rotors.force_N[2] : rotors.force_N[2]) + weight_N);
      agreed = (change < Scalar(0) ? -change : change) <= scale;
      if (agreed) break;
    }
  }
  if (!agreed) return Status::no_solution;
  const Commands<Scalar> result = quadrotor.rotors().commands(rotors, quadrotor.density_ratio(air));
  if (!all_finite(result)) return Status::output_not_finite;
  commands = result;
  return Status::ok;
}

}  // namespace pinnquad
