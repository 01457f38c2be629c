// SPDX-License-Identifier: MIT
// How long a job still takes, by what has passed of it.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "command_line/progress_line.hpp"

using programs::PassedShare;
using programs::seconds_left;

namespace {

/// The course of a job that is at `share_at(time)` every 0.1 s, up to the first of these times with that share.
template <class ShareAt>
std::vector<PassedShare> passed_of(const ShareAt& share_at, double share) {
  std::vector<PassedShare> passed;
  for (int i = 1; passed.empty() || passed.back().share < share; ++i) passed.push_back({0.1 * i, share_at(0.1 * i)});
  return passed;
}

/// The time left as it is given, over that which comes, of a job of 100 s.
template <class ShareAt>
double given_over_came(const ShareAt& share_at, double share) {
  const std::vector<PassedShare> passed = passed_of(share_at, share);
  const auto left_s = seconds_left(passed);
  REQUIRE(left_s.has_value());
  return *left_s / (100 - passed.back().time_s);
}

}  // namespace

TEST_CASE("the time left is right within a factor of two at a quarter and a half of the job") {
  const auto steady = [](double t) { return t / 100; };
  const auto in_four_pieces = [](double t) { return std::floor(t / 25 + 1e-9) / 4; };
  const auto two_at_a_time = [](double t) { return t < 50 ? 0.0 : t < 100 ? 0.5 : 1.0; };
  const auto slow_begin = [](double t) { return t < 30 ? t / 150 : 0.2 + (t - 30) / 70 * 0.8; };
  const auto slow_end = [](double t) { return t < 40 ? t / 40 * 0.6 : 0.6 + (t - 40) / 60 * 0.4; };
  for (const double share : {0.25, 0.5}) {
    CHECK(given_over_came(steady, share) == doctest::Approx(1).epsilon(0.01));
    for (const double ratio : {given_over_came(in_four_pieces, share), given_over_came(two_at_a_time, share),
                               given_over_came(slow_begin, share)}) {
      CHECK(ratio > 0.5);
      CHECK(ratio < 2);
    }
  }
  CHECK(given_over_came(slow_end, 0.9) > 0.5);
}

TEST_CASE("no time left is given before enough is done to know") {
  CHECK_FALSE(seconds_left({{5, 0.02}}).has_value());
  CHECK_FALSE(seconds_left({{0, 0.5}}).has_value());
  CHECK(*seconds_left({{1, 0.5}, {9, 0.5}}) == doctest::Approx(9));  // nothing moved for long: the speed so far
}
