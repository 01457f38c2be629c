// SPDX-License-Identifier: MIT
#include "pinnquad/core/types.hpp"

#include <doctest/doctest.h>

#include <type_traits>

#include "support/random_states.hpp"
#include "support/tolerances.hpp"

namespace {
/// Matrices have no alignment demands and no padding.
template <class Scalar>
constexpr bool lie_dense() {
  return alignof(pinnquad::Matrix<Scalar, 4>) == alignof(Scalar) &&
         alignof(pinnquad::Matrix<Scalar, 4, 4>) == alignof(Scalar) &&
         sizeof(pinnquad::Vector3<Scalar>) == 3 * sizeof(Scalar) &&
         sizeof(pinnquad::State<Scalar>) == 13 * sizeof(Scalar) && pinnquad::Matrix<Scalar, 1, 4>::IsRowMajor &&
         !pinnquad::Matrix<Scalar, 4, 4>::IsRowMajor;
}
static_assert(lie_dense<float>() && lie_dense<double>());
}  // namespace

TEST_CASE_TEMPLATE("cross: basis vectors, at a right angle to both, Lagrange's identity", Scalar, float, double) {
  using V = pinnquad::Vector3<Scalar>;
  const V x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  CHECK(pinnquad::cross<Scalar>(x, y) == z);
  CHECK(pinnquad::cross<Scalar>(y, z) == x);
  CHECK(pinnquad::cross<Scalar>(z, x) == y);
  const double tolerance = pinnquad::test::rounding<Scalar>(8);
  pinnquad::test::RandomStates random(6);
  for (int draw = 0; draw < pinnquad::test::draws; ++draw) {
    const V a = random.vector<Scalar>(1.0), b = random.vector<Scalar>(1.0);
    const V c = pinnquad::cross<Scalar>(a, b);
    CHECK(pinnquad::cross<Scalar>(b, a) == -c);
    CHECK(static_cast<double>(std::abs(a.dot(c))) <= tolerance);
    CHECK(static_cast<double>(std::abs(b.dot(c))) <= tolerance);
    const Scalar identity = a.squaredNorm() * b.squaredNorm() - a.dot(b) * a.dot(b);
    CHECK(static_cast<double>(std::abs(c.squaredNorm() - identity)) <= 2 * tolerance);
  }
}
