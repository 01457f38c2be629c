// SPDX-License-Identifier: MIT
// Sixteen floats, or eight doubles, with AVX-512.
// The interface is that of pack_contract.hpp; include only where the compiler targets AVX-512F.
#pragma once

#if defined(__AVX512F__)  // elsewhere this header is empty

#include <immintrin.h>

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/kernel/pack_contract.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// 16 floats in one register.
struct PackAvx512 {
  using Scalar = float;
  static constexpr VectorUnit unit = VectorUnit::avx512;
  static constexpr bool fused = true;
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
  static PINNQUAD_ALWAYS_INLINE PackAvx512 square_root(PackAvx512 a) noexcept {
    return {_mm512_maskz_sqrt_ps(all, a.value)};
  }
  /// max(0, v) with v as the second operand: the instruction returns it when either is NaN.
  static PINNQUAD_ALWAYS_INLINE PackAvx512 positive_part(PackAvx512 a) noexcept {
    if constexpr (finite_math_only) return positive_part_by_bits(a);
    return {_mm512_maskz_max_ps(all, _mm512_setzero_ps(), a.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx512 where_positive(PackAvx512 gate, PackAvx512 a) noexcept {
    const __mmask16 positive = _mm512_cmp_ps_mask(gate.value, _mm512_setzero_ps(), _CMP_GT_OQ);
    return {_mm512_maskz_mov_ps(positive, a.value)};
  }
  /// column[c]: x[row * stride + c] in lane `row`, c = 0..3. All quarters of a register are transposed at once.
  static PINNQUAD_ALWAYS_INLINE void four_columns(const float* x, int stride, PackAvx512 (&column)[4]) noexcept {
    __m512 row[4];
    for (int i = 0; i < 4; ++i) {
      row[i] = _mm512_zextps128_ps512(_mm_loadu_ps(x + i * stride));
      row[i] = _mm512_maskz_insertf32x4(all, row[i], _mm_loadu_ps(x + (4 + i) * stride), 1);
      row[i] = _mm512_maskz_insertf32x4(all, row[i], _mm_loadu_ps(x + (8 + i) * stride), 2);
      row[i] = _mm512_maskz_insertf32x4(all, row[i], _mm_loadu_ps(x + (12 + i) * stride), 3);
    }
    const __m512 first = _mm512_maskz_unpacklo_ps(all, row[0], row[1]);
    const __m512 second = _mm512_maskz_unpacklo_ps(all, row[2], row[3]);
    const __m512 third = _mm512_maskz_unpackhi_ps(all, row[0], row[1]);
    const __m512 fourth = _mm512_maskz_unpackhi_ps(all, row[2], row[3]);
    column[0].value = _mm512_maskz_shuffle_ps(all, first, second, 0x44);
    column[1].value = _mm512_maskz_shuffle_ps(all, first, second, 0xee);
    column[2].value = _mm512_maskz_shuffle_ps(all, third, fourth, 0x44);
    column[3].value = _mm512_maskz_shuffle_ps(all, third, fourth, 0xee);
  }

  // A layer in registers (register_layer.hpp): eight rows, each in two neighbouring lanes that take two inputs.
  static constexpr int columns = 2;
  static constexpr int values = 8;
  static constexpr int blocks_per_register = 1;
  static constexpr int blocks_at_once = 1;
  static constexpr int chains = 4;

  /// Place of a value in its register: both lanes hold it.
  static constexpr int lane_of_value(int value) noexcept { return 2 * value; }
  /// The row whose products stand in lanes 2 pair and 2 pair + 1.
  static constexpr int row_of_pair(int, int pair) noexcept { return pair; }

  /// Values First and First + 1, in turn.
  template <int First>
  PINNQUAD_ALWAYS_INLINE PackAvx512 repeat() const noexcept {
    constexpr long long two_lanes = 2 * First | static_cast<long long>(2 * First + 2) << 32;
    const __m512i index = _mm512_maskz_set1_epi64(0xff, two_lanes);
    return {_mm512_maskz_permutexvar_ps(all, index, value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx512 repeat(const float* x) noexcept {
    double both;
    __builtin_memcpy(&both, x, sizeof both);
    return {_mm512_castpd_ps(_mm512_set1_pd(both))};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx512 repeat(float a, float b) noexcept {
    return {_mm512_castpd_ps(
        _mm512_maskz_broadcastsd_pd(0xff, _mm_castps_pd(_mm_unpacklo_ps(_mm_set_ss(a), _mm_set_ss(b)))))};
  }
  /// `v`, the last of an odd count, and 1 in turn.
  static PINNQUAD_ALWAYS_INLINE PackAvx512 repeat_last(PackAvx512 v) noexcept {
    return {_mm512_mask_broadcastss_ps(_mm512_set1_ps(1.0f), 0x5555, v.lowest_four())};
  }
  PINNQUAD_ALWAYS_INLINE PackAvx512 with_one() const noexcept {
    return {_mm512_mask_blend_ps(0xaaaa, value, _mm512_set1_ps(1.0f))};
  }
  /// The first lane, no matter what the others hold.
  static PINNQUAD_ALWAYS_INLINE PackAvx512 from_scalar(float v) noexcept {
    return {_mm512_zextps128_ps512(_mm_set_ss(v))};
  }
  PINNQUAD_ALWAYS_INLINE __m128 lowest_four() const noexcept { return _mm512_maskz_extractf32x4_ps(0xf, value, 0); }
  /// The sums of a block, both lanes of a row added, as values.
  static PINNQUAD_ALWAYS_INLINE PackAvx512 collect(const PackAvx512* sum) noexcept {
    return {_mm512_add_ps(sum->value, _mm512_maskz_permute_ps(all, sum->value, 0xb1))};
  }
  /// The first Count values, zero behind them.
  template <int Count>
  PINNQUAD_ALWAYS_INLINE PackAvx512 head() const noexcept {
    return {_mm512_maskz_mov_ps(static_cast<__mmask16>((1u << (2 * Count)) - 1u), value)};
  }
  /// Sum over the lanes of values, in the first.
  PINNQUAD_ALWAYS_INLINE PackAvx512 sum_of_values() const noexcept {
    const __m512d pairs = _mm512_castps_pd(value);
    const __m256 eight = _mm256_add_ps(_mm256_castpd_ps(_mm512_maskz_extractf64x4_pd(0xf, pairs, 0)),
                                       _mm256_castpd_ps(_mm512_maskz_extractf64x4_pd(0xf, pairs, 1)));
    const __m128 four = _mm_add_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
    return {_mm512_zextps128_ps512(_mm_add_ps(four, _mm_movehl_ps(four, four)))};
  }
  /// Is worked out here: the compiler may not put it off to where it is used.
  PINNQUAD_ALWAYS_INLINE void settle() noexcept { __asm__("" : "+v"(value)); }
  PINNQUAD_ALWAYS_INLINE float first_value() const noexcept { return _mm512_cvtss_f32(value); }
  /// y[0, Count) and nothing behind.
  template <int Count>
  PINNQUAD_ALWAYS_INLINE void store_values(float* y) const noexcept {
    // whole stores: a load of what a masked one wrote would wait
    const PackAvx512 dense{_mm512_maskz_compress_ps(0x5555, value)};
    if constexpr (Count == 8) {
      _mm256_storeu_ps(y, _mm256_castpd_ps(_mm512_maskz_extractf64x4_pd(0xf, _mm512_castps_pd(dense.value), 0)));
    } else if constexpr (Count == 4) {
      _mm_storeu_ps(y, dense.lowest_four());
    } else {
      alignas(64) float lane[width];
      dense.store(lane);
      for (int i = 0; i < Count; ++i) y[i] = lane[i];
    }
  }
};

/// 8 doubles in one register.
struct PackAvx512Double {
  using Scalar = double;
  static constexpr VectorUnit unit = VectorUnit::avx512;
  static constexpr bool fused = true;
  static constexpr int width = 8;
  static constexpr int tile_rows = 8;
  static constexpr int tile_vectors = 2;

  __m512d value;
  static constexpr __mmask8 all = 0xff;  ///< as above

  static PINNQUAD_ALWAYS_INLINE PackAvx512Double load(const double* p) noexcept { return {_mm512_loadu_pd(p)}; }
  static PINNQUAD_ALWAYS_INLINE PackAvx512Double broadcast(double v) noexcept { return {_mm512_set1_pd(v)}; }
  PINNQUAD_ALWAYS_INLINE void store(double* p) const noexcept { _mm512_storeu_pd(p, value); }
  static PINNQUAD_ALWAYS_INLINE PackAvx512Double multiply_add(PackAvx512Double a, PackAvx512Double b,
                                                              PackAvx512Double c) noexcept {
    return {_mm512_fmadd_pd(a.value, b.value, c.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx512Double square_root(PackAvx512Double a) noexcept {
    return {_mm512_maskz_sqrt_pd(all, a.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx512Double positive_part(PackAvx512Double a) noexcept {
    if constexpr (finite_math_only) return positive_part_by_bits(a);
    return {_mm512_maskz_max_pd(all, _mm512_setzero_pd(), a.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx512Double where_positive(PackAvx512Double gate, PackAvx512Double a) noexcept {
    const __mmask8 positive = _mm512_cmp_pd_mask(gate.value, _mm512_setzero_pd(), _CMP_GT_OQ);
    return {_mm512_maskz_mov_pd(positive, a.value)};
  }

  // A layer in registers (register_layer.hpp): four rows, each in two neighbouring lanes that take two inputs; two such
  // sums make a register of eight values.
  static constexpr int columns = 2;
  static constexpr int values = 8;
  static constexpr int blocks_per_register = 2;
  static constexpr int blocks_at_once = 6;
  static constexpr int chains = 2;

  static constexpr int lane_of_value(int value) noexcept { return value; }
  /// The row whose products stand in lanes 2 pair and 2 pair + 1 of a block, such that collect() puts it in its place.
  static constexpr int row_of_pair(int block, int pair) noexcept { return 2 * pair + block; }

  /// Values First and First + 1, in turn.
  template <int First>
  PINNQUAD_ALWAYS_INLINE PackAvx512Double repeat() const noexcept {
    return {_mm512_maskz_shuffle_f64x2(all, value, value, First / 2 * 0x55)};
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx512Double repeat(const double* x) noexcept { return repeat(_mm_loadu_pd(x)); }
  static PINNQUAD_ALWAYS_INLINE PackAvx512Double repeat(double a, double b) noexcept {
    return repeat(_mm_set_pd(b, a));
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx512Double repeat(__m128d both) noexcept {
    return {_mm512_castps_pd(_mm512_maskz_broadcast_f32x4(0xffff, _mm_castpd_ps(both)))};
  }
  /// `v`, the last of an odd count, and 1 in turn.
  static PINNQUAD_ALWAYS_INLINE PackAvx512Double repeat_last(PackAvx512Double v) noexcept {
    return {_mm512_mask_broadcastsd_pd(_mm512_set1_pd(1.0), 0x55, v.lowest_two())};
  }
  PINNQUAD_ALWAYS_INLINE PackAvx512Double with_one() const noexcept {
    return {_mm512_mask_blend_pd(0xaa, value, _mm512_set1_pd(1.0))};
  }
  PINNQUAD_ALWAYS_INLINE __m128d lowest_two() const noexcept {
    return _mm_castps_pd(_mm512_maskz_extractf32x4_ps(0xf, _mm512_castpd_ps(value), 0));
  }
  static PINNQUAD_ALWAYS_INLINE PackAvx512Double from_scalar(double v) noexcept { return broadcast(v); }
  /// The sums of two blocks, both lanes of a row added, as values.
  static PINNQUAD_ALWAYS_INLINE PackAvx512Double collect(const PackAvx512Double* sum) noexcept {
    return {_mm512_add_pd(_mm512_maskz_unpacklo_pd(all, sum[0].value, sum[1].value),
                          _mm512_maskz_unpackhi_pd(all, sum[0].value, sum[1].value))};
  }
  template <int Count>
  PINNQUAD_ALWAYS_INLINE PackAvx512Double head() const noexcept {
    return {_mm512_maskz_mov_pd((1 << Count) - 1, value)};
  }
  /// Sum over the lanes, in the first.
  PINNQUAD_ALWAYS_INLINE PackAvx512Double sum_of_values() const noexcept {
    const __m256d four = _mm256_add_pd(_mm512_maskz_extractf64x4_pd(0xf, value, 0),  //
                                       _mm512_maskz_extractf64x4_pd(0xf, value, 1));
    const __m128d two = _mm_add_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
    return {_mm512_zextpd128_pd512(_mm_add_pd(two, _mm_unpackhi_pd(two, two)))};
  }
  PINNQUAD_ALWAYS_INLINE void settle() noexcept { __asm__("" : "+v"(value)); }
  PINNQUAD_ALWAYS_INLINE double first_value() const noexcept { return _mm512_cvtsd_f64(value); }
  /// y[0, Count) and nothing behind.
  template <int Count>
  PINNQUAD_ALWAYS_INLINE void store_values(double* y) const noexcept {
    if constexpr (Count == width) {
      store(y);
    } else if constexpr (Count == 4) {
      _mm256_storeu_pd(y, _mm512_maskz_extractf64x4_pd(0xf, value, 0));
    } else {
      alignas(64) double lane[width];
      store(lane);
      for (int i = 0; i < Count; ++i) y[i] = lane[i];
    }
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail

#endif
