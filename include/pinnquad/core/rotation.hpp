// SPDX-License-Identifier: MIT
// Attitude: NED world, FRD body. A unit quaternion (w, x, y, z) rotates body to world; Euler angles are ZYX.
// Written here because Eigen/Geometry would double the compile time of flight code and orders its storage x, y, z, w.
#pragma once

#include <cmath>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/select.hpp"
#include "pinnquad/core/types.hpp"

namespace pinnquad {

/// For what people read and logs hold; the library computes in radians.
inline constexpr double degrees_per_radian = 57.295779513082320877;

/// Rotation body (FRD) -> world (NED): v_world = q v_body q*.
template <class Scalar>
struct Quaternion {
  Scalar w{1};
  Scalar x{0};
  Scalar y{0};
  Scalar z{0};
};

/// Roll phi, pitch theta, yaw psi in rad, ZYX order: R = Rz(psi) Ry(theta) Rx(phi).
template <class Scalar>
struct EulerAngles {
  Scalar roll_rad{0};
  Scalar pitch_rad{0};
  Scalar yaw_rad{0};
};

/// Sine and cosine of yaw; by algebra from the quaternion, without trigonometry.
template <class Scalar>
struct Heading {
  Scalar sine{0};
  Scalar cosine{1};
};

/// Hamilton product: first b, then a.
template <class Scalar>
constexpr Quaternion<Scalar> operator*(const Quaternion<Scalar>& a, const Quaternion<Scalar>& b) noexcept {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

/// The inverse rotation of a unit quaternion.
template <class Scalar>
constexpr Quaternion<Scalar> conjugate(const Quaternion<Scalar>& q) noexcept {
  return {q.w, -q.x, -q.y, -q.z};
}

/// |q|^2.
template <class Scalar>
constexpr Scalar squared_norm(const Quaternion<Scalar>& q) noexcept {
  return q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
}

/// |q|^2 may differ from 1 by this much; a larger error is a broken estimator, not rounding.
template <class Scalar>
inline constexpr Scalar unit_quaternion_tolerance = Scalar(1e-3);

/// False for NaN.
template <class Scalar>
constexpr Mask<Scalar> is_unit(const Quaternion<Scalar>& q) noexcept {
  const Scalar excess = squared_norm(q) - Scalar(1);
  return excess <= unit_quaternion_tolerance<Scalar> && -excess <= unit_quaternion_tolerance<Scalar>;
}

/// q / |q|.
template <class Scalar>
Quaternion<Scalar> normalized(const Quaternion<Scalar>& q) noexcept {
  using std::sqrt;
  const Scalar scale = Scalar(1) / sqrt(squared_norm(q));
  return {q.w * scale, q.x * scale, q.y * scale, q.z * scale};
}

/// Body vector in the world frame, unit quaternion: v + 2 w (n x v) + 2 n x (n x v). In scalars: Eigen would split a
/// vector of three into two and one, for which the next reader waits.
template <class Scalar>
Vector3<Scalar> body_to_world(const Quaternion<Scalar>& q, const Vector3<Scalar>& v) noexcept {
  const Scalar two(2);
  const Scalar x = (q.y * v[2] - q.z * v[1]) * two, y = (q.z * v[0] - q.x * v[2]) * two;
  const Scalar z = (q.x * v[1] - q.y * v[0]) * two;
  return Vector3<Scalar>(v[0] + x * q.w + (q.y * z - q.z * y), v[1] + y * q.w + (q.z * x - q.x * z),
                         v[2] + z * q.w + (q.x * y - q.y * x));
}

/// World vector in the body frame, unit quaternion.
template <class Scalar>
Vector3<Scalar> world_to_body(const Quaternion<Scalar>& q, const Vector3<Scalar>& v) noexcept {
  return body_to_world(conjugate(q), v);
}

/// The body's z axis (down) in the world: third column of R. Thrust acts along its negative.
template <class Scalar>
Vector3<Scalar> body_down_axis(const Quaternion<Scalar>& q) noexcept {
  return Vector3<Scalar>(Scalar(2) * (q.x * q.z + q.w * q.y), Scalar(2) * (q.y * q.z - q.w * q.x),
                         Scalar(1) - Scalar(2) * (q.x * q.x + q.y * q.y));
}

/// The world's z axis (down) in the body: third row of R, how far down each body axis points.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Vector3<Scalar> world_down_axis(const Quaternion<Scalar>& q) noexcept {
  const Scalar x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
  return Vector3<Scalar>(q.x * z2 - q.w * y2, q.y * z2 + q.w * x2, Scalar(1) - (q.x * x2 + q.y * y2));
}

/// Quaternion of Euler angles ZYX, rad.
template <class Scalar>
Quaternion<Scalar> from_euler(const EulerAngles<Scalar>& angles) noexcept {
  using std::cos;
  using std::sin;
  const Scalar half(0.5);
  const Scalar cr = cos(angles.roll_rad * half), sr = sin(angles.roll_rad * half);
  const Scalar cp = cos(angles.pitch_rad * half), sp = sin(angles.pitch_rad * half);
  const Scalar cy = cos(angles.yaw_rad * half), sy = sin(angles.yaw_rad * half);
  return {cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
          cr * cp * sy - sr * sp * cy};
}

/// (sin psi, cos psi). Straight up or down (cos theta = 0) yaw has no meaning: (0, 1) is returned.
/// Like tilt() and to_euler() homogeneous in q: an error of the quaternion's norm does not turn the attitude.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Heading<Scalar> heading(const Quaternion<Scalar>& q) noexcept {
  using std::sqrt;
  const Scalar sine = Scalar(2) * (q.w * q.z + q.x * q.y);
  const Scalar cosine = q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z;
  const Scalar norm = sqrt(sine * sine + cosine * cosine);  // = |q|^2 cos theta
  if (norm <= Scalar(0)) return {};                         // NaN passes through
  return {sine / norm, cosine / norm};
}

