// SPDX-License-Identifier: MIT
// tanh and sqrt of one scalar. The standard library's float overloads are functions of their own in unoptimised code, compiled
// for the instruction set of whoever comes first; the compiler's builtins are not.
#pragma once

#include <cmath>

#include "pinnquad/core/attributes.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_ALWAYS_INLINE float hyperbolic_tangent(float v) noexcept { return __builtin_tanhf(v); }
PINNQUAD_ALWAYS_INLINE double hyperbolic_tangent(double v) noexcept { return __builtin_tanh(v); }
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar hyperbolic_tangent(const Scalar& v) noexcept {
  using std::tanh;
  return tanh(v);
}

PINNQUAD_ALWAYS_INLINE float square_root(float v) noexcept { return __builtin_sqrtf(v); }
PINNQUAD_ALWAYS_INLINE double square_root(double v) noexcept { return __builtin_sqrt(v); }
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar square_root(const Scalar& v) noexcept {
  using std::sqrt;
  return sqrt(v);
}

}  // namespace detail
}  // namespace pinnquad
