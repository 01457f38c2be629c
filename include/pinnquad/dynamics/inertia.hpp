// SPDX-License-Identifier: MIT
// The inertia tensor of an airframe: angular momentum, its inverse, and whether a body can have it.
// J = ((Jx, Jxy, Jxz), (Jxy, Jy, Jyz), (Jxz, Jyz, Jz)), FRD, about the centre of gravity.
#pragma once

#include <limits>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/dynamics/airframe.hpp"

namespace pinnquad {

/// J w: angular momentum of body rates, torque of an angular acceleration.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Vector3<Scalar> inertia_times(const Airframe<Scalar>& airframe,
                                                     const Vector3<Scalar>& w) noexcept {
  Vector3<Scalar> result = to_vector(airframe.inertia_kg_m2).cwiseProduct(w);
  if (!has_diagonal_inertia(airframe)) {
    const auto& [xy, xz, yz] = airframe.inertia_products_kg_m2;
    result[0] += xy * w[1] + xz * w[2];
    result[1] += xy * w[0] + yz * w[2];
    result[2] += xz * w[0] + yz * w[1];
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

/// J^-1 t: the angular acceleration of a torque.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Vector3<Scalar> inertia_solved(const Airframe<Scalar>& airframe,
                                                      const Vector3<Scalar>& t) noexcept {
  if (has_diagonal_inertia(airframe)) {
    return t.cwiseQuotient(to_vector(airframe.inertia_kg_m2));
  }
  return detail::full_inertia_solved(airframe, t);
}

}  // namespace pinnquad
