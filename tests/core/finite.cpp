// SPDX-License-Identifier: MIT
#include "pinnquad/core/finite.hpp"

#include <doctest/doctest.h>

#include <array>
#include <limits>
#include <random>

#include "pinnquad/core/types.hpp"
#include "support/numbers_of.hpp"
#include "support/random_states.hpp"

TEST_CASE_TEMPLATE("is_finite knows every kind of value", Scalar, float, double) {
  using Limits = std::numeric_limits<Scalar>;
  for (const Scalar value :
       {Scalar(0), -Scalar(0), Scalar(1), Limits::max(), Limits::lowest(), Limits::min(), Limits::denorm_min()}) {
    CAPTURE(value);
    CHECK(pinnquad::is_finite(value));
  }
  for (const Scalar value :
       {Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(), -Limits::quiet_NaN(), Limits::signaling_NaN()}) {
    CAPTURE(value);
    CHECK_FALSE(pinnquad::is_finite(value));
  }
}

TEST_CASE_TEMPLATE("is_finite agrees with std::isfinite on random bits", Scalar, float, double) {
  using Bits = std::conditional_t<sizeof(Scalar) == 4, std::uint32_t, std::uint64_t>;
  std::mt19937_64 engine(1);
  int not_finite = 0;
  for (int draw = 0; draw < 20000; ++draw) {
    const Bits bits = static_cast<Bits>(engine() >> (64 - 8 * sizeof(Scalar)));
    Scalar value{};
    std::memcpy(&value, &bits, sizeof value);
    if (pinnquad::is_finite(value) != std::isfinite(value)) FAIL("differs for " << value);
    not_finite += pinnquad::is_finite(value) ? 0 : 1;
  }
  // one exponent in 256 is that of NaN and Inf in float (about 78 of 20000); one in 2048 in double (about 10)
  CHECK(not_finite > 0);
}

TEST_CASE_TEMPLATE("all_finite finds the one bad entry wherever it stands", Scalar, float, double) {
  using Limits = std::numeric_limits<Scalar>;
  std::array<Scalar, 7> values{};
  pinnquad::Matrix<Scalar, 7> vector = pinnquad::Matrix<Scalar, 7>::Zero();
  CHECK(pinnquad::all_finite(values));
  CHECK(pinnquad::all_finite(vector));
  for (std::size_t place = 0; place < values.size(); ++place) {
    for (const Scalar bad : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
      values[place] = bad;
      vector[static_cast<int>(place)] = bad;
      CHECK_FALSE(pinnquad::all_finite(values));
      CHECK_FALSE(pinnquad::all_finite(vector));
      values[place] = Scalar(0);
      vector[static_cast<int>(place)] = Scalar(0);
    }
  }
  values[6] = Limits::quiet_NaN();
  CHECK(pinnquad::all_finite(values.data(), 6));
  CHECK(pinnquad::all_finite(values.data(), 0));
}

TEST_CASE_TEMPLATE("all_finite of a State looks at every component", Scalar, float, double) {
  pinnquad::test::RandomStates random(2);
  const pinnquad::State<Scalar> good = random.state<Scalar>();
  CHECK(pinnquad::all_finite(good));
  pinnquad::test::with_each_number_bad<Scalar>(
      good, [](const pinnquad::State<Scalar>& bad) { CHECK_FALSE(pinnquad::all_finite(bad)); });
}
