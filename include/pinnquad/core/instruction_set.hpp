// SPDX-License-Identifier: MIT
// The instruction set of this translation unit, decided here alone: the vector unit of kernels, whether a product and a
// sum are rounded once, and a name for all of it. The name is that of an inline namespace, for prediction code that can
// be emitted out of line: the linker then never takes a copy compiled for another machine or another arithmetic.
//   namespace pinnquad { inline namespace PINNQUAD_INSTRUCTION_SET { ... } }
// A new instruction set: a branch below, a value of VectorUnit, a pack (nn/kernel/pack_contract.hpp) and a line in
// nn/kernel/pack.hpp, which asserts that the three agree.
#pragma once

#include <string_view>

// A family, a letter for each extension that a compiler uses in code without intrinsics, "fast_math" where it may
// assume that there is no NaN: sse2_, avx2_7812lpm65s3fast_math. Units of one name may share code.
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

#if defined(__ARM_FP) && (__ARM_FP & 8)
#define PINNQUAD_SET_DOUBLE 1
#endif

// The name is put together where it is used, so these helpers stay defined. PINNQUAD_SET_LETTER(flag, letter) is the
// letter where the compiler defines the flag as 1, and nothing elsewhere.
#define PINNQUAD_SET_GIVEN_1 ,
#define PINNQUAD_SET_SECOND(first, second, ...) second
#define PINNQUAD_SET_CHOOSE(...) PINNQUAD_SET_SECOND(__VA_ARGS__)
#define PINNQUAD_SET_LETTER_OF(flag, letter) PINNQUAD_SET_CHOOSE(PINNQUAD_SET_GIVEN_##flag letter, , )
#define PINNQUAD_SET_LETTER(flag, letter) PINNQUAD_SET_LETTER_OF(flag, letter)
#define PINNQUAD_SET_PASTE(a, b, c, d, e, f, g) a##b##c##d##e##f##g
#define PINNQUAD_SET_JOIN(a, b, c, d, e, f, g) PINNQUAD_SET_PASTE(a, b, c, d, e, f, g)
// clang-format off
#define PINNQUAD_INSTRUCTION_SET                                                                                   \
  PINNQUAD_SET_JOIN(PINNQUAD_SET_FAMILY,                                                                           \
    PINNQUAD_SET_JOIN(PINNQUAD_SET_LETTER(__AVX512VL__, v), PINNQUAD_SET_LETTER(__AVX512DQ__, q),                  \
      PINNQUAD_SET_LETTER(__AVX512BW__, w), PINNQUAD_SET_LETTER(__AVX512CD__, c),                                  \
      PINNQUAD_SET_LETTER(__AVX512IFMA__, i), PINNQUAD_SET_LETTER(__AVX512VBMI__, b),                              \
      PINNQUAD_SET_LETTER(__AVX512VBMI2__, d)),                                                                    \
    PINNQUAD_SET_JOIN(PINNQUAD_SET_LETTER(__AVX512VNNI__, n), PINNQUAD_SET_LETTER(__AVX512BITALG__, g),            \
      PINNQUAD_SET_LETTER(__AVX512VPOPCNTDQ__, t), PINNQUAD_SET_LETTER(__AVX512BF16__, o),                         \
      PINNQUAD_SET_LETTER(__AVX512FP16__, h), PINNQUAD_SET_LETTER(__AVX2__, 7), PINNQUAD_SET_LETTER(__FMA__, 8)),  \
    PINNQUAD_SET_JOIN(PINNQUAD_SET_LETTER(__APX_F__, a), PINNQUAD_SET_LETTER(__AVXVNNI__, y),                      \
      PINNQUAD_SET_LETTER(__GFNI__, f), PINNQUAD_SET_LETTER(__BMI__, 1), PINNQUAD_SET_LETTER(__BMI2__, 2),         \
      PINNQUAD_SET_LETTER(__LZCNT__, l), PINNQUAD_SET_LETTER(__POPCNT__, p)),                                      \
    PINNQUAD_SET_JOIN(PINNQUAD_SET_LETTER(__MOVBE__, m), PINNQUAD_SET_LETTER(__F16C__, 6),                         \
      PINNQUAD_SET_LETTER(__SSE4_2__, 5), PINNQUAD_SET_LETTER(__SSSE3__, s), PINNQUAD_SET_LETTER(__SSE3__, 3),     \
      PINNQUAD_SET_LETTER(__FMA4__, 4), PINNQUAD_SET_LETTER(__XOP__, k)),                                          \
    PINNQUAD_SET_JOIN(PINNQUAD_SET_LETTER(__SSE4A__, e), PINNQUAD_SET_LETTER(__TBM__, u),                          \
      PINNQUAD_SET_LETTER(__ARM_FEATURE_SVE, S), PINNQUAD_SET_LETTER(__ARM_FEATURE_SVE2, T),                       \
      PINNQUAD_SET_LETTER(__ARM_FEATURE_FP16_VECTOR_ARITHMETIC, H), PINNQUAD_SET_LETTER(__ARM_FEATURE_DOTPROD, D), \
      PINNQUAD_SET_LETTER(__ARM_FEATURE_MATMUL_INT8, I)),                                                          \
    PINNQUAD_SET_JOIN(PINNQUAD_SET_JOIN(PINNQUAD_SET_LETTER(__ARM_FEATURE_FRINT, F),                               \
      PINNQUAD_SET_LETTER(__ARM_FEATURE_JCVT, J), PINNQUAD_SET_LETTER(__ARM_FEATURE_ATOMICS, L),                   \
      PINNQUAD_SET_LETTER(__ARM_NEON, N), PINNQUAD_SET_LETTER(__ARM_FEATURE_NUMERIC_MAXMIN, M),                    \
      PINNQUAD_SET_LETTER(__ARM_FEATURE_IDIV, V), PINNQUAD_SET_LETTER(PINNQUAD_SET_DOUBLE, W)),                    \
      PINNQUAD_SET_LETTER(__FINITE_MATH_ONLY__, fast_math), , , , , ))
// clang-format on

namespace pinnquad {

/// The registers that kernels of float and double compute in.
enum class VectorUnit { none, sse2, avx2, avx512, neon };

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

inline constexpr VectorUnit vector_unit =
#if defined(PINNQUAD_UNIT_AVX512)
    VectorUnit::avx512;
#elif defined(PINNQUAD_UNIT_AVX2)
    VectorUnit::avx2;
#elif defined(PINNQUAD_UNIT_SSE2)
    VectorUnit::sse2;
#elif defined(PINNQUAD_UNIT_NEON)
    VectorUnit::neon;
#else
    VectorUnit::none;
#endif

/// True where the hardware rounds a * b + c once. Elsewhere it would take a library call, and is rounded twice.
inline constexpr bool fuses_float =
#if defined(__FP_FAST_FMAF) || defined(__FMA__) || defined(__FMA4__) || defined(__ARM_FEATURE_FMA) || \
    defined(__AVX512F__)
    true;
#else
    false;
#endif
inline constexpr bool fuses_double =
#if defined(__FP_FAST_FMA) || defined(__FMA__) || defined(__FMA4__) || defined(__AVX512F__) || \
    (defined(__ARM_FEATURE_FMA) && defined(__aarch64__))
    true;
#else
    false;
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
