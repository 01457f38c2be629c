// SPDX-License-Identifier: MIT
// Every pack of floats that this target can run: a wide machine also tests the narrow ones.
#pragma once

#include "pinnquad/nn/kernel/pack.hpp"

#if defined(__SSE2__)
#include "pinnquad/nn/kernel/pack_sse2.hpp"
#endif
#if defined(__AVX2__) && defined(__FMA__)
#include "pinnquad/nn/kernel/pack_avx2.hpp"
#endif

/// A list for TEST_CASE_TEMPLATE, which takes no list type of its own here.
#if defined(__AVX512F__)
#define PINNQUAD_TEST_REGISTER_PACKS \
  pinnquad::detail::PackAvx512, pinnquad::detail::PackAvx2, pinnquad::detail::PackSse2
#elif defined(__AVX2__) && defined(__FMA__)
#define PINNQUAD_TEST_REGISTER_PACKS pinnquad::detail::PackAvx2, pinnquad::detail::PackSse2
#else
#define PINNQUAD_TEST_REGISTER_PACKS pinnquad::NativePack<float>
#endif
