// SPDX-License-Identifier: MIT
// Eq. (1): wrench <-> accelerations, both ways, with the full inertia tensor about the centre of gravity, FRD:
// J = ((Jx, Jxy, Jxz), (Jxy, Jy, Jyz), (Jxz, Jyz, Jz)).
// Signs corrected as in docs/paper.md, deviation 2: gravity is (R_B^I)^T m g, thrust acts along -z.
#pragma once

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/dynamics/state.hpp"

namespace pinnquad {

/// J w, FRD: angular momentum of body rates, N m s, or torque of an angular acceleration, N m.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Vector3<Scalar> inertia_times(const Airframe<Scalar>& airframe,
                                                     const Vector3<Scalar>& w) noexcept {
  Vector3<Scalar> result = to_vector(airframe.inertia_kg_m2).cwiseProduct(w);
  const Mask<Scalar> diagonal = has_diagonal_inertia(airframe);
  if (!all_of(diagonal)) {
    const auto& [xy, xz, yz] = airframe.inertia_products_kg_m2;
    result[0] = select(diagonal, result[0], Scalar(result[0] + (xy * w[1] + xz * w[2])));
    result[1] = select(diagonal, result[1], Scalar(result[1] + (xy * w[0] + yz * w[2])));
    result[2] = select(diagonal, result[2], Scalar(result[2] + (xz * w[0] + yz * w[1])));
  }
  return result;
}

namespace detail {
/// J^-1 t by the adjugate: exact up to rounding for a tensor that check_airframe() has passed.
template <class Scalar>
PINNQUAD_NOINLINE Vector3<Scalar> full_inertia_solved(const Airframe<Scalar>& airframe,
                                                      const Vector3<Scalar>& t) noexcept {
  const auto& [x, y, z] = airframe.inertia_kg_m2;
  const auto& [xy, xz, yz] = airframe.inertia_products_kg_m2;
  const Scalar a = y * z - yz * yz, b = xz * yz - xy * z, c = xy * yz - y * xz;
  const Scalar d = x * z - xz * xz, e = xy * xz - x * yz, f = x * y - xy * xy;
  const Scalar determinant = x * a + xy * b + xz * c;
  return Vector3<Scalar>(a * t[0] + b * t[1] + c * t[2], b * t[0] + d * t[1] + e * t[2],
                         c * t[0] + e * t[1] + f * t[2]) /
         determinant;
}
}  // namespace detail

/// J^-1 t, FRD: the angular acceleration of a torque, rad/s^2.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Vector3<Scalar> inertia_solved(const Airframe<Scalar>& airframe,
                                                      const Vector3<Scalar>& t) noexcept {
  const Mask<Scalar> diagonal = has_diagonal_inertia(airframe);
  const Vector3<Scalar> quotient = t.cwiseQuotient(to_vector(airframe.inertia_kg_m2));
  if (all_of(diagonal)) return quotient;
  return select(diagonal, quotient, detail::full_inertia_solved(airframe, t));
}

/// Euler's equation: omega_dot = J^-1 (J omega x omega + tau). `plain`: for a diagonal J (is_plain()).
template <bool plain = false, class Scalar>
PINNQUAD_ALWAYS_INLINE Vector3<Scalar> angular_acceleration(const Airframe<Scalar>& airframe,
                                                            const Vector3<Scalar>& body_rates_rad_s,
                                                            const Vector3<Scalar>& torque_N_m) noexcept {
  const Vector3<Scalar>&w = body_rates_rad_s, &t = torque_N_m;
  if constexpr (plain) {  // in scalars: Eigen would split a vector of three into two and one
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
