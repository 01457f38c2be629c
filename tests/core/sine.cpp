// SPDX-License-Identifier: MIT
#include "pinnquad/core/scalar_math.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "support/tolerances.hpp"

using pinnquad::cosine_of_turns;
using pinnquad::sine_of_turns;

TEST_CASE_TEMPLATE("against libm, over many turns both ways", Scalar, float, double) {
  const long double two_pi = 6.283185307179586476925286766559L;
  for (int i = -40000; i <= 40000; ++i) {
    const Scalar turns = Scalar(i) * Scalar(0.00037);
    const auto whole = std::floor(static_cast<long double>(turns));
    const long double angle_rad = two_pi * (static_cast<long double>(turns) - whole);
    const auto expected = static_cast<double>(std::sin(angle_rad)),
               of_cosine = static_cast<double>(std::cos(angle_rad));
    CHECK(std::fabs(static_cast<double>(sine_of_turns(turns)) - expected) <= pinnquad::test::rounding<Scalar>(4));
    CHECK(std::fabs(static_cast<double>(cosine_of_turns(turns)) - of_cosine) <= pinnquad::test::rounding<Scalar>(4));
  }
}

TEST_CASE_TEMPLATE("exact where it can be: whole, half and quarter turns", Scalar, float, double) {
  for (int turn = -1000; turn <= 1000; turn += 250) {
    CHECK(sine_of_turns(Scalar(turn)) == Scalar(0));
    CHECK(cosine_of_turns(Scalar(turn)) == cosine_of_turns(Scalar(0)));
    CHECK(cosine_of_turns(Scalar(turn) + Scalar(0.25)) == Scalar(0));
    CHECK(cosine_of_turns(Scalar(turn) - Scalar(0.25)) == Scalar(0));
    CHECK(std::fabs(static_cast<double>(sine_of_turns(Scalar(turn) + Scalar(0.5)))) == 0.0);
    CHECK(static_cast<double>(sine_of_turns(Scalar(turn) + Scalar(0.25))) ==
          doctest::Approx(1.0).epsilon(pinnquad::test::rounding<Scalar>(4)));
    CHECK(static_cast<double>(sine_of_turns(Scalar(turn) - Scalar(0.25))) ==
          doctest::Approx(-1.0).epsilon(pinnquad::test::rounding<Scalar>(4)));
  }
}

TEST_CASE_TEMPLATE("what is no number stays none", Scalar, float, double) {
  CHECK(std::isnan(sine_of_turns(std::numeric_limits<Scalar>::quiet_NaN())));
  CHECK(std::isnan(sine_of_turns(std::numeric_limits<Scalar>::infinity())));
  CHECK(std::isnan(cosine_of_turns(std::numeric_limits<Scalar>::quiet_NaN())));
  CHECK(std::isnan(cosine_of_turns(std::numeric_limits<Scalar>::infinity())));
}
