// SPDX-License-Identifier: MIT
#include "pinnquad/schedule/schedule.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "support/tolerances.hpp"

using pinnquad::Constant;
using pinnquad::CosineDecay;
using pinnquad::CyclicalAnnealing;
using pinnquad::is_rate;
using pinnquad::is_schedule;
using pinnquad::test::rounding;

namespace {

struct Ramp {
  double weight(int epoch, int epochs) const noexcept { return static_cast<double>(epoch) / epochs; }
};
struct MayThrow {
  double weight(int, int) const { return 0.0; }
};
struct NoWeight {};
struct WrongArguments {
  double weight(const char*) const noexcept { return 0.0; }
};
struct WrongResult {
  const char* weight(int, int) const noexcept { return ""; }
};
struct ChangesItself {
  double weight(int, int) noexcept { return 0.0; }
};
struct FactorMayThrow {
  double factor(double) const { return 1.0; }
};

}  // namespace

TEST_CASE("what is a schedule") {
  CHECK(is_schedule<Constant>);
  CHECK(is_schedule<CyclicalAnnealing>);
  CHECK(is_schedule<Ramp>);
  CHECK_FALSE(is_schedule<MayThrow>);  // the contract says noexcept
  CHECK_FALSE(is_schedule<NoWeight>);
  CHECK_FALSE(is_schedule<WrongArguments>);
  CHECK_FALSE(is_schedule<WrongResult>);
  CHECK_FALSE(is_schedule<ChangesItself>);
  CHECK_FALSE(is_schedule<double>);
}

TEST_CASE_TEMPLATE("a schedule stays between 0 and its maximum, and is the same each time it is asked", Schedule,
                   Constant, CyclicalAnnealing) {
  const Schedule schedule{};
  for (const int epochs : {1, 2, 3, 7, 60, 300, 301}) {
    for (int epoch = 0; epoch < epochs; ++epoch) {
      const double weight = schedule.weight(epoch, epochs);
      CHECK(weight > 0.0);
      CHECK(weight <= 0.1);  // the default lambda_max of both
      CHECK(weight == schedule.weight(epoch, epochs));
    }
  }
}

TEST_CASE("a constant is constant") {
  constexpr Constant schedule{0.25};
  static_assert(schedule.weight(0, 10) == 0.25);
  for (int epoch = 0; epoch < 10; ++epoch) CHECK(schedule.weight(epoch, 10) == 0.25);
  CHECK(Constant{}.weight(3, 300) == 0.1);  // the paper's lambda_max
  CHECK_NOTHROW(Constant{0.0}.check());
  CHECK_THROWS_WITH_AS(Constant{std::numeric_limits<double>::quiet_NaN()}.check(),
                       "Constant::value: expected a finite number from 0, found nan", std::invalid_argument);
}

TEST_CASE("what is a rate") {
  CHECK(is_rate<CosineDecay>);
  CHECK_FALSE(is_rate<Constant>);
  CHECK_FALSE(is_rate<int>);
  CHECK_FALSE(is_rate<FactorMayThrow>);  // the contract says noexcept
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
