// SPDX-License-Identifier: MIT
#include "pinnquad/schedule/schedule.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <stdexcept>

#include "pinnquad/schedule/constant.hpp"
#include "pinnquad/schedule/cyclical_annealing.hpp"

using pinnquad::Constant;
using pinnquad::CyclicalAnnealing;
using pinnquad::is_schedule;

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
