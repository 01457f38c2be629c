// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <limits>

#include "core/finite_fast_math.hpp"

TEST_CASE_TEMPLATE("is_finite holds under fast-math", Scalar, float, double) {
  using Limits = std::numeric_limits<Scalar>;
  using namespace pinnquad::test;
  if (!fast_math_naive_is_number(std::numeric_limits<double>::quiet_NaN())) {
    MESSAGE("the optimiser is off: fast-math changed nothing in this build");
  }
  volatile Scalar values[] = {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()};
  for (const volatile Scalar& value : values) {
    const Scalar bad = value;
    CHECK_FALSE(fast_math_is_finite(bad));
    Scalar row[3] = {Scalar(1), bad, Scalar(2)};
    CHECK_FALSE(fast_math_all_finite(row, 3));
    row[1] = Scalar(0);
    CHECK(fast_math_all_finite(row, 3));
  }
  CHECK(fast_math_is_finite(Limits::max()));
  CHECK(fast_math_is_finite(Limits::denorm_min()));
}
