// SPDX-License-Identifier: MIT
// NaN and Inf test on the bits: `x == x` and std::isfinite are deleted by -ffast-math, this is not.
// Works for float and double; constant time.
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "pinnquad/core/attributes.hpp"

namespace pinnquad {

/// True unless the value is NaN or +-Inf (exponent bits all set).
PINNQUAD_ALWAYS_INLINE bool is_finite(float value) noexcept {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return (bits & 0x7f800000u) != 0x7f800000u;
}

PINNQUAD_ALWAYS_INLINE bool is_finite(double value) noexcept {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return (bits & 0x7ff0000000000000u) != 0x7ff0000000000000u;
}

/// True if `count` values from `first` are all finite. No early return: the time does not depend on the data.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE bool all_finite(const Scalar* first, int count) noexcept {
  bool finite = true;
  for (int i = 0; i < count; ++i) finite &= is_finite(first[i]);
  return finite;
}

/// The same for anything contiguous with data() and size(): std::array, Eigen matrices.
template <class Container>
PINNQUAD_ALWAYS_INLINE bool all_finite(const Container& values) noexcept {
  return all_finite(values.data(), static_cast<int>(values.size()));
}

}  // namespace pinnquad
