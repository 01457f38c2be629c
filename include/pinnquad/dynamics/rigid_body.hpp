// SPDX-License-Identifier: MIT
// Eq. (1): wrench <-> accelerations, both ways, for a diagonal inertia.
// Signs corrected as in docs/paper.md, deviation 2: gravity is (R_B^I)^T m g, thrust acts along -z.
#pragma once

#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/dynamics/state.hpp"

namespace pinnquad {

/// v_dot_B = -omega x v_B + R^T g + f / m;  omega_dot = J^-1 (J omega x omega + tau).  `wrench` without gravity.
template <class Scalar>
Accelerations<Scalar> accelerations(const Airframe<Scalar>& airframe, const State<Scalar>& state,
                                    const Wrench<Scalar>& wrench, Scalar gravity_m_s2) noexcept {
  const Vector3<Scalar> inertia = to_vector(airframe.inertia_kg_m2);
  const Vector3<Scalar>& rates = state.body_rates_rad_s;
  const Vector3<Scalar> momentum = inertia.cwiseProduct(rates);
  const Vector3<Scalar> gravity =
      world_to_body<Scalar>(state.attitude, Vector3<Scalar>(Scalar(0), Scalar(0), gravity_m_s2));
  Accelerations<Scalar> result;
  result.linear_m_s2 = wrench.force_N / airframe.mass_kg + gravity - cross<Scalar>(rates, body_velocity(state));
  result.angular_rad_s2 = (cross<Scalar>(momentum, rates) + wrench.torque_N_m).cwiseQuotient(inertia);
  return result;
}

/// The wrench (without gravity) that makes these accelerations: the exact inverse of accelerations().
template <class Scalar>
Wrench<Scalar> required_wrench(const Airframe<Scalar>& airframe, const State<Scalar>& state,
                               const Accelerations<Scalar>& motion, Scalar gravity_m_s2) noexcept {
  const Vector3<Scalar> inertia = to_vector(airframe.inertia_kg_m2);
  const Vector3<Scalar>& rates = state.body_rates_rad_s;
  const Vector3<Scalar> momentum = inertia.cwiseProduct(rates);
  const Vector3<Scalar> gravity =
      world_to_body<Scalar>(state.attitude, Vector3<Scalar>(Scalar(0), Scalar(0), gravity_m_s2));
  Wrench<Scalar> result;
  result.force_N = (motion.linear_m_s2 + cross<Scalar>(rates, body_velocity(state)) - gravity) * airframe.mass_kg;
  result.torque_N_m = inertia.cwiseProduct(motion.angular_rad_s2) - cross<Scalar>(momentum, rates);
  return result;
}

}  // namespace pinnquad
