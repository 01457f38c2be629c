// SPDX-License-Identifier: MIT
// The axes of a vehicle: a rotation as the nine numbers that turn a vector.
#pragma once

#include "pinnquad/core/rotation.hpp"
#include "pinnquad/core/types.hpp"

namespace pinnquad::detail {

/// The rotation worked out once for the two vectors that an evaluation turns: less than half the work of turning each
/// by the quaternion, and written in scalars because Eigen would split a vector of three into two and one.
template <class Scalar>
struct Axes {
  Scalar xx, xy, xz, yx, yy, yz, zx, zy, zz;  ///< R, row (world) by row

  explicit Axes(const Quaternion<Scalar>& q) noexcept {
    const Scalar one(1), x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
    const Scalar w_x = q.w * x2, w_y = q.w * y2, w_z = q.w * z2;
    const Scalar x_x = q.x * x2, x_y = q.x * y2, x_z = q.x * z2, y_y = q.y * y2, y_z = q.y * z2, z_z = q.z * z2;
    xx = one - (y_y + z_z), xy = x_y - w_z, xz = x_z + w_y;
    yx = x_y + w_z, yy = one - (x_x + z_z), yz = y_z - w_x;
    zx = x_z - w_y, zy = y_z + w_x, zz = one - (x_x + y_y);
  }
  Vector3<Scalar> to_world(Scalar x, Scalar y, Scalar z) const noexcept {
    return Vector3<Scalar>(xx * x + xy * y + xz * z, yx * x + yy * y + yz * z, zx * x + zy * y + zz * z);
  }
  /// Turns a vector along the body's z axis.
  Vector3<Scalar> to_world(Scalar z) const noexcept { return Vector3<Scalar>(xz * z, yz * z, zz * z); }
  Vector3<Scalar> to_body(Scalar x, Scalar y, Scalar z) const noexcept {
    return Vector3<Scalar>(xx * x + yx * y + zx * z, xy * x + yy * y + zy * z, xz * x + yz * y + zz * z);
  }
};

}  // namespace pinnquad::detail