/// Roll in [-pi, pi] and pitch in [-pi/2, pi/2] alone; yaw is left at 0.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE EulerAngles<Scalar> tilt(const Quaternion<Scalar>& q) noexcept {
  using std::atan2;
  using std::sqrt;
  const Scalar across = Scalar(2) * (q.w * q.x + q.y * q.z);             // |q|^2 sin phi cos theta
  const Scalar upright = q.w * q.w - q.x * q.x - q.y * q.y + q.z * q.z;  // |q|^2 cos phi cos theta
  const Scalar along = Scalar(2) * (q.w * q.y - q.z * q.x);              // |q|^2 sin theta
  return {atan2(across, upright), atan2(along, sqrt(across * across + upright * upright)), Scalar(0)};
}

/// Euler angles; yaw in [-pi, pi], see tilt() for the others.
template <class Scalar>
EulerAngles<Scalar> to_euler(const Quaternion<Scalar>& q) noexcept {
  using std::atan2;
  EulerAngles<Scalar> angles = tilt(q);
  angles.yaw_rad = atan2(Scalar(2) * (q.w * q.z + q.x * q.y), q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z);
  return angles;
}

/// dq/dt = q (0, omega) / 2, omega in body axes, rad/s.
template <class Scalar>
Quaternion<Scalar> attitude_rate(const Quaternion<Scalar>& q, const Vector3<Scalar>& body_rates_rad_s) noexcept {
  const Scalar half(0.5);
  const Scalar x = half * body_rates_rad_s[0], y = half * body_rates_rad_s[1], z = half * body_rates_rad_s[2];
  return {-(q.x * x) - q.y * y - q.z * z, q.w * x + q.y * z - q.z * y, q.w * y - q.x * z + q.z * x,
          q.w * z + q.x * y - q.y * x};
}

/// Attitude from a proper rotation matrix body -> world (Shepperd's choice of the largest divisor).
template <class Scalar>
Quaternion<Scalar> from_rotation_matrix(const Matrix<Scalar, 3, 3>& r) noexcept {
  using std::sqrt;
  const Scalar one(1), two(2), half(0.5);
  const Scalar trace = r(0, 0) + r(1, 1) + r(2, 2);
  if (trace > r(0, 0) && trace > r(1, 1) && trace > r(2, 2)) {
    const Scalar s = sqrt(one + trace) * two;
    return {s / Scalar(4), (r(2, 1) - r(1, 2)) / s, (r(0, 2) - r(2, 0)) / s, (r(1, 0) - r(0, 1)) / s};
  }
  const int i = r(0, 0) > r(1, 1) ? (r(0, 0) > r(2, 2) ? 0 : 2) : (r(1, 1) > r(2, 2) ? 1 : 2);
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  const Scalar s = sqrt(one + r(i, i) - r(j, j) - r(k, k)) * two;
  Scalar n[3] = {};
  n[i] = s * half * half;
  n[j] = (r(j, i) + r(i, j)) / s;
  n[k] = (r(k, i) + r(i, k)) / s;
  return {(r(k, j) - r(j, k)) / s, n[0], n[1], n[2]};
}

/// ENU world vector <-> NED world vector (its own inverse).
template <class Scalar>
Vector3<Scalar> swap_enu_ned(const Vector3<Scalar>& v) noexcept {
  return Vector3<Scalar>(v[1], v[0], -v[2]);
}

/// FLU body vector <-> FRD body vector (its own inverse).
template <class Scalar>
Vector3<Scalar> swap_flu_frd(const Vector3<Scalar>& v) noexcept {
  return Vector3<Scalar>(v[0], -v[1], -v[2]);
}

/// Attitude body -> ENU <-> attitude body -> NED (its own inverse up to the quaternion's sign).
template <class Scalar>
Quaternion<Scalar> swap_world_enu_ned(const Quaternion<Scalar>& q) noexcept {
  using std::sqrt;
  const Scalar h = sqrt(Scalar(0.5));
  return Quaternion<Scalar>{Scalar(0), h, h, Scalar(0)} * q;  // half turn about (1, 1, 0)
}

/// Attitude FLU -> world <-> attitude FRD -> world (its own inverse up to the quaternion's sign).
template <class Scalar>
Quaternion<Scalar> swap_body_flu_frd(const Quaternion<Scalar>& q) noexcept {
  return q * Quaternion<Scalar>{Scalar(0), Scalar(1), Scalar(0), Scalar(0)};  // half turn about x
}

/// Attitude FLU -> ENU <-> attitude FRD -> NED (its own inverse up to the quaternion's sign).
template <class Scalar>
Quaternion<Scalar> swap_enu_flu_ned_frd(const Quaternion<Scalar>& q) noexcept {
  return swap_body_flu_frd(swap_world_enu_ned(q));
}

}  // namespace pinnquad
