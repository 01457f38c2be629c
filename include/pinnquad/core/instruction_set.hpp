// SPDX-License-Identifier: MIT
// The instruction set of this translation unit, decided here alone: the vector unit of kernels, whether a product and a
// sum are rounded once, whether the compiler may assume that there is no NaN, and a name for all three. The name is
// that of an inline namespace around what predicts. A program may link objects of other flags, such as a library built
// for any machine: the linker then never takes their layout of weights, rounding or tests for NaN for ours.
//   namespace pinnquad { inline namespace PINNQUAD_INSTRUCTION_SET { ... } }
// A new instruction set: a branch below, a value of VectorUnit, a pack (nn/kernel/pack_contract.hpp) and a line in
// nn/kernel/pack.hpp, which asserts that the unit and the rounding are the pack's.
#pragma once

#include <string_view>

// Bits of the registers that kernels take of AVX-512's; lanes of vehicles take 512. Zen 4 works 512 bits as two halves:
// predictions and training are faster by 256 (docs/benchmarks.md). Compilers before it take it for a Zen 3 with
// AVX-512. -DPINNQUAD_KERNEL_BITS=256 or 512 chooses otherwise.
#if !defined(PINNQUAD_KERNEL_BITS)
#if defined(__znver4__) || defined(__znver3__)
#define PINNQUAD_KERNEL_BITS 256
#else
#define PINNQUAD_KERNEL_BITS 512
#endif
#endif

#if defined(__AVX512F__)
#define PINNQUAD_UNIT_AVX512
#if PINNQUAD_KERNEL_BITS == 512
#define PINNQUAD_SET_UNIT avx512_
#else
#define PINNQUAD_SET_UNIT avx512_by_256_
#endif
#elif defined(__AVX2__) && defined(__FMA__)
#define PINNQUAD_UNIT_AVX2
#define PINNQUAD_SET_UNIT avx2_
#elif defined(__SSE2__)
#define PINNQUAD_UNIT_SSE2
#define PINNQUAD_SET_UNIT sse2_
#elif defined(__ARM_NEON) && defined(__aarch64__)
#define PINNQUAD_UNIT_NEON
#define PINNQUAD_SET_UNIT neon_
#else
#define PINNQUAD_SET_UNIT portable_
#endif

#if defined(__FP_FAST_FMAF) || defined(__FMA__) || defined(__FMA4__) || defined(__ARM_FEATURE_FMA) || \
    defined(__AVX512F__)
#define PINNQUAD_FUSES_FLOAT true
#define PINNQUAD_SET_ROUNDING fma_
#else
#define PINNQUAD_FUSES_FLOAT false
#define PINNQUAD_SET_ROUNDING
#endif

#if defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
#define PINNQUAD_SET_MATH fast_math_
#else
#define PINNQUAD_SET_MATH
#endif

// The name is put together where it is used, so these helpers stay defined: sse2_, avx2_fma_, neon_fma_fast_math_.
#define PINNQUAD_SET_PASTE(unit, rounding, math) unit##rounding##math
#define PINNQUAD_SET_JOIN(unit, rounding, math) PINNQUAD_SET_PASTE(unit, rounding, math)
#define PINNQUAD_INSTRUCTION_SET PINNQUAD_SET_JOIN(PINNQUAD_SET_UNIT, PINNQUAD_SET_ROUNDING, PINNQUAD_SET_MATH)

namespace pinnquad {

/// The registers that kernels of float and double compute in.
enum class VectorUnit { none, sse2, avx2, avx512, neon };

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

inline constexpr VectorUnit vector_unit =
#if defined(PINNQUAD_UNIT_AVX512) && PINNQUAD_KERNEL_BITS == 512
    VectorUnit::avx512;
#elif defined(PINNQUAD_UNIT_AVX512) || defined(PINNQUAD_UNIT_AVX2)
    VectorUnit::avx2;
#elif defined(PINNQUAD_UNIT_SSE2)
    VectorUnit::sse2;
#elif defined(PINNQUAD_UNIT_NEON)
    VectorUnit::neon;
#else
    VectorUnit::none;
#endif

/// AVX-512 has 32 registers of any width.
inline constexpr bool has_32_registers =
#if defined(PINNQUAD_UNIT_AVX512)
    true;
#else
    false;
#endif

/// True where the hardware rounds a * b + c once. Elsewhere it would take a library call, and is rounded twice.
inline constexpr bool fuses_float = PINNQUAD_FUSES_FLOAT;
inline constexpr bool fuses_double =
#if defined(__FP_FAST_FMA) || defined(__FMA__) || defined(__FMA4__) || defined(__AVX512F__) || \
    (defined(__ARM_FEATURE_FMA) && defined(__aarch64__))
    true;
#else
    false;
#endif
#undef PINNQUAD_FUSES_FLOAT

#define PINNQUAD_SET_TEXT_OF(name) #name
#define PINNQUAD_SET_TEXT(name) PINNQUAD_SET_TEXT_OF(name)
/// PINNQUAD_INSTRUCTION_SET as text.
inline constexpr std::string_view instruction_set = PINNQUAD_SET_TEXT(PINNQUAD_INSTRUCTION_SET);
#undef PINNQUAD_SET_TEXT
#undef PINNQUAD_SET_TEXT_OF

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail
}  // namespace pinnquad
