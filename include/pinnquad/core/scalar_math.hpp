// SPDX-License-Identifier: MIT
// Functions of one scalar: the C library's, absolute value, positive part. The standard library's float overloads are
// functions of their own in unoptimised code, compiled for the instruction set of whoever comes first; the compiler's builtins
// are not.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/finite.hpp"

namespace pinnquad {
namespace detail {

/// a == b, meant as it is written: firmware is compiled with -Wfloat-equal. False for NaN.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE constexpr bool equal(const Scalar& a, const Scalar& b) noexcept {
  return a <= b && a >= b;
}

PINNQUAD_ALWAYS_INLINE float hyperbolic_tangent(float v) noexcept { return __builtin_tanhf(v); }
PINNQUAD_ALWAYS_INLINE double hyperbolic_tangent(double v) noexcept { return __builtin_tanh(v); }
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar hyperbolic_tangent(const Scalar& v) noexcept {
  using std::tanh;
  return tanh(v);
}

PINNQUAD_ALWAYS_INLINE float sine(float v) noexcept { return __builtin_sinf(v); }
PINNQUAD_ALWAYS_INLINE double sine(double v) noexcept { return __builtin_sin(v); }
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar sine(const Scalar& v) noexcept {
  using std::sin;
  return sin(v);
}

PINNQUAD_ALWAYS_INLINE float cosine(float v) noexcept { return __builtin_cosf(v); }
PINNQUAD_ALWAYS_INLINE double cosine(double v) noexcept { return __builtin_cos(v); }
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar cosine(const Scalar& v) noexcept {
  using std::cos;
  return cos(v);
}

PINNQUAD_ALWAYS_INLINE float exponential(float v) noexcept { return __builtin_expf(v); }
PINNQUAD_ALWAYS_INLINE double exponential(double v) noexcept { return __builtin_exp(v); }
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar exponential(const Scalar& v) noexcept {
  using std::exp;
  return exp(v);
}

PINNQUAD_ALWAYS_INLINE float exponential_minus_one(float v) noexcept { return __builtin_expm1f(v); }
PINNQUAD_ALWAYS_INLINE double exponential_minus_one(double v) noexcept { return __builtin_expm1(v); }
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar exponential_minus_one(const Scalar& v) noexcept {
  using std::expm1;
  return expm1(v);
}

PINNQUAD_ALWAYS_INLINE float log_of_one_plus(float v) noexcept { return __builtin_log1pf(v); }
PINNQUAD_ALWAYS_INLINE double log_of_one_plus(double v) noexcept { return __builtin_log1p(v); }
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar log_of_one_plus(const Scalar& v) noexcept {
  using std::log1p;
  return log1p(v);
}

/// 1 - erf(v), without cancellation where erf(v) is near 1.
PINNQUAD_ALWAYS_INLINE float complementary_error_function(float v) noexcept { return __builtin_erfcf(v); }
PINNQUAD_ALWAYS_INLINE double complementary_error_function(double v) noexcept { return __builtin_erfc(v); }
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar complementary_error_function(const Scalar& v) noexcept {
  using std::erfc;
  return erfc(v);
}

PINNQUAD_ALWAYS_INLINE float square_root(float v) noexcept { return __builtin_sqrtf(v); }
PINNQUAD_ALWAYS_INLINE double square_root(double v) noexcept { return __builtin_sqrt(v); }
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar square_root(const Scalar& v) noexcept {
  using std::sqrt;
  return sqrt(v);
}

PINNQUAD_ALWAYS_INLINE float absolute(float v) noexcept { return __builtin_fabsf(v); }
PINNQUAD_ALWAYS_INLINE double absolute(double v) noexcept { return __builtin_fabs(v); }
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar absolute(const Scalar& v) noexcept {
  return v < Scalar(0) ? -v : v;
}

/// 1 / (1 + exp(-v)). exp(-v) may be infinite: the quotient is 0 then.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar logistic(const Scalar& v) noexcept {
  return Scalar(1) / (Scalar(1) + exponential(-v));
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
