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

/// state + step * derivative, quaternion not normalised.
template <class Scalar>
State<Scalar> advanced(const State<Scalar>& state, const StateDerivative<Scalar>& d, Scalar step_s) noexcept {
  State<Scalar> result;
  result.position_m = state.position_m + d.velocity_m_s * step_s;
  result.velocity_m_s = state.velocity_m_s + d.acceleration_m_s2 * step_s;
  const Quaternion<Scalar>& q = state.attitude;
  result.attitude = {q.w + d.attitude_rate.w * step_s, q.x + d.attitude_rate.x * step_s,
                     q.y + d.attitude_rate.y * step_s, q.z + d.attitude_rate.z * step_s};
  result.body_rates_rad_s = state.body_rates_rad_s + d.angular_acceleration_rad_s2 * step_s;
  return result;
}

/// RK4's weights: (a + 2 b + 2 c + d) / 6, of scalars and vectors.
template <class Scalar, class Value>
Value simpson(const Value& a, const Value& b, const Value& c, const Value& d) noexcept {
  return Value((a + b + b + c + c + d) / Scalar(6));
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
  k.velocity_m_s = simpson<Scalar>(k1.velocity_m_s, k2.velocity_m_s, k3.velocity_m_s, k4.velocity_m_s);
  k.acceleration_m_s2 =
      simpson<Scalar>(k1.acceleration_m_s2, k2.acceleration_m_s2, k3.acceleration_m_s2, k4.acceleration_m_s2);
  const Quaternion<Scalar>&q1 = k1.attitude_rate, &q2 = k2.attitude_rate, &q3 = k3.attitude_rate,
        &q4 = k4.attitude_rate;
  k.attitude_rate = {simpson<Scalar>(q1.w, q2.w, q3.w, q4.w), simpson<Scalar>(q1.x, q2.x, q3.x, q4.x),
                     simpson<Scalar>(q1.y, q2.y, q3.y, q4.y), simpson<Scalar>(q1.z, q2.z, q3.z, q4.z)};
  k.angular_acceleration_rad_s2 = simpson<Scalar>(k1.angular_acceleration_rad_s2, k2.angular_acceleration_rad_s2,
                                                  k3.angular_acceleration_rad_s2, k4.angular_acceleration_rad_s2);
  State<Scalar> result = advanced(state, k, step_s);
  result.attitude = normalized(result.attitude);
  return result;
}

}  // namespace pinnquad::detail
