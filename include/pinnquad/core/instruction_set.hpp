// SPDX-License-Identifier: MIT
// What the compiler may emit in this translation unit, decided here and nowhere else: the vector unit that kernels use, whether
// a product and a sum are rounded once, and a name for all of it. The name is that of an inline namespace: prediction code that
// can be emitted out of line lives in it, so that the linker never takes a copy compiled for another machine or for another
// arithmetic.
//   namespace pinnquad { inline namespace PINNQUAD_INSTRUCTION_SET { ... } }
// A new instruction set: a branch below, a value of VectorUnit, a pack (nn/kernel/pack_contract.hpp) and a line in
// nn/kernel/pack.hpp, which asserts that the three agree.
#pragma once

#include <string_view>

// For x86 and Arm: a family, then a letter for each extension that a compiler uses in code without intrinsics, then
// "fast_math" where it was told that there is no NaN: sse2_, avx2_7812lpm65s3fast_math. Equal names: what one unit was
// compiled for runs in the other.
#if defined(__AVX512F__)
#define PINNQUAD_SET_FAMILY avx512_
#define PINNQUAD_UNIT_AVX512
#elif defined(__AVX2__) && defined(__FMA__)
#define PINNQUAD_SET_FAMILY avx2_
#define PINNQUAD_UNIT_AVX2
#elif defined(__ARM_NEON) && defined(__aarch64__)
#define PINNQUAD_SET_FAMILY neon_
#define PINNQUAD_UNIT_NEON
#elif defined(__FP_FAST_FMAF) || defined(__FMA__) || defined(__FMA4__) || defined(__ARM_FEATURE_FMA)
#define PINNQUAD_SET_FAMILY portable_fma_
#elif defined(__AVX__)
#define PINNQUAD_SET_FAMILY avx_
#elif defined(__SSE4_1__)
#define PINNQUAD_SET_FAMILY sse4_
#elif defined(__SSE2__)
#define PINNQUAD_SET_FAMILY sse2_
#else
#define PINNQUAD_SET_FAMILY portable_
#endif
// every x86-64 without one of the above
#if defined(__SSE2__) && !defined(PINNQUAD_UNIT_AVX512) && !defined(PINNQUAD_UNIT_AVX2)
#define PINNQUAD_UNIT_SSE2
#endif

// x86
#if defined(__AVX512VL__)
#define PINNQUAD_SET_VL v
#else
#define PINNQUAD_SET_VL
#endif
#if defined(__AVX512DQ__)
#define PINNQUAD_SET_DQ q
#else
#define PINNQUAD_SET_DQ
#endif
#if defined(__AVX512BW__)
#define PINNQUAD_SET_BW w
#else
#define PINNQUAD_SET_BW
#endif
#if defined(__AVX512CD__)
#define PINNQUAD_SET_CD c
#else
#define PINNQUAD_SET_CD
#endif
#if defined(__AVX512IFMA__)
#define PINNQUAD_SET_IFMA i
#else
#define PINNQUAD_SET_IFMA
#endif
#if defined(__AVX512VBMI__)
#define PINNQUAD_SET_VBMI b
#else
#define PINNQUAD_SET_VBMI
#endif
#if defined(__AVX512VBMI2__)
#define PINNQUAD_SET_VBMI2 d
#else
#define PINNQUAD_SET_VBMI2
#endif
#if defined(__AVX512VNNI__)
#define PINNQUAD_SET_VNNI n
#else
#define PINNQUAD_SET_VNNI
#endif
#if defined(__AVX512BITALG__)
#define PINNQUAD_SET_BITALG g
#else
#define PINNQUAD_SET_BITALG
#endif
#if defined(__AVX512VPOPCNTDQ__)
#define PINNQUAD_SET_VPOPCNTDQ t
#else
#define PINNQUAD_SET_VPOPCNTDQ
#endif
#if defined(__AVX512BF16__)
#define PINNQUAD_SET_BF16 o
#else
#define PINNQUAD_SET_BF16
#endif
#if defined(__AVX512FP16__)
#define PINNQUAD_SET_FP16 h
#else
#define PINNQUAD_SET_FP16
#endif
#if defined(__AVX2__)
#define PINNQUAD_SET_AVX2 7
#else
#define PINNQUAD_SET_AVX2
#endif
#if defined(__FMA__)
#define PINNQUAD_SET_FMA 8
#else
#define PINNQUAD_SET_FMA
#endif
#if defined(__APX_F__)
#define PINNQUAD_SET_APX a
#else
#define PINNQUAD_SET_APX
#endif
#if defined(__AVXVNNI__)
#define PINNQUAD_SET_AVXVNNI y
#else
#define PINNQUAD_SET_AVXVNNI
#endif
#if defined(__GFNI__)
#define PINNQUAD_SET_GFNI f
#else
#define PINNQUAD_SET_GFNI
#endif
#if defined(__BMI__)
#define PINNQUAD_SET_BMI 1
#else
#define PINNQUAD_SET_BMI
#endif
#if defined(__BMI2__)
#define PINNQUAD_SET_BMI2 2
#else
#define PINNQUAD_SET_BMI2
#endif
#if defined(__LZCNT__)
#define PINNQUAD_SET_LZCNT l
#else
#define PINNQUAD_SET_LZCNT
#endif
#if defined(__POPCNT__)
#define PINNQUAD_SET_POPCNT p
#else
#define PINNQUAD_SET_POPCNT
#endif
#if defined(__MOVBE__)
#define PINNQUAD_SET_MOVBE m
#else
#define PINNQUAD_SET_MOVBE
#endif
#if defined(__F16C__)
#define PINNQUAD_SET_F16C 6
#else
#define PINNQUAD_SET_F16C
#endif
#if defined(__SSE4_2__)
#define PINNQUAD_SET_SSE4_2 5
#else
#define PINNQUAD_SET_SSE4_2
#endif
#if defined(__SSSE3__)
#define PINNQUAD_SET_SSSE3 s
#else
#define PINNQUAD_SET_SSSE3
#endif
#if defined(__SSE3__)
#define PINNQUAD_SET_SSE3 3
#else
#define PINNQUAD_SET_SSE3
#endif
#if defined(__FMA4__)
#define PINNQUAD_SET_FMA4 4
#else
#define PINNQUAD_SET_FMA4
#endif
#if defined(__XOP__)
#define PINNQUAD_SET_XOP k
#else
#define PINNQUAD_SET_XOP
#endif
#if defined(__SSE4A__)
#define PINNQUAD_SET_SSE4A e
#else
#define PINNQUAD_SET_SSE4A
#endif
#if defined(__TBM__)
#define PINNQUAD_SET_TBM u
#else
#define PINNQUAD_SET_TBM
#endif

