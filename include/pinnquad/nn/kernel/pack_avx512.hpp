// SPDX-License-Identifier: MIT
// Sixteen floats with AVX-512.
// Same interface as pack_generic.hpp; include only where the compiler targets AVX-512F.
#pragma once

#include <immintrin.h>

#include <cmath>

#include "pinnquad/core/attributes.hpp"

namespace pinnquad {

/// 16 floats in one register.
struct PackAvx512 {
  using Scalar = float;
  static constexpr int width = 16;
  static constexpr int tile_rows = 8;
  static constexpr int tile_vectors = 2;

  __m512 value;
  /// Every lane. The zero-masked forms cost nothing; gcc 12 warns of an uninitialised value inside the plain ones.
  static constexpr __mmask16 all = 0xffff;

  static PINNQUAD_ALWAYS_INLINE PackAvx512 load(const float* p) noexcept { return {_mm512_loadu_ps(p)}; }
  static PINNQUAD_ALWAYS_INLINE PackAvx512 broadcast(float v) noexcept { return {_mm512_set1_ps(v)}; }
  PINNQUAD_ALWAYS_INLINE void store(float* p) const noexcept { _mm512_storeu_ps(p, value); }
  static PINNQUAD_ALWAYS_INLINE PackAvx512 multiply_add(PackAvx512 a, PackAvx512 b, PackAvx512 c) noexcept {
    return {_mm512_fmadd_ps(a.value, b.value, c.value)};
  }
  friend PINNQUAD_ALWAYS_INLINE PackAvx512 operator+(PackAvx512 a, PackAvx512 b) noexcept {
    return {_mm512_add_ps(a.value, b.value)};
  }
  friend PINNQUAD_ALWAYS_INLINE PackAvx512 operator-(PackAvx512 a, PackAvx512 b) noexcept {
    return {_mm512_sub_ps(a.value, b.value)};
  }
  friend PINNQUAD_ALWAYS_INLINE PackAvx512 operator*(PackAvx512 a, PackAvx512 b) noexcept {
    return {_mm512_mul_ps(a.value, b.value)};
  }
  friend PINNQUAD_ALWAYS_INLINE PackAvx512 operator/(PackAvx512 a, PackAvx512 b) noexcept {
    return {_mm512_div_ps(a.value, b.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx512 square_root(PackAvx512 a) noexcept {
    return {_mm512_maskz_sqrt_ps(all, a.value)};
  }
  /// max(0, v) with v as the second operand: the instruction returns it when either is NaN.
  static PINNQUAD_ALWAYS_INLINE PackAvx512 positive_part(PackAvx512 a) noexcept {
    return {_mm512_maskz_max_ps(all, _mm512_setzero_ps(), a.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx512 where_positive(PackAvx512 gate, PackAvx512 a) noexcept {
    const __mmask16 positive = _mm512_cmp_ps_mask(gate.value, _mm512_setzero_ps(), _CMP_GT_OQ);
    return {_mm512_maskz_mov_ps(positive, a.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx512 hyperbolic_tangent(PackAvx512 a) noexcept {
    alignas(64) float lane[width];
    _mm512_store_ps(lane, a.value);
    for (float& v : lane) v = std::tanh(v);
    return {_mm512_load_ps(lane)};
  }
};

}  // namespace pinnquad
