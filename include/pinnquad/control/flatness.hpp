// SPDX-License-Identifier: MIT
// Differential flatness: from a trajectory's derivatives to the attitude, body rates, angular accelerations and thrust
// that fly it, without drag.
// Source: the flat outputs of Mellinger and Kumar (2011), derived here for NED, FRD and Euler ZYX yaw.
#pragma once

#include <cmath>

#include "pinnquad/control/trajectory.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/rotation.hpp"
#include "pinnquad/core/status.hpp"

namespace pinnquad {

/// The motion of the body along a trajectory.
template <class Scalar>
struct FlatMotion {
  Quaternion<Scalar> attitude{};                                          ///< body -> world
  Vector3<Scalar> body_rates_rad_s = Vector3<Scalar>::Zero();             ///< FRD
  Vector3<Scalar> angular_acceleration_rad_s2 = Vector3<Scalar>::Zero();  ///< FRD
  Scalar specific_thrust_m_s2 = Scalar(0);                                ///< thrust / mass, along body -z
};

namespace detail {
/// Specific thrust and cosine of roll below which the attitude has no meaning: free fall, thrust along the horizon.
template <class Scalar>
inline constexpr Scalar flatness_limit = Scalar(1e-3);
}  // namespace detail

/// Body axes in the world for a specific force f = a - g (NED) and a heading: z = -f / |f|, x in the vertical plane of
/// the heading, so that the Euler ZYX yaw of the result is the heading's. Columns of R: x, y, z.
/// `not_finite`; `no_solution` in free fall, or with the thrust along the horizon across the heading.
template <class Scalar>
Status body_axes(const Vector3<Scalar>& specific_force_m_s2, const Heading<Scalar>& yaw,
                 Matrix<Scalar, 3, 3>& axes) noexcept {
  if (!(all_finite(specific_force_m_s2) && is_finite(yaw.sine) && is_finite(yaw.cosine))) return Status::not_finite;
  const Scalar thrust = specific_force_m_s2.norm();
  if (!(thrust > detail::flatness_limit<Scalar>)) return Status::no_solution;
  const Vector3<Scalar> z = specific_force_m_s2 * (Scalar(-1) / thrust);
  const Vector3<Scalar> right(-yaw.sine, yaw.cosine, Scalar(0));
  const Vector3<Scalar> forward = cross<Scalar>(right, z);
  const Scalar cosine_roll = forward.norm();
  if (!(cosine_roll > detail::flatness_limit<Scalar>)) return Status::no_solution;
  const Vector3<Scalar> x = forward * (Scalar(1) / cosine_roll);
  axes.col(0) = x;
  axes.col(1) = cross<Scalar>(z, x);
  axes.col(2) = z;
  return Status::ok;
}

/// Attitude, body rates, angular accelerations and specific thrust of a trajectory point.
///   f = a - g = -c z,  z' = -(j + c' z) / c,  c' = -z.j,  z'' = -(s + c'' z + 2 c' z') / c,  c'' = -z'.j - z.s
///   (q, -p, 0) = R^T z',  (q' + p r, -p' + q r, .) = R^T z'';  r, r' from x.right = 0 and its derivatives
/// `not_finite`, `no_solution` as body_axes(); `motion` is untouched unless the Status is ok.
template <class Scalar>
Status flat_motion(const TrajectoryPoint<Scalar>& point, Scalar gravity_m_s2, FlatMotion<Scalar>& motion) noexcept {
  using std::cos;
  using std::sin;
  const bool finite = all_finite(point.acceleration_m_s2) && all_finite(point.jerk_m_s3) &&
                      all_finite(point.snap_m_s4) && is_finite(point.yaw_rad) && is_finite(point.yaw_rate_rad_s) &&
                      is_finite(point.yaw_acceleration_rad_s2);
  if (!finite) return Status::not_finite;
  const Vector3<Scalar> force = point.acceleration_m_s2 - Vector3<Scalar>(Scalar(0), Scalar(0), gravity_m_s2);
  const Heading<Scalar> yaw{sin(point.yaw_rad), cos(point.yaw_rad)};
  Matrix<Scalar, 3, 3> axes;
  const Status status = body_axes(force, yaw, axes);
  if (status != Status::ok) return status;
  const Vector3<Scalar> x = axes.col(0), y = axes.col(1), z = axes.col(2);

  const Scalar thrust = force.norm();
  const Scalar thrust_rate = -z.dot(point.jerk_m_s3);
  const Vector3<Scalar> z_rate = (point.jerk_m_s3 + z * thrust_rate) * (Scalar(-1) / thrust);
  const Scalar thrust_second = -z_rate.dot(point.jerk_m_s3) - z.dot(point.snap_m_s4);
  const Vector3<Scalar> z_second =
      (point.snap_m_s4 + z * thrust_second + z_rate * (Scalar(2) * thrust_rate)) * (Scalar(-1) / thrust);

  const Vector3<Scalar> ahead(yaw.cosine, yaw.sine, Scalar(0)), right(-yaw.sine, yaw.cosine, Scalar(0));
  const Scalar yr = y.dot(right), zr = z.dot(right), xa = x.dot(ahead), ya = y.dot(ahead), za = z.dot(ahead);
  const Scalar yaw_rate = point.yaw_rate_rad_s;
  const Scalar p = -y.dot(z_rate);
  const Scalar q = x.dot(z_rate);
  const Scalar r = (q * zr + yaw_rate * xa) / yr;
  const Scalar p_rate = -y.dot(z_second) + q * r;
  const Scalar q_rate = x.dot(z_second) - p * r;
  const Scalar yr_rate = p * zr - yaw_rate * ya;
  const Scalar zr_rate = -p * yr - yaw_rate * za;
  const Scalar xa_rate = r * ya - q * za;
  const Scalar r_rate =
      (q_rate * zr + q * zr_rate + point.yaw_acceleration_rad_s2 * xa + yaw_rate * xa_rate - r * yr_rate) / yr;

  motion.attitude = from_rotation_matrix(axes);
  motion.body_rates_rad_s = Vector3<Scalar>(p, q, r);
  motion.angular_acceleration_rad_s2 = Vector3<Scalar>(p_rate, q_rate, r_rate);
  motion.specific_thrust_m_s2 = thrust;
  return Status::ok;
}

}  // namespace pinnquad
