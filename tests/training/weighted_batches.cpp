// SPDX-License-Identifier: MIT
#include "pinnquad/training/weighted_batches.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "pinnquad/training/trainer.hpp"

using pinnquad::WeightedBatches;

TEST_CASE("a row comes as often as its weight says, to less than one") {
  const std::vector<double> weights = {1, 0.5, 3, 1, 0.1, 7, 2, 2, 1, 0.4};
  double sum = 0;
  for (const double weight : weights) sum += weight;
  const WeightedBatches batches(weights);
  std::mt19937_64 engine(3);
  std::vector<int> order(weights.size());
  std::vector<double> drawn(weights.size(), 0.0);
  constexpr int epochs = 4000;
  for (int epoch = 0; epoch < epochs; ++epoch) {
    batches.arrange(order, engine);
    REQUIRE(order.size() == weights.size());
    std::vector<int> times(weights.size(), 0);
    for (const int row : order) ++times[static_cast<std::size_t>(row)];
    for (std::size_t i = 0; i < weights.size(); ++i) {
      CHECK(std::abs(times[i] - 10 * weights[i] / sum) < 1 + 1e-9);
      drawn[i] += times[i];
    }
  }
  // a number of times is one of two neighbours: its mean's deviation is at most 0.5 / sqrt(epochs)
  for (std::size_t i = 0; i < weights.size(); ++i) {
    CHECK(std::abs(drawn[i] / epochs - 10 * weights[i] / sum) < 5 * 0.5 / std::sqrt(double(epochs)));
  }
}

namespace {
/// The largest number a draw can have.
struct Largest {
  using result_type = std::uint64_t;
  static constexpr std::uint64_t min() { return 0; }
  static constexpr std::uint64_t max() { return ~std::uint64_t{0}; }
  std::uint64_t operator()() const { return max(); }
};
}  // namespace

TEST_CASE("where the sum of weights is rounded down, what is left to draw is the last row") {
  Largest engine;
  for (std::size_t rows = 3; rows < 200; ++rows) {
    std::vector<double> weights(rows, 0.1);
    weights[0] = 0.3;
    std::vector<int> order(rows);
    WeightedBatches(weights).arrange(order, engine);
    for (const int row : order) {
      REQUIRE(row >= 0);
      REQUIRE(row < static_cast<int>(rows));
    }
  }
}

TEST_CASE("without weights, or with equal ones, the order is that of ShuffledBatches") {
  for (const WeightedBatches& batches : {WeightedBatches(), WeightedBatches({2, 2, 2, 2, 2, 2})}) {
    std::mt19937_64 engine(5), same(5);
    std::vector<int> order = {0, 1, 2, 3, 4, 5}, expected = order;
    for (int epoch = 0; epoch < 3; ++epoch) {
      batches.arrange(order, engine);
      pinnquad::ShuffledBatches{}.arrange(expected, same);
      CHECK(order == expected);
    }
  }
}

TEST_CASE("weights that are none, or of other data, are refused") {
  for (const double bad :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    CHECK_THROWS_AS(WeightedBatches({1, bad}), std::invalid_argument);
  }
  std::mt19937_64 engine(5);
  std::vector<int> order(3);
  CHECK_THROWS_AS(WeightedBatches({1, 2}).arrange(order, engine), std::invalid_argument);
}
