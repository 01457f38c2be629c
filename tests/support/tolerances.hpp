// SPDX-License-Identifier: MIT
// Tolerances of the physics tests: each has a name and a reason.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace pinnquad::test {

/// Rounding of a chain of `operations` operations on values of order 1: each adds at most half an ulp, and the bound is
/// linear.
template <class Scalar>
constexpr double rounding(double operations) noexcept {
  return operations * static_cast<double>(std::numeric_limits<Scalar>::epsilon());
}

/// One evaluation of the dynamics: about a hundred operations, the last of them a division by a small inertia.
template <class Scalar>
inline constexpr double evaluation_tolerance = rounding<Scalar>(200);

/// A rotation of a unit vector or a composition of two rotations: some twenty operations.
template <class Scalar>
inline constexpr double rotation_tolerance = rounding<Scalar>(20);

/// The inverse after the forward model: the allocation's inverse adds its condition number (thrust against yaw torque).
template <class Scalar>
inline constexpr double inverse_tolerance = rounding<Scalar>(2000);

/// Two formulas in double for the same row, |difference| / |value| of a vector; both sum terms that partly cancel.
inline constexpr double second_formula_tolerance = 1e-12;

/// Euclidean norm in double of anything with size() and operator[].
template <class Vector>
double norm(const Vector& v) {
  double sum = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(v.size()); ++i) {
    const auto index = static_cast<decltype(v.size())>(i);
    sum += static_cast<double>(v[index]) * static_cast<double>(v[index]);
  }
  return std::sqrt(sum);
}

/// |a - b|, Euclidean, in double; a and b may be of different types.
template <class VectorA, class VectorB>
double distance(const VectorA& a, const VectorB& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.size()); ++i) {
    const double difference = static_cast<double>(a[static_cast<decltype(a.size())>(i)]) -
                              static_cast<double>(b[static_cast<decltype(b.size())>(i)]);
    sum += difference * difference;
  }
  return std::sqrt(sum);
}

/// |a - b| / max(|b|, floor). NaN if either is NaN, so that `<=` fails.
template <class VectorA, class VectorB>
double relative_distance(const VectorA& a, const VectorB& b, double floor = 0.0) {
  const double difference = distance(a, b);
  const double scale = std::max(norm(b), floor);
  return difference == 0.0 ? 0.0 : difference / scale;
}

}  // namespace pinnquad::test
