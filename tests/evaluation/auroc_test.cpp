// SPDX-License-Identifier: MIT
#include "pinnquad/evaluation/summary.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "pinnquad/core/random.hpp"

using namespace pinnquad;

namespace {

/// Over all pairs.
double by_pairs(const std::vector<double>& scores, const std::vector<bool>& positive) {
  double won = 0, pairs = 0;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    for (std::size_t j = 0; j < scores.size(); ++j) {
      if (!positive[i] || positive[j]) continue;
      ++pairs;
      won += scores[i] > scores[j] ? 1.0 : (scores[i] < scores[j] ? 0.0 : 0.5);
    }
  }
  return won / pairs;
}

}  // namespace

TEST_CASE("the area by ranks is that over all pairs, ties and all") {
  std::mt19937_64 engine(31);
  for (const double steps : {1.0, 2.0, 7.0, 1000.0}) {
    std::vector<double> scores;
    std::vector<bool> positive;
    for (int i = 0; i < 200; ++i) {
      const bool is = uniform_01(engine) < 0.3;
      positive.push_back(is);
      scores.push_back(std::floor(steps * (uniform_01(engine) + (is ? 0.3 : 0.0))));
    }
    CHECK(auroc(scores, positive) == doctest::Approx(by_pairs(scores, positive)).epsilon(1e-12));
  }
}

TEST_CASE("a score that parts the rows has 1, its negative 0, one that says nothing 0.5") {
  const std::vector<bool> positive = {false, true, false, true};
  CHECK(auroc({1, 3, 2, 4}, positive) == 1);
  CHECK(auroc({-1, -3, -2, -4}, positive) == 0);
  CHECK(auroc({7, 7, 7, 7}, positive) == 0.5);
}

TEST_CASE("one class alone has no area, and series of different length are refused") {
  CHECK(std::isnan(auroc({1, 2}, {true, true})));
  CHECK(std::isnan(auroc({1, 2}, {false, false})));
  CHECK(std::isnan(auroc({}, {})));
  CHECK_THROWS_AS(auroc({1, 2}, {true}), std::invalid_argument);
}
