// SPDX-License-Identifier: MIT
// Eight floats, or four doubles, with AVX2 and FMA.
// The interface is that of pack_contract.hpp; include only where the compiler targets AVX2 and FMA.
#pragma once

#if defined(__AVX2__) && defined(__FMA__)  // elsewhere this header is empty

#include <immintrin.h>

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/kernel/pack_contract.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// 8 floats in one register.
struct PackAvx2 {
  using Scalar = float;
  static constexpr VectorUnit unit = VectorUnit::avx2;
  static constexpr bool fused = true;
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
  static PINNQUAD_ALWAYS_INLINE PackAvx2 square_root(PackAvx2 a) noexcept { return {_mm256_sqrt_ps(a.value)}; }
  /// max(0, v) with v as the second operand: the instruction returns it when either is NaN.
  static PINNQUAD_ALWAYS_INLINE PackAvx2 positive_part(PackAvx2 a) noexcept {
    if constexpr (finite_math_only) return positive_part_by_bits(a);
    return {_mm256_max_ps(_mm256_setzero_ps(), a.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx2 where_positive(PackAvx2 gate, PackAvx2 a) noexcept {
    const __m256 positive = _mm256_cmp_ps(gate.value, _mm256_setzero_ps(), _CMP_GT_OQ);
    return {_mm256_and_ps(positive, a.value)};
  }
  /// column[c]: x[row * stride + c] in lane `row`, c = 0..3. Both halves of a register are transposed at once.
  static PINNQUAD_ALWAYS_INLINE void four_columns(const float* x, int stride, PackAvx2 (&column)[4]) noexcept {
    __m256 row[4];
    for (int i = 0; i < 4; ++i) {
      row[i] = _mm256_castps128_ps256(_mm_loadu_ps(x + i * stride));
      row[i] = _mm256_insertf128_ps(row[i], _mm_loadu_ps(x + (4 + i) * stride), 1);
    }
    const __m256 first = _mm256_unpacklo_ps(row[0], row[1]), second = _mm256_unpacklo_ps(row[2], row[3]);
    const __m256 third = _mm256_unpackhi_ps(row[0], row[1]), fourth = _mm256_unpackhi_ps(row[2], row[3]);
    column[0].value = _mm256_shuffle_ps(first, second, 0x44);
    column[1].value = _mm256_shuffle_ps(first, second, 0xee);
    column[2].value = _mm256_shuffle_ps(third, fourth, 0x44);
    column[3].value = _mm256_shuffle_ps(third, fourth, 0xee);
  }

  // A layer in registers (register_layer.hpp): four rows, each in two neighbouring lanes that take two inputs; two such
  // sums make a register of eight values.
  static constexpr int columns = 2;
  static constexpr int values = 8;
  static constexpr int blocks_per_register = 2;
  static constexpr int blocks_at_once = 4;
  static constexpr int chains = 2;

  static constexpr int lane_of_value(int value) noexcept { return value; }
  /// The row whose products stand in lanes 2 pair and 2 pair + 1 of a block, such that collect() puts it in its place.
  static constexpr int row_of_pair(int block, int pair) noexcept { return 4 * (pair / 2) + 2 * block + pair % 2; }

  /// Each half meets its own four values first, then those of the other: halves are swapped once, not pair by pair.
  static constexpr int column_met(int first, int pair) noexcept { return (first + 4 * (pair / 2)) % values; }
  template <int First>
  PINNQUAD_ALWAYS_INLINE PackAvx2 meet() const noexcept {
    const __m256 halves = First < 4 ? value : _mm256_permute2f128_ps(value, value, 1);
    return {_mm256_shuffle_ps(halves, halves, First % 4 == 0 ? 0x44 : 0xee)};
  }
  /// Values First and First + 1, in turn.
  template <int First>
  PINNQUAD_ALWAYS_INLINE PackAvx2 repeat() const noexcept {
    return {_mm256_castpd_ps(_mm256_permute4x64_pd(_mm256_castps_pd(value), First / 2 * 0x55))};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx2 repeat(const float* x) noexcept {
    double both;
    __builtin_memcpy(&both, x, sizeof both);
    return {_mm256_castpd_ps(_mm256_set1_pd(both))};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx2 repeat(float a, float b) noexcept {
    return {_mm256_castpd_ps(_mm256_broadcastsd_pd(_mm_castps_pd(_mm_unpacklo_ps(_mm_set_ss(a), _mm_set_ss(b)))))};
  }
  /// `v`, the last of an odd count, and 1 in turn.
  static PINNQUAD_ALWAYS_INLINE PackAvx2 repeat_last(PackAvx2 v) noexcept {
    return PackAvx2{_mm256_broadcastss_ps(_mm256_castps256_ps128(v.value))}.with_one();
  }
  PINNQUAD_ALWAYS_INLINE PackAvx2 with_one() const noexcept {
    return {_mm256_blend_ps(value, _mm256_set1_ps(1.0f), 0xaa)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx2 from_scalar(float v) noexcept { return {_mm256_set1_ps(v)}; }
  /// The sums of two blocks, both lanes of a row added, as values.
  static PINNQUAD_ALWAYS_INLINE PackAvx2 collect(const PackAvx2* sum) noexcept {
    return {_mm256_add_ps(_mm256_shuffle_ps(sum[0].value, sum[1].value, 0x88),
                          _mm256_shuffle_ps(sum[0].value, sum[1].value, 0xdd))};
  }
  /// The first Count values, zero behind them.
  template <int Count>
  PINNQUAD_ALWAYS_INLINE PackAvx2 head() const noexcept {
    return {_mm256_blend_ps(_mm256_setzero_ps(), value, (1 << Count) - 1)};
  }
  /// Sum over the lanes, in the first.
  PINNQUAD_ALWAYS_INLINE PackAvx2 sum_of_values() const noexcept {
    const __m128 four = _mm_add_ps(_mm256_castps256_ps128(value), _mm256_extractf128_ps(value, 1));
    const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
    return {_mm256_castps128_ps256(_mm_add_ps(two, _mm_movehdup_ps(two)))};
  }
  /// Is worked out here: the compiler may not put it off to where it is used.
  PINNQUAD_ALWAYS_INLINE void settle() noexcept { __asm__("" : "+v"(value)); }
  PINNQUAD_ALWAYS_INLINE float first_value() const noexcept { return _mm256_cvtss_f32(value); }
  /// y[0, Count) and nothing behind.
  template <int Count>
  PINNQUAD_ALWAYS_INLINE void store_values(float* y) const noexcept {
    if constexpr (Count == 8) {
      store(y);
    } else if constexpr (Count == 4) {
      _mm_storeu_ps(y, _mm256_castps256_ps128(value));
    } else {
      alignas(32) float lane[width];
      _mm256_store_ps(lane, value);
      for (int i = 0; i < Count; ++i) y[i] = lane[i];
    }
  }
};

/// 4 doubles in one register.
struct PackAvx2Double : OneColumn<PackAvx2Double, double, 4> {
  static constexpr VectorUnit unit = VectorUnit::avx2;
  static constexpr bool fused = true;
  static constexpr int tile_rows = 4;
  static constexpr int tile_vectors = 2;

  using OneColumn::OneColumn, OneColumn::repeat;

  static PINNQUAD_ALWAYS_INLINE PackAvx2Double load(const double* p) noexcept { return {_mm256_loadu_pd(p)}; }
  static PINNQUAD_ALWAYS_INLINE PackAvx2Double broadcast(double v) noexcept { return {_mm256_set1_pd(v)}; }
  PINNQUAD_ALWAYS_INLINE void store(double* p) const noexcept { _mm256_storeu_pd(p, value); }
  static PINNQUAD_ALWAYS_INLINE PackAvx2Double multiply_add(PackAvx2Double a, PackAvx2Double b,
                                                            PackAvx2Double c) noexcept {
    return {_mm256_fmadd_pd(a.value, b.value, c.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx2Double square_root(PackAvx2Double a) noexcept {
    return {_mm256_sqrt_pd(a.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx2Double positive_part(PackAvx2Double a) noexcept {
    if constexpr (finite_math_only) return positive_part_by_bits(a);
    return {_mm256_max_pd(_mm256_setzero_pd(), a.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx2Double where_positive(PackAvx2Double gate, PackAvx2Double a) noexcept {
    return {_mm256_and_pd(_mm256_cmp_pd(gate.value, _mm256_setzero_pd(), _CMP_GT_OQ), a.value)};
  }

  // A layer in registers (register_layer.hpp): four rows, one input.
  static constexpr int blocks_at_once = 6;
  static constexpr int chains = 2;

  /// Value First in every lane.
  template <int First>
  PINNQUAD_ALWAYS_INLINE PackAvx2Double repeat() const noexcept {
    return {_mm256_permute4x64_pd(value, First * 0x55)};
  }
  template <int Count>
  PINNQUAD_ALWAYS_INLINE PackAvx2Double head() const noexcept {
    return {_mm256_blend_pd(_mm256_setzero_pd(), value, (1 << Count) - 1)};
  }
  /// Sum over the lanes, in the first.
  PINNQUAD_ALWAYS_INLINE PackAvx2Double sum_of_values() const noexcept {
    const __m128d two = _mm_add_pd(_mm256_castpd256_pd128(value), _mm256_extractf128_pd(value, 1));
    return {_mm256_castpd128_pd256(_mm_add_pd(two, _mm_unpackhi_pd(two, two)))};
  }
  PINNQUAD_ALWAYS_INLINE void settle() noexcept { __asm__("" : "+v"(value)); }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail

#endif
