// SPDX-License-Identifier: MIT
#include "pinnquad/schedule/rate.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "pinnquad/schedule/constant_rate.hpp"
#include "pinnquad/schedule/cosine_decay.hpp"
#include "support/tolerances.hpp"

using pinnquad::ConstantRate;
using pinnquad::CosineDecay;
using pinnquad::is_rate;
using pinnquad::test::rounding;

namespace {
struct MayThrow {
  double factor(double) const { return 1.0; }
};
}  // namespace

TEST_CASE("what is a rate") {
  CHECK(is_rate<ConstantRate>);
  CHECK(is_rate<CosineDecay>);
  CHECK_FALSE(is_rate<int>);
  CHECK_FALSE(is_rate<MayThrow>);  // the contract says noexcept
}

TEST_CASE("the constant rate is 1") {
  for (const double done : {0.0, 0.3, 1.0}) CHECK(ConstantRate{}.factor(done) == 1.0);
}

TEST_CASE("cosine: 1 at the start, one half in the middle, 0 at the end, falling all the way") {
  const CosineDecay rate{};
  CHECK(rate.factor(0.0) == 1.0);
  CHECK(rate.factor(1.0) <= rounding<double>(1));
  CHECK(rate.factor(0.5) == doctest::Approx(0.5));
  CHECK(rate.factor(1.0 / 3.0) == doctest::Approx(0.75));  // cos 60 degrees = 1/2
  for (int t = 0; t < 100; ++t) {
    CHECK(rate.factor((t + 1) / 100.0) < rate.factor(t / 100.0));
    CHECK(rate.factor(t / 100.0) + rate.factor(1.0 - t / 100.0) == doctest::Approx(1.0));  // point symmetry
  }
}
