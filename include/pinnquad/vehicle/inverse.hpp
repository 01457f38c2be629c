// SPDX-License-Identifier: MIT
// The analytic inverse: motion -> wrench -> commands, through the same effects that fly.
#pragma once

#include "pinnquad/vehicle/rotor_equation.hpp"

namespace pinnquad {

/// Commands (not clipped) that make the motion in this state at this time.
/// The wrench of Eq. (1) less the aerodynamic one, through the inverted Eq. (2); where an effect depends on the rotors
/// (ground effect), both are solved together (rotor_equation.hpp). Lateral force can't be made by the rotors; what the
/// motion demands of it is ignored. Where two solutions exist, the one with the greater thrust; `no_solution` where
/// none. `not_finite` for NaN or Inf in state or motion, `not_unit_quaternion`, `out_of_range` where the air has no
/// answer (Surroundings), and what Quadrotor::status() says; the commands are untouched unless the Status is ok.
template <class Scalar, class... Effects>
Status inverse_commands(const Quadrotor<Scalar, Effects...>& quadrotor, const State<Scalar>& state,
                        const Accelerations<Scalar>& motion, Scalar time_s, Commands<Scalar>& commands) noexcept {
  if (quadrotor.status() != Status::ok) return quadrotor.status();
  if (!(all_finite(state) && all_finite(motion.linear_m_s2) && all_finite(motion.angular_rad_s2) &&
        is_finite(time_s))) {
    return Status::not_finite;
  }
  if (!is_unit(state.attitude)) return Status::not_unit_quaternion;
  const Surroundings<Scalar> air = quadrotor.surroundings(state, time_s);
  const Wrench<Scalar> required = required_wrench(quadrotor.airframe(), state, motion, quadrotor.site().gravity_m_s2);
  Commands<Scalar> result{};
  const Status status = commands_for_wrench(quadrotor, state, air, required, result);
  if (status != Status::ok) return status;
  if (!all_finite(result)) return Status::output_not_finite;
  commands = result;
  return Status::ok;
}

}  // namespace pinnquad