// Arm
#if defined(__ARM_FEATURE_SVE)
#define PINNQUAD_SET_SVE S
#else
#define PINNQUAD_SET_SVE
#endif
#if defined(__ARM_FEATURE_SVE2)
#define PINNQUAD_SET_SVE2 T
#else
#define PINNQUAD_SET_SVE2
#endif
#if defined(__ARM_FEATURE_FP16_VECTOR_ARITHMETIC)
#define PINNQUAD_SET_HALF H
#else
#define PINNQUAD_SET_HALF
#endif
#if defined(__ARM_FEATURE_DOTPROD)
#define PINNQUAD_SET_DOTPROD D
#else
#define PINNQUAD_SET_DOTPROD
#endif
#if defined(__ARM_FEATURE_MATMUL_INT8)
#define PINNQUAD_SET_I8MM I
#else
#define PINNQUAD_SET_I8MM
#endif
#if defined(__ARM_FEATURE_FRINT)
#define PINNQUAD_SET_FRINT F
#else
#define PINNQUAD_SET_FRINT
#endif
#if defined(__ARM_FEATURE_JCVT)
#define PINNQUAD_SET_JCVT J
#else
#define PINNQUAD_SET_JCVT
#endif
#if defined(__ARM_FEATURE_ATOMICS)
#define PINNQUAD_SET_LSE L
#else
#define PINNQUAD_SET_LSE
#endif
#if defined(__ARM_NEON)
#define PINNQUAD_SET_NEON N
#else
#define PINNQUAD_SET_NEON
#endif
#if defined(__ARM_FEATURE_NUMERIC_MAXMIN)
#define PINNQUAD_SET_MAXMIN M
#else
#define PINNQUAD_SET_MAXMIN
#endif
#if defined(__ARM_FEATURE_IDIV)
#define PINNQUAD_SET_IDIV V
#else
#define PINNQUAD_SET_IDIV
#endif
#if defined(__ARM_FP) && (__ARM_FP & 8)
#define PINNQUAD_SET_DOUBLE W
#else
#define PINNQUAD_SET_DOUBLE
#endif

// arithmetic
#if __FINITE_MATH_ONLY__
#define PINNQUAD_SET_MATH fast_math
#else
#define PINNQUAD_SET_MATH
#endif

#define PINNQUAD_SET_PASTE(a, b, c, d, e, f, g) a##b##c##d##e##f##g
#define PINNQUAD_SET_JOIN(a, b, c, d, e, f, g) PINNQUAD_SET_PASTE(a, b, c, d, e, f, g)
#define PINNQUAD_SET_1                                                                                     \
  PINNQUAD_SET_JOIN(PINNQUAD_SET_VL, PINNQUAD_SET_DQ, PINNQUAD_SET_BW, PINNQUAD_SET_CD, PINNQUAD_SET_IFMA, \
                    PINNQUAD_SET_VBMI, PINNQUAD_SET_VBMI2)
#define PINNQUAD_SET_2                                                                                 \
  PINNQUAD_SET_JOIN(PINNQUAD_SET_VNNI, PINNQUAD_SET_BITALG, PINNQUAD_SET_VPOPCNTDQ, PINNQUAD_SET_BF16, \
                    PINNQUAD_SET_FP16, PINNQUAD_SET_AVX2, PINNQUAD_SET_FMA)
