// SPDX-License-Identifier: MIT
// A mark for tests that fly for minutes to judge a statistic: shorter flights run the same code, and under the
// sanitizers, where code is what is tested, a flight takes twenty times as long.
#pragma once

#include <doctest/doctest.h>

namespace pinnquad::test {

/// TEST_CASE("..." * long_flight()): skipped under the address sanitizer.
inline doctest::skip long_flight() noexcept {
#if defined(__SANITIZE_ADDRESS__)
  return doctest::skip(true);
#elif defined(__has_feature)  // clang
  return doctest::skip(__has_feature(address_sanitizer));
#else
  return doctest::skip(false);
#endif
}

}  // namespace pinnquad::test
