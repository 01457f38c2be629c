// SPDX-License-Identifier: MIT
// The instruction set that this translation unit is compiled for, as the name of an inline namespace: prediction code that
// can be emitted out of line lives in it, so that the linker never takes a copy compiled for another machine.
//   namespace pinnquad { inline namespace PINNQUAD_INSTRUCTION_SET { ... } }
#pragma once

#if defined(__AVX512F__)
#define PINNQUAD_INSTRUCTION_SET avx512
#elif defined(__AVX2__) && defined(__FMA__)
#define PINNQUAD_INSTRUCTION_SET avx2
#elif defined(__ARM_NEON) && defined(__aarch64__)
#define PINNQUAD_INSTRUCTION_SET neon
#elif defined(__FMA__) || defined(__ARM_FEATURE_FMA)
#define PINNQUAD_INSTRUCTION_SET portable_fma
#elif defined(__AVX__)
#define PINNQUAD_INSTRUCTION_SET avx
#elif defined(__SSE4_1__)
#define PINNQUAD_INSTRUCTION_SET sse4
#elif defined(__SSE2__)
#define PINNQUAD_INSTRUCTION_SET sse2
#else
#define PINNQUAD_INSTRUCTION_SET portable
#endif
