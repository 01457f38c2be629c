// SPDX-License-Identifier: MIT
#include "pinnquad/training/flush_denormals.hpp"

#include <doctest/doctest.h>

#include <limits>

using pinnquad::FlushDenormals;

namespace {

/// Half the smallest normal number, computed at run time.
float half_of_smallest() {
  volatile float smallest = std::numeric_limits<float>::min();
  volatile float half = 0.5F;
  volatile float result = smallest * half;
  return result;
}

}  // namespace

TEST_CASE("denormals are what they were, before and after") {
  CHECK(half_of_smallest() > 0.0F);
  {
    const FlushDenormals flush;
#if defined(__SSE2__) || defined(__aarch64__)
    CHECK(half_of_smallest() == 0.0F);
    {
      const FlushDenormals nested;
      CHECK(half_of_smallest() == 0.0F);
    }
    CHECK(half_of_smallest() == 0.0F);
#endif
  }
  CHECK(half_of_smallest() > 0.0F);
}
