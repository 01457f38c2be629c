// SPDX-License-Identifier: MIT
// Matrix and vector aliases: the vocabulary of every interface.
// The only file that includes Eigen, but for the decompositions of regression/impl/ridge.hpp. Its vectors and matrices
// are not over-aligned, and what is made of them may be copied into any buffer; the weights for a vector unit are
// (PackedNetwork: 64 bytes).
// Without exceptions, as firmware is built, Eigen's asserts are off: they print and abort, and flight code has neither.
// To have them, define eigen_assert or include Eigen first.
#pragma once

#if !defined(__cpp_exceptions) && !defined(EIGEN_NO_DEBUG) && !defined(eigen_assert)
#define EIGEN_NO_DEBUG
#endif

#include <Eigen/Core>

#include <array>

namespace pinnquad {

/// Number of rotors. With four, one set of commands makes a thrust and three torques. With more many do, and an inverse
/// learnt from flights would mix them: another number is another problem, not a template parameter.
inline constexpr int rotor_count = 4;
static_assert(
    rotor_count == 4,
    "pinnquad: allocation and its inverse, desaturation, the motor diagonal of the ground effect, motor orders, model "
    "blocks and the names u1 .. u4 are of four rotors (core/types.hpp)");

/// Fixed-size matrix without alignment demands (row vectors must be row-major in Eigen).
template <class Scalar, int Rows, int Columns = 1>
using Matrix =
    Eigen::Matrix<Scalar, Rows, Columns,
                  (Rows == 1 && Columns != 1 ? int(Eigen::RowMajor) : int(Eigen::ColMajor)) | int(Eigen::DontAlign)>;

template <class Scalar>
using Vector3 = Matrix<Scalar, 3>;

/// Motor commands u_1..u_4, dimensionless, 0..1; thrust is proportional to u (docs/paper.md, deviation 6: u = (n /
/// n_max)^2) unless the airframe's rotors have a curve (dynamics/actuator.hpp).
template <class Scalar>
using Commands = std::array<Scalar, rotor_count>;

/// a x b. Eigen's own lives in Eigen/Geometry, which would double the compile time of every flight translation unit.
template <class Scalar>
constexpr Vector3<Scalar> cross(const Vector3<Scalar>& a, const Vector3<Scalar>& b) noexcept {
  return Vector3<Scalar>(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}

/// a . b, in this order of sums; Eigen's depends on the scalar.
template <class Scalar>
constexpr Scalar dot(const Vector3<Scalar>& a, const Vector3<Scalar>& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Vector from the three literals of an airframe.
template <class Scalar>
Vector3<Scalar> to_vector(const std::array<Scalar, 3>& values) noexcept {
  return Vector3<Scalar>(values[0], values[1], values[2]);
}

}  // namespace pinnquad
