// SPDX-License-Identifier: MIT
// Eq. (6), with the reading of docs/paper.md, deviation 11.
#include "pinnquad/schedule/schedule.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string>

using pinnquad::CyclicalAnnealing;

namespace {

/// Two divisions and a product: a few ulp of 0.1.
constexpr double schedule_tolerance = 1e-16;

}  // namespace

TEST_CASE("Fig. 3: M = 5, R = 0.5, lambda_max = 0.1, T = 300") {
  constexpr CyclicalAnnealing schedule{};  // the paper's values are the defaults
  for (int cycle = 0; cycle < 5; ++cycle) {
    const int start = 60 * cycle;  // period 60, starts anew
    CAPTURE(cycle);
    for (int k = 0; k <= 30; ++k) CHECK(schedule.weight(start + k, 300) == 0.1);
    for (int k = 31; k < 60; ++k) {
      CHECK(std::fabs(schedule.weight(start + k, 300) - 0.1 * (60 - k) / 30.0) <= schedule_tolerance);
    }
    // never 0: lambda_max / (P (1 - R)) in the last epoch
    CHECK(std::fabs(schedule.weight(start + 59, 300) - 0.1 / (60 * 0.5)) <= schedule_tolerance);
  }
  static_assert(schedule.weight(0, 300) == 0.1, "usable at compile time");
}

TEST_CASE("the fall is linear and meets the hold without a jump larger than its step") {
  for (const double hold : {0.0, 0.25, 0.5, 0.8}) {
    const CyclicalAnnealing schedule{2.0, 1, hold};
    const double step = 2.0 / (100 * (1.0 - hold));
    for (int k = 1; k < 100; ++k) {
      CAPTURE(hold);
      CAPTURE(k);
      const double fall = schedule.weight(k - 1, 100) - schedule.weight(k, 100);
      if (k <= 100 * hold) {
        CHECK(fall == 0.0);
      } else {
        CHECK(std::fabs(fall - step) <= 20 * schedule_tolerance);  // the maximum is twenty times the paper's
      }
    }
  }
}

TEST_CASE("R = 1 is constant") {
  const CyclicalAnnealing schedule{0.1, 3, 1.0};
  for (int k = 0; k < 100; ++k) CHECK(schedule.weight(k, 100) == 0.1);
}

TEST_CASE("cycles that do not divide the epochs: P is rounded up, the last cycle is cut short") {
  const CyclicalAnnealing schedule{0.1, 3, 0.5};  // T = 7: P = ceil(7 / 3) = 3
  const double expected[7] = {0.1, 0.1, 0.1 / 1.5, 0.1, 0.1, 0.1 / 1.5, 0.1};
  for (int k = 0; k < 7; ++k) CHECK(std::fabs(schedule.weight(k, 7) - expected[k]) <= schedule_tolerance);
}

TEST_CASE("as many cycles as epochs, or more: every epoch starts a cycle") {
  for (const int cycles : {4, 5, 100}) {
    const CyclicalAnnealing schedule{0.1, cycles, 0.5};
    for (int k = 0; k < 4; ++k) CHECK(schedule.weight(k, 4) == 0.1);
  }
}

TEST_CASE("numbers that make no annealing are refused in one line; at compile time, too, they are no constant") {
  const auto complaint = [](const CyclicalAnnealing& schedule) -> std::string {
    try {
      schedule.check();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  constexpr CyclicalAnnealing paper{};
  static_assert((paper.check(), true), "usable at compile time");
  CHECK(complaint({0.0, 1, 0.0}) == "accepted");
  CHECK(complaint({0.1, 5, 1.0}) == "accepted");
  CHECK(complaint({0.1, 0, 0.5}) == "CyclicalAnnealing::cycles: expected a number from 1, found 0");
  CHECK(complaint({0.1, -3, 0.5}) == "CyclicalAnnealing::cycles: expected a number from 1, found -3");
  CHECK(complaint({nan, 5, 0.5}) == "CyclicalAnnealing::maximum: expected a finite number from 0, found nan");
  CHECK(complaint({infinity, 5, 0.5}) == "CyclicalAnnealing::maximum: expected a finite number from 0, found inf");
  CHECK(complaint({-0.1, 5, 0.5}) == "CyclicalAnnealing::maximum: expected a finite number from 0, found -0.1");
  CHECK(complaint({0.1, 5, 1.5}) == "CyclicalAnnealing::hold: expected a share from 0 to 1, found 1.5");
  CHECK(complaint({0.1, 5, -0.5}) == "CyclicalAnnealing::hold: expected a share from 0 to 1, found -0.5");
  CHECK(complaint({0.1, 5, nan}) == "CyclicalAnnealing::hold: expected a share from 0 to 1, found nan");
}

TEST_CASE("fewer than one cycle: NaN, no division by zero; as many as an int can hold: no overflow") {
  for (const int cycles : {0, -1, -300}) CHECK(std::isnan(CyclicalAnnealing{0.1, cycles, 0.5}.weight(7, 300)));
  CHECK(CyclicalAnnealing{0.1, std::numeric_limits<int>::max(), 0.5}.weight(7, 300) == 0.1);
}

TEST_CASE("no epochs at all: lambda_max, no division by zero") {
  // the period would be 0 for some of these
  for (const int cycles : {1, 2, 5}) {
    for (const int epochs : {0, -1, -7}) CHECK(CyclicalAnnealing{0.1, cycles, 0.5}.weight(0, epochs) == 0.1);
  }
}