#define PINNQUAD_SET_3                                                                                              \
  PINNQUAD_SET_JOIN(PINNQUAD_SET_APX, PINNQUAD_SET_AVXVNNI, PINNQUAD_SET_GFNI, PINNQUAD_SET_BMI, PINNQUAD_SET_BMI2, \
                    PINNQUAD_SET_LZCNT, PINNQUAD_SET_POPCNT)
#define PINNQUAD_SET_4                                                                                                 \
  PINNQUAD_SET_JOIN(PINNQUAD_SET_MOVBE, PINNQUAD_SET_F16C, PINNQUAD_SET_SSE4_2, PINNQUAD_SET_SSSE3, PINNQUAD_SET_SSE3, \
                    PINNQUAD_SET_FMA4, PINNQUAD_SET_XOP)
#define PINNQUAD_SET_5                                                                                            \
  PINNQUAD_SET_JOIN(PINNQUAD_SET_SSE4A, PINNQUAD_SET_TBM, PINNQUAD_SET_SVE, PINNQUAD_SET_SVE2, PINNQUAD_SET_HALF, \
                    PINNQUAD_SET_DOTPROD, PINNQUAD_SET_I8MM)
#define PINNQUAD_SET_6                                                                                               \
  PINNQUAD_SET_JOIN(PINNQUAD_SET_FRINT, PINNQUAD_SET_JCVT, PINNQUAD_SET_LSE, PINNQUAD_SET_NEON, PINNQUAD_SET_MAXMIN, \
                    PINNQUAD_SET_IDIV, PINNQUAD_SET_DOUBLE)
#define PINNQUAD_SET_PASTE_2(a, b) a##b
#define PINNQUAD_SET_JOIN_2(a, b) PINNQUAD_SET_PASTE_2(a, b)
#define PINNQUAD_SET_7 PINNQUAD_SET_JOIN_2(PINNQUAD_SET_6, PINNQUAD_SET_MATH)
#define PINNQUAD_INSTRUCTION_SET                                                                         \
  PINNQUAD_SET_JOIN(PINNQUAD_SET_FAMILY, PINNQUAD_SET_1, PINNQUAD_SET_2, PINNQUAD_SET_3, PINNQUAD_SET_4, \
                    PINNQUAD_SET_5, PINNQUAD_SET_7)

namespace pinnquad {

/// What kernels of float compute with.
enum class VectorUnit { none, sse2, avx2, avx512, neon };

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

#if defined(PINNQUAD_UNIT_AVX512)
inline constexpr VectorUnit vector_unit = VectorUnit::avx512;
#elif defined(PINNQUAD_UNIT_AVX2)
inline constexpr VectorUnit vector_unit = VectorUnit::avx2;
#elif defined(PINNQUAD_UNIT_SSE2)
inline constexpr VectorUnit vector_unit = VectorUnit::sse2;
#elif defined(PINNQUAD_UNIT_NEON)
inline constexpr VectorUnit vector_unit = VectorUnit::neon;
#else
inline constexpr VectorUnit vector_unit = VectorUnit::none;
#endif

/// True where the hardware rounds a * b + c once. Elsewhere it would take a library call, and is rounded twice.
#if defined(__FP_FAST_FMAF) || defined(__FMA__) || defined(__FMA4__) || defined(__ARM_FEATURE_FMA) || \
    defined(__AVX512F__)
inline constexpr bool fuses_float = true;
#else
inline constexpr bool fuses_float = false;
#endif
#if defined(__FP_FAST_FMA) || defined(__FMA__) || (defined(__ARM_FEATURE_FMA) && defined(__aarch64__))
inline constexpr bool fuses_double = true;
#else
inline constexpr bool fuses_double = false;
#endif

#define PINNQUAD_SET_TEXT_OF(name) #name
#define PINNQUAD_SET_TEXT(name) PINNQUAD_SET_TEXT_OF(name)
/// PINNQUAD_INSTRUCTION_SET as text.
inline constexpr std::string_view instruction_set = PINNQUAD_SET_TEXT(PINNQUAD_INSTRUCTION_SET);
#undef PINNQUAD_SET_TEXT
#undef PINNQUAD_SET_TEXT_OF

constexpr bool named(std::string_view family) noexcept { return instruction_set.substr(0, family.size()) == family; }
static_assert(named("avx512_") == (vector_unit == VectorUnit::avx512) &&
                  named("avx2_") == (vector_unit == VectorUnit::avx2) &&
                  named("neon_") == (vector_unit == VectorUnit::neon) &&
                  (!named("sse2_") || vector_unit == VectorUnit::sse2),
              "pinnquad: the instruction set's name is not that of the vector unit");
static_assert(fuses_float == (named("avx512_") || named("avx2_") || named("neon_") || named("portable_fma_")),
              "pinnquad: the instruction set's name does not say whether products and sums are rounded once");

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail
}  // namespace pinnquad
