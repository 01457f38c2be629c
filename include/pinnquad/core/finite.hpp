// SPDX-License-Identifier: MIT
// NaN and Inf are found on the bits: -ffast-math deletes `x == x` and std::isfinite, and keeps this. Float and double,
// constant time. A value is taken by reference: as an argument, a compiler could take it for finite.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/core/select.hpp"

namespace pinnquad {

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {
/// True where the compiler may assume that there is no NaN (-ffast-math): it may then lose one in `v < 0 ? 0 : v`.
inline constexpr bool finite_math_only = __FINITE_MATH_ONLY__ != 0;
}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

/// True unless the value is NaN or +-Inf (exponent bits all set).
PINNQUAD_ALWAYS_INLINE bool is_finite(const float& value) noexcept {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return (bits & 0x7f800000u) != 0x7f800000u;
}

/// True for a double that is neither infinite nor NaN.
PINNQUAD_ALWAYS_INLINE bool is_finite(const double& value) noexcept {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return (bits & 0x7ff0000000000000u) != 0x7ff0000000000000u;
}

/// The same at compile time: on the bits where the compiler lets a constant be read so, else by comparison, which
/// -ffast-math may spoil.
template <class Scalar>
constexpr bool is_finite_constant(Scalar value) noexcept {
  using Limits = std::numeric_limits<Scalar>;
#if defined(__clang__) || __GNUC__ >= 11
  using Bits = std::conditional_t<sizeof(Scalar) == 4, std::uint32_t, std::uint64_t>;
  constexpr Bits magnitude = static_cast<Bits>(~Bits(0)) >> 1;
  return (__builtin_bit_cast(Bits, value) & magnitude) <= __builtin_bit_cast(Bits, Limits::max());
#else
  return value >= Limits::lowest() && value <= Limits::max();
#endif
}

/// True if `count` values from `first` are all finite. No early return: the time does not depend on the data.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Mask<Scalar> all_finite(const Scalar* first, int count) noexcept {
  // in a bool, gcc takes one number after the other
  std::conditional_t<std::is_same_v<Mask<Scalar>, bool>, unsigned, Mask<Scalar>> finite(true);
  for (int i = 0; i < count; ++i) finite &= is_finite(first[i]);
  return Mask<Scalar>(finite);
}

/// The same for anything contiguous with data() and size(): std::array, Eigen matrices.
template <class Container>
PINNQUAD_ALWAYS_INLINE auto all_finite(const Container& values) noexcept {
  return all_finite(values.data(), static_cast<int>(values.size()));
}

}  // namespace pinnquad
