// SPDX-License-Identifier: MIT
// Standardisation by a training set: z = (v - mean) / standard_deviation, part of every model on both ends.
#pragma once

#include <array>
#include <cstddef>

#include "pinnquad/core/attributes.hpp"

namespace pinnquad {

namespace detail {
template <class Scalar, int Size>
constexpr std::array<Scalar, static_cast<std::size_t>(Size)> all_ones() noexcept {
  std::array<Scalar, static_cast<std::size_t>(Size)> result{};
  for (Scalar& v : result) v = Scalar(1);
  return result;
}
/// Worked out by the compiler: copied, not filled, in an unoptimised build too.
template <class Scalar, int Size>
inline constexpr std::array<Scalar, static_cast<std::size_t>(Size)> ones = all_ones<Scalar, Size>();
}  // namespace detail

/// Mean and standard deviation per entry. No standard deviation is zero.
template <class Scalar, int Size>
struct Scaler {
  static constexpr int size = Size;
  std::array<Scalar, static_cast<std::size_t>(Size)> mean{};
  std::array<Scalar, static_cast<std::size_t>(Size)> standard_deviation = detail::ones<Scalar, Size>;

  PINNQUAD_ALWAYS_INLINE void standardise(const Scalar* values, Scalar* standardised) const noexcept {
    for (int i = 0; i < Size; ++i) {
      standardised[i] =
          (values[i] - mean[static_cast<std::size_t>(i)]) / standard_deviation[static_cast<std::size_t>(i)];
    }
  }
  PINNQUAD_ALWAYS_INLINE void restore(const Scalar* standardised, Scalar* values) const noexcept {
    for (int i = 0; i < Size; ++i) {
      values[i] = standardised[i] * standard_deviation[static_cast<std::size_t>(i)] + mean[static_cast<std::size_t>(i)];
    }
  }
};

}  // namespace pinnquad
