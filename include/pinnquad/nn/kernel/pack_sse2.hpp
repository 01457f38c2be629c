// SPDX-License-Identifier: MIT
// Four floats, or two doubles, with SSE2, which every x86-64 has.
// The interface is that of pack_contract.hpp; include only where the compiler targets SSE2.
#pragma once

#if defined(__SSE2__)  // elsewhere this header is empty

#include <emmintrin.h>
#if defined(__FMA__)
#include <immintrin.h>
#elif defined(__FMA4__)
#include <x86intrin.h>
#endif

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/kernel/pack_contract.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// 4 floats in one register. Product and sum are rounded once where the processor has the instruction without AVX2.
struct PackSse2 : OneColumn<PackSse2, float, 4> {
  static constexpr VectorUnit unit = VectorUnit::sse2;
#if defined(__FMA__) || defined(__FMA4__)
  static constexpr bool fused = true;
#else
  static constexpr bool fused = false;
#endif
  static constexpr int tile_rows = 4;
  static constexpr int tile_vectors = 1;

  using OneColumn::OneColumn, OneColumn::repeat;

  static PINNQUAD_ALWAYS_INLINE PackSse2 load(const float* p) noexcept { return {_mm_loadu_ps(p)}; }
  static PINNQUAD_ALWAYS_INLINE PackSse2 broadcast(float v) noexcept { return {_mm_set1_ps(v)}; }
  PINNQUAD_ALWAYS_INLINE void store(float* p) const noexcept { _mm_storeu_ps(p, value); }
  /// a * b + c
  static PINNQUAD_ALWAYS_INLINE PackSse2 multiply_add(PackSse2 a, PackSse2 b, PackSse2 c) noexcept {
#if defined(__FMA__)
    return {_mm_fmadd_ps(a.value, b.value, c.value)};
#elif defined(__FMA4__)
    return {_mm_macc_ps(a.value, b.value, c.value)};
#else
    return a * b + c;
#endif
  }
  static PINNQUAD_ALWAYS_INLINE PackSse2 square_root(PackSse2 a) noexcept { return {_mm_sqrt_ps(a.value)}; }
  /// max(0, v) with v as the second operand: the instruction returns it when either is NaN.
  static PINNQUAD_ALWAYS_INLINE PackSse2 positive_part(PackSse2 a) noexcept {
    if constexpr (finite_math_only) return positive_part_by_bits(a);
    return {_mm_max_ps(_mm_setzero_ps(), a.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackSse2 where_positive(PackSse2 gate, PackSse2 a) noexcept {
    return {_mm_and_ps(_mm_cmpgt_ps(gate.value, _mm_setzero_ps()), a.value)};
  }
  /// column[c]: x[row * stride + c] in lane `row`, c = 0..3.
  static PINNQUAD_ALWAYS_INLINE void four_columns(const float* x, int stride, PackSse2 (&column)[4]) noexcept {
    for (int row = 0; row < 4; ++row) column[row] = load(x + row * stride);
    _MM_TRANSPOSE4_PS(column[0].value, column[1].value, column[2].value, column[3].value);
  }

  // A layer in registers (register_layer.hpp): four rows, one input.
  static constexpr int blocks_at_once = 3;
  static constexpr int chains = 2;

  /// Value First in every lane.
  template <int First>
  PINNQUAD_ALWAYS_INLINE PackSse2 repeat() const noexcept {
    return {_mm_shuffle_ps(value, value, First * 0x55)};
  }
  /// The first Count values, zero behind them.
  template <int Count>
  PINNQUAD_ALWAYS_INLINE PackSse2 head() const noexcept {
    const __m128i used = _mm_set_epi32(Count > 3 ? -1 : 0, Count > 2 ? -1 : 0, Count > 1 ? -1 : 0, Count > 0 ? -1 : 0);
    return {_mm_and_ps(_mm_castsi128_ps(used), value)};
  }
  /// Sum over the lanes, in the first.
  PINNQUAD_ALWAYS_INLINE PackSse2 sum_of_values() const noexcept {
    const __m128 two = _mm_add_ps(value, _mm_movehl_ps(value, value));
    return {_mm_add_ps(two, _mm_shuffle_ps(two, two, 0x55))};
  }
  /// Is worked out here: the compiler may not put it off to where it is used.
  PINNQUAD_ALWAYS_INLINE void settle() noexcept { __asm__("" : "+x"(value)); }
};

/// 2 doubles in one register; rounded as floats are.
struct PackSse2Double : OneColumn<PackSse2Double, double, 2> {
  static constexpr VectorUnit unit = VectorUnit::sse2;
  static constexpr bool fused = PackSse2::fused;
  static constexpr int tile_rows = 4;
  static constexpr int tile_vectors = 2;

  using OneColumn::OneColumn, OneColumn::repeat;

  static PINNQUAD_ALWAYS_INLINE PackSse2Double load(const double* p) noexcept { return {_mm_loadu_pd(p)}; }
  static PINNQUAD_ALWAYS_INLINE PackSse2Double broadcast(double v) noexcept { return {_mm_set1_pd(v)}; }
  PINNQUAD_ALWAYS_INLINE void store(double* p) const noexcept { _mm_storeu_pd(p, value); }
  /// a * b + c
  static PINNQUAD_ALWAYS_INLINE PackSse2Double multiply_add(PackSse2Double a, PackSse2Double b,
                                                            PackSse2Double c) noexcept {
#if defined(__FMA__)
    return {_mm_fmadd_pd(a.value, b.value, c.value)};
#elif defined(__FMA4__)
    return {_mm_macc_pd(a.value, b.value, c.value)};
#else
    return a * b + c;
#endif
  }
  static PINNQUAD_ALWAYS_INLINE PackSse2Double square_root(PackSse2Double a) noexcept { return {_mm_sqrt_pd(a.value)}; }
  static PINNQUAD_ALWAYS_INLINE PackSse2Double positive_part(PackSse2Double a) noexcept {
    if constexpr (finite_math_only) return positive_part_by_bits(a);
    return {_mm_max_pd(_mm_setzero_pd(), a.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackSse2Double where_positive(PackSse2Double gate, PackSse2Double a) noexcept {
    return {_mm_and_pd(_mm_cmpgt_pd(gate.value, _mm_setzero_pd()), a.value)};
  }

  // A layer in registers (register_layer.hpp): two rows, one input.
  static constexpr int blocks_at_once = 6;
  static constexpr int chains = 1;

  /// Value First in both lanes.
  template <int First>
  PINNQUAD_ALWAYS_INLINE PackSse2Double repeat() const noexcept {
    return {_mm_shuffle_pd(value, value, First * 3)};
  }
  template <int Count>
  PINNQUAD_ALWAYS_INLINE PackSse2Double head() const noexcept {
    static_assert(Count == 1 || Count == 2);
    return Count == 2 ? *this : PackSse2Double{_mm_move_sd(_mm_setzero_pd(), value)};
  }
  /// Sum over the lanes, in the first.
  PINNQUAD_ALWAYS_INLINE PackSse2Double sum_of_values() const noexcept {
    return {_mm_add_pd(value, _mm_unpackhi_pd(value, value))};
  }
  PINNQUAD_ALWAYS_INLINE void settle() noexcept { __asm__("" : "+x"(value)); }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail

#endif
