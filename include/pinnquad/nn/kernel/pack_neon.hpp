// SPDX-License-Identifier: MIT
// Four floats, or two doubles, with NEON (aarch64).
// The interface is that of pack_contract.hpp; include only where the compiler targets aarch64.
#pragma once

#if defined(__ARM_NEON) && defined(__aarch64__)  // elsewhere this header is empty

#include <arm_neon.h>

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/kernel/pack_contract.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// 4 floats in one register.
struct PackNeon : OneColumn<PackNeon, float, 4> {
  static constexpr VectorUnit unit = VectorUnit::neon;
  static constexpr bool fused = true;
  static constexpr int tile_rows = 4;
  static constexpr int tile_vectors = 2;

  using OneColumn::OneColumn, OneColumn::repeat;

  static PINNQUAD_ALWAYS_INLINE PackNeon load(const float* p) noexcept { return {vld1q_f32(p)}; }
  static PINNQUAD_ALWAYS_INLINE PackNeon broadcast(float v) noexcept { return {vdupq_n_f32(v)}; }
  PINNQUAD_ALWAYS_INLINE void store(float* p) const noexcept { vst1q_f32(p, value); }
  /// a * b + c
  static PINNQUAD_ALWAYS_INLINE PackNeon multiply_add(PackNeon a, PackNeon b, PackNeon c) noexcept {
    return {vfmaq_f32(c.value, a.value, b.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackNeon square_root(PackNeon a) noexcept { return {vsqrtq_f32(a.value)}; }
  /// v < 0 ? 0 : v. FMAX returns NaN when either is, whichever comes first.
  static PINNQUAD_ALWAYS_INLINE PackNeon positive_part(PackNeon a) noexcept {
    return {vmaxq_f32(a.value, vdupq_n_f32(0.0f))};
  }
  static PINNQUAD_ALWAYS_INLINE PackNeon where_positive(PackNeon gate, PackNeon a) noexcept {
    return {vreinterpretq_f32_u32(vandq_u32(vcgtzq_f32(gate.value), vreinterpretq_u32_f32(a.value)))};
  }

  // A layer in registers (register_layer.hpp): four rows, one input.
  static constexpr int blocks_at_once = 6;
  static constexpr int chains = 2;

  /// Value First in every lane.
  template <int First>
  PINNQUAD_ALWAYS_INLINE PackNeon repeat() const noexcept {
    return {vdupq_laneq_f32(value, First)};
  }
  /// The first Count values, zero behind them.
  template <int Count>
  PINNQUAD_ALWAYS_INLINE PackNeon head() const noexcept {
    const uint32x4_t lane = {0, 1, 2, 3};
    const uint32x4_t used = vcltq_u32(lane, vdupq_n_u32(Count));
    return {vreinterpretq_f32_u32(vandq_u32(used, vreinterpretq_u32_f32(value)))};
  }
  /// Sum over the lanes, in every one.
  PINNQUAD_ALWAYS_INLINE PackNeon sum_of_values() const noexcept { return broadcast(vaddvq_f32(value)); }
  /// Is worked out here: the compiler may not put it off to where it is used.
  PINNQUAD_ALWAYS_INLINE void settle() noexcept { __asm__("" : "+w"(value)); }
};

/// 2 doubles in one register.
struct PackNeonDouble : OneColumn<PackNeonDouble, double, 2> {
  static constexpr VectorUnit unit = VectorUnit::neon;
  static constexpr bool fused = true;
  static constexpr int tile_rows = 4;
  static constexpr int tile_vectors = 2;

  using OneColumn::OneColumn, OneColumn::repeat;

  static PINNQUAD_ALWAYS_INLINE PackNeonDouble load(const double* p) noexcept { return {vld1q_f64(p)}; }
  static PINNQUAD_ALWAYS_INLINE PackNeonDouble broadcast(double v) noexcept { return {vdupq_n_f64(v)}; }
  PINNQUAD_ALWAYS_INLINE void store(double* p) const noexcept { vst1q_f64(p, value); }
  /// a * b + c
  static PINNQUAD_ALWAYS_INLINE PackNeonDouble multiply_add(PackNeonDouble a, PackNeonDouble b,
                                                            PackNeonDouble c) noexcept {
    return {vfmaq_f64(c.value, a.value, b.value)};
  }
  static PINNQUAD_ALWAYS_INLINE PackNeonDouble square_root(PackNeonDouble a) noexcept { return {vsqrtq_f64(a.value)}; }
  /// As that of floats.
  static PINNQUAD_ALWAYS_INLINE PackNeonDouble positive_part(PackNeonDouble a) noexcept {
    return {vmaxq_f64(a.value, vdupq_n_f64(0.0))};
  }
  static PINNQUAD_ALWAYS_INLINE PackNeonDouble where_positive(PackNeonDouble gate, PackNeonDouble a) noexcept {
    return {vreinterpretq_f64_u64(vandq_u64(vcgtzq_f64(gate.value), vreinterpretq_u64_f64(a.value)))};
  }

  // A layer in registers (register_layer.hpp): two rows, one input.
  static constexpr int blocks_at_once = 12;
  static constexpr int chains = 1;

  /// Value First in both lanes.
  template <int First>
  PINNQUAD_ALWAYS_INLINE PackNeonDouble repeat() const noexcept {
    return {vdupq_laneq_f64(value, First)};
  }
  template <int Count>
  PINNQUAD_ALWAYS_INLINE PackNeonDouble head() const noexcept {
    static_assert(Count == 1 || Count == 2);
    return Count == 2 ? *this : PackNeonDouble{vcopyq_laneq_f64(value, 1, vdupq_n_f64(0.0), 0)};
  }
  /// Sum over the lanes, in every one.
  PINNQUAD_ALWAYS_INLINE PackNeonDouble sum_of_values() const noexcept { return broadcast(vaddvq_f64(value)); }
  PINNQUAD_ALWAYS_INLINE void settle() noexcept { __asm__("" : "+w"(value)); }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail

#endif
