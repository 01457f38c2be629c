// SPDX-License-Identifier: MIT
// Eq. (1): wrench <-> accelerations, both ways.
// Signs corrected as in docs/paper.md, deviation 2: gravity is (R_B^I)^T m g, thrust acts along -z.
#pragma once

#include "pinnquad/dynamics/inertia.hpp"
#include "pinnquad/dynamics/state.hpp"

namespace pinnquad {

/// Euler's equation: omega_dot = J^-1 (J omega x omega + tau).
template <Build build = Build::any, class Scalar>
PINNQUAD_ALWAYS_INLINE Vector3<Scalar> angular_acceleration(const Airframe<Scalar>& airframe,
                                                            const Vector3<Scalar>& body_rates_rad_s,
                                                            const Vector3<Scalar>& torque_N_m) noexcept {
  const Vector3<Scalar>&w = body_rates_rad_s, &t = torque_N_m;
  if constexpr (build == Build::plain) {  // in scalars: Eigen would split a vector of three into two and one
    const auto& [jx, jy, jz] = airframe.inertia_kg_m2;
    const Scalar x = jx * w[0], y = jy * w[1], z = jz * w[2];
    return Vector3<Scalar>((y * w[2] - z * w[1] + t[0]) / jx, (z * w[0] - x * w[2] + t[1]) / jy,
                           (x * w[1] - y * w[0] + t[2]) / jz);
  } else {
    return inertia_solved<Scalar>(airframe, cross<Scalar>(inertia_times(airframe, w), w) + t);
  }
}

/// v_dot_B = -omega x v_B + R^T g + f / m;  omega_dot = J^-1 (J omega x omega + tau).  `wrench` without gravity.
template <class Scalar>
Accelerations<Scalar> accelerations(const Airframe<Scalar>& airframe, const State<Scalar>& state,
                                    const Wrench<Scalar>& wrench, Scalar gravity_m_s2) noexcept {
  const Vector3<Scalar>& rates = state.body_rates_rad_s;
  const Vector3<Scalar> gravity =
      world_to_body<Scalar>(state.attitude, Vector3<Scalar>(Scalar(0), Scalar(0), gravity_m_s2));
  Accelerations<Scalar> result;
  result.linear_m_s2 = wrench.force_N / airframe.mass_kg + gravity - cross<Scalar>(rates, body_velocity(state));
  result.angular_rad_s2 = angular_acceleration(airframe, rates, wrench.torque_N_m);
  return result;
}

/// The wrench (without gravity) that makes these accelerations: the exact inverse of accelerations().
template <class Scalar>
Wrench<Scalar> required_wrench(const Airframe<Scalar>& airframe, const State<Scalar>& state,
                               const Accelerations<Scalar>& motion, Scalar gravity_m_s2) noexcept {
  const Vector3<Scalar>& rates = state.body_rates_rad_s;
  const Vector3<Scalar> momentum = inertia_times(airframe, rates);
  const Vector3<Scalar> gravity =
      world_to_body<Scalar>(state.attitude, Vector3<Scalar>(Scalar(0), Scalar(0), gravity_m_s2));
  Wrench<Scalar> result;
  result.force_N = (motion.linear_m_s2 + cross<Scalar>(rates, body_velocity(state)) - gravity) * airframe.mass_kg;
  result.torque_N_m = inertia_times(airframe, motion.angular_rad_s2) - cross<Scalar>(momentum, rates);
  return result;
}

}  // namespace pinnquad
