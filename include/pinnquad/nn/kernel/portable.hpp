// SPDX-License-Identifier: MIT
// Matrix-vector product straight from row-major weights, one fixed order of operations: row by row, inputs ascending.
// Where the target multiplies and adds in one rounding, so does this: the same bits on all such targets, at any
// optimisation level.
#pragma once

#include <cmath>

#include "pinnquad/core/attributes.hpp"

namespace pinnquad {

/// a * b + c, in one rounding where the hardware has it, in two where it would take a library call.
PINNQUAD_ALWAYS_INLINE float multiply_add(float a, float b, float c) noexcept {
#if defined(__FP_FAST_FMAF) || defined(__FMA__) || defined(__ARM_FEATURE_FMA)
  return __builtin_fmaf(a, b, c);
#else
  const float product = a * b;
  return product + c;
#endif
}

PINNQUAD_ALWAYS_INLINE double multiply_add(double a, double b, double c) noexcept {
#if defined(__FP_FAST_FMA) || defined(__FMA__) || (defined(__ARM_FEATURE_FMA) && defined(__aarch64__))
  return __builtin_fma(a, b, c);
#else
  const double product = a * b;
  return product + c;
#endif
}

namespace detail {
/// sum + row . x, inputs ascending.
template <int Columns, class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar add_dot(Scalar sum, const Scalar* row, const Scalar* x) noexcept {
  for (int column = 0; column < Columns; ++column) sum = multiply_add(row[column], x[column], sum);
  return sum;
}
}  // namespace detail

/// y = W x + b; W is Rows x Columns, row-major (row = output, column = input).
template <int Rows, int Columns, class Scalar>
PINNQUAD_ALWAYS_INLINE void multiply_row_major(const Scalar* weight, const Scalar* bias, const Scalar* x,
                                               Scalar* y) noexcept {
  for (int row = 0; row < Rows; ++row) y[row] = detail::add_dot<Columns>(bias[row], weight + row * Columns, x);
}

/// y = W x.
template <int Rows, int Columns, class Scalar>
PINNQUAD_ALWAYS_INLINE void multiply_row_major(const Scalar* weight, const Scalar* x, Scalar* y) noexcept {
  for (int row = 0; row < Rows; ++row) y[row] = detail::add_dot<Columns>(Scalar(0), weight + row * Columns, x);
}

}  // namespace pinnquad
