// SPDX-License-Identifier: MIT
// The pack of a scalar type on the vector unit that core/instruction_set.hpp decided for.
// Kernels are templates on the pack, so code compiled for different instruction sets has different symbols.
#pragma once

#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/nn/kernel/pack_contract.hpp"
#include "pinnquad/nn/kernel/pack_generic.hpp"

#if defined(PINNQUAD_UNIT_AVX512) && PINNQUAD_KERNEL_BITS == 512
#include "pinnquad/nn/kernel/pack_avx512.hpp"
#define PINNQUAD_FLOAT_PACK PackAvx512
#define PINNQUAD_DOUBLE_PACK PackAvx512Double
#elif defined(PINNQUAD_UNIT_AVX512) || defined(PINNQUAD_UNIT_AVX2)
#include "pinnquad/nn/kernel/pack_avx2.hpp"
#define PINNQUAD_FLOAT_PACK PackAvx2
#define PINNQUAD_DOUBLE_PACK PackAvx2Double
#elif defined(PINNQUAD_UNIT_SSE2)
#include "pinnquad/nn/kernel/pack_sse2.hpp"
#define PINNQUAD_FLOAT_PACK PackSse2
#define PINNQUAD_DOUBLE_PACK PackSse2Double
#elif defined(PINNQUAD_UNIT_NEON)
#include "pinnquad/nn/kernel/pack_neon.hpp"
#define PINNQUAD_FLOAT_PACK PackNeon
#define PINNQUAD_DOUBLE_PACK PackNeonDouble
#endif

namespace pinnquad {

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {
template <class Scalar>
struct NativePack {
  using type = GenericPack<Scalar, 4>;
};
#if defined(PINNQUAD_FLOAT_PACK)
template <>
struct NativePack<float> {
  using type = PINNQUAD_FLOAT_PACK;
  static_assert(type::fused == fuses_float, "pinnquad: this pack and the portable kernel round a * b + c differently");
};
template <>
struct NativePack<double> {
  using type = PINNQUAD_DOUBLE_PACK;
  static_assert(type::fused == fuses_double, "pinnquad: this pack and the portable kernel round a * b + c differently");
};
#undef PINNQUAD_FLOAT_PACK
#undef PINNQUAD_DOUBLE_PACK
#endif
static_assert(NativePack<float>::type::unit == vector_unit && NativePack<double>::type::unit == vector_unit,
              "pinnquad: this pack is not of the vector unit that core/instruction_set.hpp names");
}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

/// The fastest pack that this translation unit may use.
template <class Scalar>
using NativePack = typename detail::NativePack<Scalar>::type;

inline namespace PINNQUAD_INSTRUCTION_SET {
/// True if NativePack has its own instructions.
template <class Scalar>
inline constexpr bool has_vector_unit = NativePack<Scalar>::unit != VectorUnit::none;
}  // namespace PINNQUAD_INSTRUCTION_SET

/// `size` rounded up to whole packs.
template <class Pack>
constexpr int padded(int size) noexcept {
  return (size + Pack::width - 1) / Pack::width * Pack::width;
}

}  // namespace pinnquad
