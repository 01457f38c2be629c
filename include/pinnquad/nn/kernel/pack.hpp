// SPDX-License-Identifier: MIT
// Chooses the pack of a scalar type from what the compiler targets: the one place that asks.
// Kernels are templates on the pack, so code compiled for different instruction sets has different symbols.
#pragma once

#include "pinnquad/nn/kernel/pack_generic.hpp"

#if defined(__AVX512F__)
#include "pinnquad/nn/kernel/pack_avx512.hpp"
#elif defined(__AVX2__) && defined(__FMA__)
#include "pinnquad/nn/kernel/pack_avx2.hpp"
#endif

namespace pinnquad {

namespace detail {
template <class Scalar>
struct NativePack {
  using type = GenericPack<Scalar, 4>;
  static constexpr bool vector_unit = false;
};
#if defined(__AVX512F__)
template <>
struct NativePack<float> {
  using type = PackAvx512;
  static constexpr bool vector_unit = true;
};
#elif defined(__AVX2__) && defined(__FMA__)
template <>
struct NativePack<float> {
  using type = PackAvx2;
  static constexpr bool vector_unit = true;
};
#endif
}  // namespace detail

/// The widest pack that this translation unit may use.
template <class Scalar>
using NativePack = typename detail::NativePack<Scalar>::type;

/// True if NativePack has its own instructions.
template <class Scalar>
inline constexpr bool has_vector_unit = detail::NativePack<Scalar>::vector_unit;

/// `size` rounded up to whole packs.
template <class Pack>
constexpr int padded(int size) noexcept {
  return (size + Pack::width - 1) / Pack::width * Pack::width;
}

}  // namespace pinnquad
