// SPDX-License-Identifier: MIT
// Functions of one scalar: the C library's, absolute value, positive part, sine of a phase in turns. Builtins stand
// where the standard library has float overloads: in unoptimised code those are functions, of which the linker keeps
// one copy for all instruction sets.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/select.hpp"

namespace pinnquad {

/// Half a turn in radians.
inline constexpr double pi = 3.14159265358979323846;

namespace detail {

/// a == b for scalars, false for NaN: firmware is compiled with -Wfloat-equal.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE constexpr Mask<Scalar> equal(const Scalar& a, const Scalar& b) noexcept {
  return a <= b && a >= b;
}

// One function: the builtin for float and double, the scalar type's own otherwise (autodiff).
#define PINNQUAD_SCALAR_FUNCTION(name, own)                                             \
  PINNQUAD_ALWAYS_INLINE float name(float v) noexcept { return __builtin_##own##f(v); } \
  PINNQUAD_ALWAYS_INLINE double name(double v) noexcept { return __builtin_##own(v); }  \
  template <class Scalar>                                                               \
  PINNQUAD_ALWAYS_INLINE Scalar name(const Scalar& v) noexcept {                        \
    using std::own;                                                                     \
    return own(v);                                                                      \
  }
PINNQUAD_SCALAR_FUNCTION(hyperbolic_tangent, tanh)
PINNQUAD_SCALAR_FUNCTION(sine, sin)
PINNQUAD_SCALAR_FUNCTION(cosine, cos)
PINNQUAD_SCALAR_FUNCTION(exponential, exp)
PINNQUAD_SCALAR_FUNCTION(exponential_minus_one, expm1)
PINNQUAD_SCALAR_FUNCTION(log_of_one_plus, log1p)
PINNQUAD_SCALAR_FUNCTION(complementary_error_function, erfc)  // 1 - erf(v), without cancellation where erf(v) is near 1
PINNQUAD_SCALAR_FUNCTION(square_root, sqrt)
#undef PINNQUAD_SCALAR_FUNCTION

PINNQUAD_ALWAYS_INLINE float absolute(float v) noexcept { return __builtin_fabsf(v); }
PINNQUAD_ALWAYS_INLINE double absolute(double v) noexcept { return __builtin_fabs(v); }
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar absolute(const Scalar& v) noexcept {
  return select(v < Scalar(0), Scalar(-v), v);
}

/// 1 / (1 + exp(-v)). exp(-v) may be infinite: the quotient is 0 then.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar logistic(const Scalar& v) noexcept {
  return Scalar(1) / (Scalar(1) + exponential(-v));
}

/// The bits of a float as an integer lie below this one for -0 to -infinity, and for no NaN: it is the least NaN with a
/// sign.
inline constexpr int above_negatives = -0x007fffff;
/// That bound for the bits of a double.
inline constexpr long long above_negatives_double = -0x000fffffffffffff;

/// v < 0 ? 0 : v. NaN goes through.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar positive_part(const Scalar& v) noexcept {
  return select(v < Scalar(0), Scalar(0), v);
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

/// Taylor coefficients of sin(2 pi r) / r in r^2; ten terms leave 3e-16 at a quarter turn.
constexpr std::array<double, 10> sine_series() noexcept {
  constexpr double two_pi = 6.283185307179586;
  std::array<double, 10> c{two_pi};
  for (std::size_t k = 1; k < c.size(); ++k) {
    c[k] = -c[k - 1] * two_pi * two_pi / double(2 * k * (2 * k + 1));
  }
  return c;
}

/// sin(2 pi r) for r from -1/4 to 1/4.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar sine_of_quarter(const Scalar& r) noexcept {
  constexpr std::array<double, 10> c = sine_series();
  const Scalar x = r * r, x2 = x * x, x4 = x2 * x2;
  const auto pair = [&](std::size_t k) noexcept { return Scalar(c[k]) + Scalar(c[k + 1]) * x; };
  return r * ((pair(0) + pair(2) * x2) + ((pair(4) + pair(6) * x2) + pair(8) * x4) * x4);
}
}  // namespace detail

/// sin(2 pi turns) inline and without libm: the same bits everywhere, and no call that would spill every register of a
/// simulation step. Within 4 units in the last place of 1; exactly 0 for whole turns; NaN for NaN and Inf.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar sine_of_turns(Scalar turns) noexcept {
  using std::floor;
  const Scalar half(0.5), quarter(0.25);
  Scalar r = turns - floor(turns + half);  // -1/2 .. 1/2, exact
  r = select(r > quarter, half - r, select(r < -quarter, -half - r, r));
  return detail::sine_of_quarter(r);
}

/// cos(2 pi turns), likewise; exactly 0 for quarter turns.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar cosine_of_turns(Scalar turns) noexcept {
  using detail::absolute;
  using std::floor;
  const Scalar r = turns - floor(turns + Scalar(0.5));
  return detail::sine_of_quarter(Scalar(Scalar(0.25) - absolute(r)));
}

}  // namespace pinnquad
