// SPDX-License-Identifier: MIT
// A mark for tests that fly for minutes to judge a statistic: shorter flights run the same code, and under the
// sanitizers, where code is what is tested, a flight takes twenty times as long.
#pragma once

#include <doctest/doctest.h>

#if defined(__SANITIZE_ADDRESS__)
#define PINNQUAD_FLIES_SHORT true
#elif defined(__has_feature)  // as clang says it
#if __has_feature(address_sanitizer)
#define PINNQUAD_FLIES_SHORT true
#endif
#endif
#ifndef PINNQUAD_FLIES_SHORT
#define PINNQUAD_FLIES_SHORT false
#endif

namespace pinnquad::test {

/// TEST_CASE("..." * long_flight()): skipped under the address sanitizer.
inline doctest::skip long_flight() noexcept { return doctest::skip(PINNQUAD_FLIES_SHORT); }

}  // namespace pinnquad::test
