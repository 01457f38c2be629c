// SPDX-License-Identifier: MIT
// tanh, sqrt and positive part of one scalar. The standard library's float overloads are functions of their own in
// unoptimised code, compiled for the instruction set of whoever comes first; the compiler's builtins are not.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/finite.hpp"

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

/// As integers, floats from -0 to -infinity lie below this one, a NaN with a sign, and all other NaNs do not.
inline constexpr int above_negatives = -0x007fffff;

/// v < 0 ? 0 : v. NaN goes through.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar positive_part(const Scalar& v) noexcept {
  return v < Scalar(0) ? Scalar(0) : v;
}
PINNQUAD_ALWAYS_INLINE float positive_part(float v) noexcept {
  if constexpr (finite_math_only) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &v, sizeof bits);
    return bits - 0x80000001u <= 0xff800000u - 0x80000001u ? 0.0f : v;  // from the smallest below zero to -infinity
  } else {
    return v < 0.0f ? 0.0f : v;
  }
}
PINNQUAD_ALWAYS_INLINE double positive_part(double v) noexcept {
  if constexpr (finite_math_only) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &v, sizeof bits);
    return bits - 0x8000000000000001u <= 0xfff0000000000000u - 0x8000000000000001u ? 0.0 : v;
  } else {
    return v < 0.0 ? 0.0 : v;
  }
}

}  // namespace detail
}  // namespace pinnquad
