// SPDX-License-Identifier: MIT
#include "logs/savitzky_golay.hpp"

#include <doctest/doctest.h>

#include <cmath>

using pinnquad::IndexRange;
using pinnquad::logs::savitzky_golay;
using pinnquad::logs::savitzky_golay_weights;
using pinnquad::logs::SavitzkyGolay;

namespace {
void check_weights(const std::vector<double>& weights, const std::vector<double>& expected, double divisor) {
  REQUIRE(weights.size() == expected.size());
  for (std::size_t i = 0; i < weights.size(); ++i) CHECK(std::abs(weights[i] - expected[i] / divisor) < 1e-13);
}
}  // namespace

/// Savitzky and Golay (1964), tables as corrected by Steinier, Termonia and Deltour (1972).
TEST_CASE("the published weights") {
  check_weights(savitzky_golay_weights({2, 2}, 0), {-3, 12, 17, 12, -3}, 35);
  check_weights(savitzky_golay_weights({3, 2}, 0), {-3, 12, 17, 12, -3}, 35);
  check_weights(savitzky_golay_weights({2, 3}, 0), {-2, 3, 6, 7, 6, 3, -2}, 21);
  check_weights(savitzky_golay_weights({4, 4}, 0), {15, -55, 30, 135, 179, 135, 30, -55, 15}, 429);
  check_weights(savitzky_golay_weights({2, 2}, 1), {-2, -1, 0, 1, 2}, 10);
  check_weights(savitzky_golay_weights({4, 2}, 1), {1, -8, 0, 8, -1}, 12);
  check_weights(savitzky_golay_weights({4, 3}, 1), {22, -67, -58, 0, 58, 67, -22}, 252);
  check_weights(savitzky_golay_weights({2, 3}, 2), {5, 0, -3, -4, -3, 0, 5}, 42);
  check_weights(savitzky_golay_weights({4, 2}, 2), {-1, 16, -30, 16, -1}, 12);
  // off the centre: the ends of five points under a parabola
  check_weights(savitzky_golay_weights({2, 2}, 0, 2), {3, -5, -3, 9, 31}, 35);
  check_weights(savitzky_golay_weights({2, 2}, 0, 1), {-5, 6, 12, 13, 9}, 35);
  check_weights(savitzky_golay_weights({2, 2}, 1, -2), {-54, 13, 40, 27, -26}, 70);
}

TEST_CASE("a polynomial of the order comes back exactly, with its derivatives, to the last row of both ends") {
  const double period_s = 0.004;
  for (const SavitzkyGolay filter :
       {SavitzkyGolay{2, 2}, SavitzkyGolay{3, 5}, SavitzkyGolay{4, 20}, SavitzkyGolay{6, 9}}) {
    CAPTURE(filter.order);
    std::vector<double> y(101), first(101), second(101);
    for (std::size_t row = 0; row < y.size(); ++row) {
      const double t = static_cast<double>(row) * period_s - 0.2;
      for (int k = 0; k <= filter.order; ++k) {
        const double c = 1.0 + 0.5 * k;
        y[row] += c * std::pow(t * 5, k);
        if (k > 0) first[row] += c * k * 5 * std::pow(t * 5, k - 1);
        if (k > 1) second[row] += c * k * (k - 1) * 25 * std::pow(t * 5, k - 2);
      }
    }
    const auto smooth = savitzky_golay(y, period_s, filter, 0);
    const auto slope = savitzky_golay(y, period_s, filter, 1);
    const auto bend = savitzky_golay(y, period_s, filter, 2);
    for (std::size_t row = 0; row < y.size(); ++row) {
      CHECK(std::abs(smooth[row] - y[row]) < 1e-11);
      CHECK(std::abs(slope[row] - first[row]) < 1e-8);
      CHECK(std::abs(bend[row] - second[row]) < 1e-5);
    }
  }
}

TEST_CASE("wide windows of high order stay exact: weights sum to one, their noise is that of a projection") {
  for (const SavitzkyGolay filter : {SavitzkyGolay{4, 100}, SavitzkyGolay{8, 60}}) {
    for (const double position : {0.0, -1.0 * filter.half_window, 0.5 * filter.half_window}) {
      const auto h = savitzky_golay_weights(filter, 0, position);
      double sum = 0, squares = 0;
      for (const double weight : h) {
        sum += weight;
        squares += weight * weight;
      }
      CHECK(sum == doctest::Approx(1).epsilon(1e-11));
      // of a projection matrix a row's squares sum to its diagonal element
      if (position < 0) CHECK(squares == doctest::Approx(h.front()).epsilon(1e-9));
    }
  }
}

TEST_CASE("nothing is read across a gap: each side answers as if alone") {
  std::vector<double> y(60);
  for (std::size_t row = 0; row < y.size(); ++row) y[row] = std::sin(0.2 * static_cast<double>(row));
  std::vector<double> with_gap = y;
  with_gap[30] = std::nan("");
  for (std::size_t row = 31; row < 60; ++row) with_gap[row] += 100;
  const auto slope = savitzky_golay(with_gap, {{0, 30}, {31, 60}}, 0.1, {2, 4}, 1);
  const auto left = savitzky_golay(std::vector<double>(y.begin(), y.begin() + 30), 0.1, {2, 4}, 1);
  const auto right = savitzky_golay(std::vector<double>(y.begin() + 31, y.end()), 0.1, {2, 4}, 1);
  for (std::size_t row = 0; row < 30; ++row) CHECK(slope[row] == left[row]);
  CHECK(std::isnan(slope[30]));
  for (std::size_t row = 31; row < 60; ++row) CHECK(std::abs(slope[row] - right[row - 31]) < 1e-9);
}

TEST_CASE("a segment shorter than the window is fitted by what it has") {
  const std::vector<double> line = {1, 3, 5, 7};
  for (const double slope : savitzky_golay(line, 0.5, {4, 10}, 1)) CHECK(slope == doctest::Approx(4));
  const auto lone = savitzky_golay({7.0}, 0.5, {2, 3}, 1);
  REQUIRE(lone.size() == 1);
  CHECK(std::isnan(lone[0]));
  CHECK(savitzky_golay({7.0}, 0.5, {2, 3}, 0)[0] == doctest::Approx(7));
  CHECK(savitzky_golay(std::vector<double>(), 0.5, {2, 3}, 0).empty());
}

TEST_CASE("what is no filter is refused") {
  const std::vector<double> y(9, 1.0);
  CHECK_THROWS_AS(savitzky_golay(y, 0.1, {5, 2}, 0), std::invalid_argument);
  CHECK_THROWS_AS(savitzky_golay(y, 0.1, {-1, 2}, 0), std::invalid_argument);
  CHECK_THROWS_AS(savitzky_golay(y, 0.1, {2, 2}, 3), std::invalid_argument);
  CHECK_THROWS_AS(savitzky_golay(y, 0, {2, 2}, 1), std::invalid_argument);
}
