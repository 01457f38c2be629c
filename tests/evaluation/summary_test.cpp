// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <pinnquad/evaluation/summary.hpp>
#include <vector>

using pinnquad::summarize;

TEST_CASE("mean and deviation of a textbook series") {
  const auto summary = summarize({2, 4, 4, 4, 5, 5, 7, 9});  // squares around 5 sum to 32
  CHECK(summary.count == 8);
  CHECK(summary.mean == 5);
  CHECK(summary.deviation == doctest::Approx(std::sqrt(32.0 / 7)).epsilon(1e-15));
}

TEST_CASE("a large offset costs no digits of the deviation") {
  constexpr double offset = 1e9;
  constexpr double two_pass_tolerance = 1e-6;  // the values themselves are rounded to 1e-7 at this offset
  const std::vector<double> steps = {0.1, 0.2, 0.3, 0.4};
  std::vector<double> shifted;
  for (const double step : steps) shifted.push_back(offset + step);
  CHECK(std::abs(summarize(shifted).deviation / summarize(steps).deviation - 1) < two_pass_tolerance);
}

TEST_CASE("a repeated value has deviation exactly 0 and itself as the mean") {
  for (const double value : {0.1, 1.0 / 3, -1e300, 3e-310, 1e308}) {  // ten times 1e308 overflow
    for (const std::size_t count : {std::size_t{3}, std::size_t{10}, std::size_t{997}}) {
      const auto summary = summarize(std::vector<double>(count, value));
      CHECK(summary.mean == value);
      CHECK(summary.deviation == 0);
    }
  }
}

TEST_CASE("what is undefined is NaN") {
  CHECK(std::isnan(summarize({}).mean));
  CHECK(std::isnan(summarize({}).deviation));
  CHECK(summarize({3}).mean == 3);
  CHECK(std::isnan(summarize({3}).deviation));
  CHECK(std::isnan(summarize({1, std::nan(""), 2}).mean));
}
