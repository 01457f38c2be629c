// SPDX-License-Identifier: MIT
// Place and motion of the vehicle; force and torque on it.
// World NED, body FRD, SI units.
#pragma once

#include <type_traits>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/rotation.hpp"
#include "pinnquad/core/types.hpp"

namespace pinnquad {

/// Rigid-body state.
template <class Scalar>
struct State {
  Vector3<Scalar> position_m = Vector3<Scalar>::Zero();        ///< NED
  Vector3<Scalar> velocity_m_s = Vector3<Scalar>::Zero();      ///< NED
  Quaternion<Scalar> attitude{};                               ///< body -> world
  Vector3<Scalar> body_rates_rad_s = Vector3<Scalar>::Zero();  ///< (p, q, r), FRD
};

/// The left-hand sides of Eq. (1), body frame.
template <class Scalar>
struct Accelerations {
  /// d/dt of the body-frame velocity: R^T a_world - omega x v_B. Not what an accelerometer or a world derivative shows
  /// (docs/paper.md, deviation 3).
  Vector3<Scalar> linear_m_s2 = Vector3<Scalar>::Zero();
  Vector3<Scalar> angular_rad_s2 = Vector3<Scalar>::Zero();  ///< (p, q, r) derivatives
};

/// Force and torque about the centre of gravity, body frame, without gravity.
template <class Scalar>
struct Wrench {
  Vector3<Scalar> force_N = Vector3<Scalar>::Zero();
  Vector3<Scalar> torque_N_m = Vector3<Scalar>::Zero();
};

/// Force and torque, each by itself.
template <class Scalar>
Wrench<Scalar> operator+(const Wrench<Scalar>& a, const Wrench<Scalar>& b) noexcept {
  const Vector3<Scalar>&f = a.force_N, &g = b.force_N, &t = a.torque_N_m, &u = b.torque_N_m;
  return {Vector3<Scalar>(f[0] + g[0], f[1] + g[1], f[2] + g[2]),
          Vector3<Scalar>(t[0] + u[0], t[1] + u[1], t[2] + u[2])};
}

/// Force and torque, each by itself.
template <class Scalar>
Wrench<Scalar> operator-(const Wrench<Scalar>& a, const Wrench<Scalar>& b) noexcept {
  return {a.force_N - b.force_N, a.torque_N_m - b.torque_N_m};
}

/// Takes each lane from `yes` or `no`, as its truth says.
template <class Scalar, class = std::enable_if_t<!std::is_same_v<Mask<Scalar>, bool>>>
PINNQUAD_ALWAYS_INLINE Wrench<Scalar> select(const Mask<Scalar>& mask, const Wrench<Scalar>& yes,
                                             const Wrench<Scalar>& no) noexcept {
  return {select(mask, yes.force_N, no.force_N), select(mask, yes.torque_N_m, no.torque_N_m)};
}

/// Velocity in the body frame, m/s.
template <class Scalar>
Vector3<Scalar> body_velocity(const State<Scalar>& state) noexcept {
  return world_to_body(state.attitude, state.velocity_m_s);
}

/// a_world (NED, m/s^2, gravity included) from v_dot_B: R (v_dot_B + omega x v_B).
template <class Scalar>
Vector3<Scalar> world_acceleration(const State<Scalar>& state, const Vector3<Scalar>& body_derivative_m_s2) noexcept {
  const Vector3<Scalar> transport = cross<Scalar>(state.body_rates_rad_s, body_velocity(state));
  return body_to_world<Scalar>(state.attitude, body_derivative_m_s2 + transport);
}

/// v_dot_B (FRD, m/s^2) from a_world: R^T a_world - omega x v_B.
template <class Scalar>
Vector3<Scalar> body_derivative(const State<Scalar>& state, const Vector3<Scalar>& world_acceleration_m_s2) noexcept {
  return world_to_body(state.attitude, world_acceleration_m_s2) -
         cross<Scalar>(state.body_rates_rad_s, body_velocity(state));
}

/// Takes each lane from `yes` or `no`, as its truth says.
template <class Scalar, class = std::enable_if_t<!std::is_same_v<Mask<Scalar>, bool>>>
PINNQUAD_ALWAYS_INLINE State<Scalar> select(const Mask<Scalar>& mask, const State<Scalar>& yes,
                                            const State<Scalar>& no) noexcept {
  const Quaternion<Scalar>&a = yes.attitude, &b = no.attitude;
  State<Scalar> result;
  result.position_m = select(mask, yes.position_m, no.position_m);
  result.velocity_m_s = select(mask, yes.velocity_m_s, no.velocity_m_s);
  result.attitude = {select(mask, a.w, b.w), select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
  result.body_rates_rad_s = select(mask, yes.body_rates_rad_s, no.body_rates_rad_s);
  return result;
}

/// True where no number of the state is NaN or infinite.
template <class Scalar>
Mask<Scalar> all_finite(const State<Scalar>& state) noexcept {
  const Quaternion<Scalar>& q = state.attitude;
  const Scalar attitude[4] = {q.w, q.x, q.y, q.z};
  return all_finite(state.position_m) && all_finite(state.velocity_m_s) && all_finite(attitude, 4) &&
         all_finite(state.body_rates_rad_s);
}

}  // namespace pinnquad
