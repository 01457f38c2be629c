// SPDX-License-Identifier: MIT
// Eight floats with AVX2 and FMA.
// Same interface as pack_generic.hpp; include only where the compiler targets AVX2 and FMA.
#pragma once

#include <immintrin.h>

#include <cmath>

#include "pinnquad/core/attributes.hpp"

namespace pinnquad {

/// 8 floats in one register.
struct PackAvx2 {
  using Scalar = float;
  static constexpr int width = 8;
  static constexpr int tile_rows = 4;
  static constexpr int tile_vectors = 2;

  __m256 value;

  static PINNQUAD_ALWAYS_INLINE PackAvx2 load(const float* p) noexcept { return {_mm256_loadu_ps(p)}; }
  static PINNQUAD_ALWAYS_INLINE PackAvx2 broadcast(float v) noexcept { return {_mm256_set1_ps(v)}; }
  PINNQUAD_ALWAYS_INLINE void store(float* p) const noexcept { _mm256_storeu_ps(p, value); }
  static PINNQUAD_ALWAYS_INLINE PackAvx2 multiply_add(PackAvx2 a, PackAvx2 b, PackAvx2 c) noexcept {
    return {_mm256_fmadd_ps(a.value, b.value, c.value)};
  }
  friend PINNQUAD_ALWAYS_INLINE PackAvx2 operator+(PackAvx2 a, PackAvx2 b) noexcept {
    return {_mm256_add_ps(a.value, b.value)};
  }
  friend PINNQUAD_ALWAYS_INLINE PackAvx2 operator-(PackAvx2 a, PackAvx2 b) noexcept {
    return {_mm256_sub_ps(a.value, b.value)};
  }
  friend PINNQUAD_ALWAYS_INLINE PackAvx2 operator*(PackAvx2 a, PackAvx2 b) noexcept {
    return {_mm256_mul_ps(a.value, b.value)};
  }
  friend PINNQUAD_ALWAYS_INLINE PackAvx2 operator/(PackAvx2 a, PackAvx2 b) noexcept {
    return {_mm256_div_ps(a.value, b.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx2 square_root(PackAvx2 a) noexcept { return {_mm256_sqrt_ps(a.value)}; }
  /// max(0, v) with v as the second operand: the instruction returns it when either is NaN.
  static PINNQUAD_ALWAYS_INLINE PackAvx2 positive_part(PackAvx2 a) noexcept {
    return {_mm256_max_ps(_mm256_setzero_ps(), a.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx2 where_positive(PackAvx2 gate, PackAvx2 a) noexcept {
    const __m256 positive = _mm256_cmp_ps(gate.value, _mm256_setzero_ps(), _CMP_GT_OQ);
    return {_mm256_and_ps(positive, a.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx2 hyperbolic_tangent(PackAvx2 a) noexcept {
    alignas(32) float lane[width];
    _mm256_store_ps(lane, a.value);
    for (float& v : lane) v = std::tanh(v);
    return {_mm256_load_ps(lane)};
  }
};

}  // namespace pinnquad
