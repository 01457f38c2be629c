// SPDX-License-Identifier: MIT
// One step of the rigid-body state by classical Runge-Kutta of fourth order.
// Positions and velocities are integrated in the world frame, the quaternion is normalised after the step: where it
// grew past what a scalar can square, to zero. Quadrotor::step checks what comes out.
#pragma once

#include "pinnquad/dynamics/state.hpp"

namespace pinnquad::detail {

/// d/dt of a State: world velocity and acceleration, quaternion rate, angular acceleration.
template <class Scalar>
struct StateDerivative {
  Vector3<Scalar> velocity_m_s;
  Vector3<Scalar> acceleration_m_s2;  ///< world, gravity included
  Quaternion<Scalar> attitude_rate;
  Vector3<Scalar> angular_acceleration_rad_s2;
};

/// v + step * rate, in scalars: Eigen would split a vector of three into two and one, for which the next reader waits.
template <class Scalar>
Vector3<Scalar> advanced(const Vector3<Scalar>& v, const Vector3<Scalar>& rate, Scalar step_s) noexcept {
  return Vector3<Scalar>(v[0] + rate[0] * step_s, v[1] + rate[1] * step_s, v[2] + rate[2] * step_s);
}
/// state + step * derivative, quaternion not normalised.
template <class Scalar>
State<Scalar> advanced(const State<Scalar>& state, const StateDerivative<Scalar>& d, Scalar step_s) noexcept {
  const Quaternion<Scalar>& q = state.attitude;
  return {advanced(state.position_m, d.velocity_m_s, step_s),
          advanced(state.velocity_m_s, d.acceleration_m_s2, step_s),
          {q.w + d.attitude_rate.w * step_s, q.x + d.attitude_rate.x * step_s, q.y + d.attitude_rate.y * step_s,
           q.z + d.attitude_rate.z * step_s},
          advanced(state.body_rates_rad_s, d.angular_acceleration_rad_s2, step_s)};
}

/// RK4's weights: (a + 2 b + 2 c + d) / 6.
template <class Scalar>
Scalar simpson(const Scalar& a, const Scalar& b, const Scalar& c, const Scalar& d) noexcept {
  return (a + b + b + c + c + d) / Scalar(6);
}
template <class Scalar>
Vector3<Scalar> simpson(const Vector3<Scalar>& a, const Vector3<Scalar>& b, const Vector3<Scalar>& c,
                        const Vector3<Scalar>& d) noexcept {
  return Vector3<Scalar>(simpson(a[0], b[0], c[0], d[0]), simpson(a[1], b[1], c[1], d[1]),
                         simpson(a[2], b[2], c[2], d[2]));
}

/// Classical RK4. `rate(state, offset_s)` returns the StateDerivative at a time `offset_s` after the step's start: it
/// is called at the start, twice in the middle, and at the end.
template <class Scalar, class Rate>
State<Scalar> rk4_step(const State<Scalar>& state, Scalar step_s, const Rate& rate) noexcept {
  const Scalar half = step_s / Scalar(2);
  const StateDerivative<Scalar> k1 = rate(state, Scalar(0));
  const StateDerivative<Scalar> k2 = rate(advanced(state, k1, half), half);
  const StateDerivative<Scalar> k3 = rate(advanced(state, k2, half), half);
  const StateDerivative<Scalar> k4 = rate(advanced(state, k3, step_s), step_s);
  StateDerivative<Scalar> k;
  k.velocity_m_s = simpson(k1.velocity_m_s, k2.velocity_m_s, k3.velocity_m_s, k4.velocity_m_s);
  k.acceleration_m_s2 = simpson(k1.acceleration_m_s2, k2.acceleration_m_s2, k3.acceleration_m_s2, k4.acceleration_m_s2);
  const Quaternion<Scalar>&q1 = k1.attitude_rate, &q2 = k2.attitude_rate, &q3 = k3.attitude_rate,
        &q4 = k4.attitude_rate;
  k.attitude_rate = {simpson(q1.w, q2.w, q3.w, q4.w), simpson(q1.x, q2.x, q3.x, q4.x), simpson(q1.y, q2.y, q3.y, q4.y),
                     simpson(q1.z, q2.z, q3.z, q4.z)};
  k.angular_acceleration_rad_s2 = simpson(k1.angular_acceleration_rad_s2, k2.angular_acceleration_rad_s2,
                                          k3.angular_acceleration_rad_s2, k4.angular_acceleration_rad_s2);
  State<Scalar> result = advanced(state, k, step_s);
  result.attitude = normalized(result.attitude);
  return result;
}

}  // namespace pinnquad::detail
