// SPDX-License-Identifier: MIT
// Every pack of floats and of doubles that this target can run: a wide machine also tests the narrow ones.
#pragma once

#include "pinnquad/nn/kernel/pack.hpp"

#if defined(__AVX512F__)
#include "pinnquad/nn/kernel/pack_avx512.hpp"
#endif
#if defined(__SSE2__)
#include "pinnquad/nn/kernel/pack_sse2.hpp"
#endif
#if defined(__AVX2__) && defined(__FMA__)
#include "pinnquad/nn/kernel/pack_avx2.hpp"
#endif

/// Lists for TEST_CASE_TEMPLATE, which takes no list type of its own here: packs of floats, and of doubles.
#if defined(__AVX512F__)
#define PINNQUAD_TEST_REGISTER_PACKS \
  pinnquad::detail::PackAvx512, pinnquad::detail::PackAvx2, pinnquad::detail::PackSse2
#define PINNQUAD_TEST_DOUBLE_PACKS \
  pinnquad::detail::PackAvx512Double, pinnquad::detail::PackAvx2Double, pinnquad::detail::PackSse2Double
#elif defined(__AVX2__) && defined(__FMA__)
#define PINNQUAD_TEST_REGISTER_PACKS pinnquad::detail::PackAvx2, pinnquad::detail::PackSse2
#define PINNQUAD_TEST_DOUBLE_PACKS pinnquad::detail::PackAvx2Double, pinnquad::detail::PackSse2Double
#else
#define PINNQUAD_TEST_REGISTER_PACKS pinnquad::NativePack<float>
#define PINNQUAD_TEST_DOUBLE_PACKS pinnquad::NativePack<double>
#endif
