// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <pinnquad/core/random.hpp>
#include <pinnquad/evaluation/paired_test.hpp>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

using pinnquad::compare_paired;
using pinnquad::PairedComparison;
using Series = std::vector<double>;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A comparison whose differences candidate - baseline are exactly the given ones.
PairedComparison compare_differences(const Series& differences) {
  return compare_paired(differences, Series(differences.size(), 0.0));
}

/// Mid-ranks by counting: the number of smaller magnitudes, plus half of one more than the number of equal ones.
Series counted_ranks(const Series& differences) {
  Series ranks;
  for (const double a : differences) {
    double smaller = 0;
    double equal = 0;
    for (const double b : differences) {
      smaller += std::abs(b) < std::abs(a) ? 1 : 0;
      equal += std::abs(b) == std::abs(a) ? 1 : 0;
    }
    ranks.push_back(smaller + (equal + 1) / 2);
  }
  return ranks;
}

/// Two-sided p by trying all 2^n signs.
double enumerated_p(Series differences) {
  differences.erase(std::remove(differences.begin(), differences.end(), 0.0), differences.end());
  const Series ranks = counted_ranks(differences);
  const auto n = static_cast<unsigned>(ranks.size());
  double total = 0;
  double positive = 0;
  for (unsigned i = 0; i < n; ++i) {
    total += ranks[i];
    positive += differences[i] > 0 ? ranks[i] : 0;
  }
  const double observed = std::min(positive, total - positive);
  unsigned at_most = 0;
  for (unsigned signs = 0; signs < (1u << n); ++signs) {
    double sum = 0;
    for (unsigned i = 0; i < n; ++i) sum += (signs >> i & 1u) != 0 ? ranks[i] : 0;
    at_most += sum <= observed ? 1 : 0;
  }
  return std::min(1.0, 2.0 * at_most / (1u << n));
}

}  // namespace

TEST_CASE("published values of the signed-rank distribution") {
  CHECK(compare_differences({1, 2, 3, 4, 5}).p_value == 0.0625);
  CHECK(compare_differences({1, 2, 3, 4, 5, 6}).p_value == 0.03125);
  CHECK(compare_differences({1, 2, -3, 4, -5, 6, 7, 8, 9, 10}).p_value == 0.048828125);  // n = 10, W = 8
  // tabulated critical values of W for a two-sided 0.05: the largest W that is still significant
  const std::vector<std::pair<int, int>> table = {{6, 0},   {7, 2},   {8, 3},   {9, 5},   {10, 8},  {11, 10},
                                                  {12, 13}, {13, 17}, {14, 21}, {15, 25}, {16, 29}, {17, 34},
                                                  {18, 40}, {19, 46}, {20, 52}, {25, 89}, {30, 137}};
  for (const auto& entry : table) {
    const int n = entry.first;
    const int critical = entry.second;
    CAPTURE(n);
    std::vector<std::size_t> doubled;
    for (int rank = 1; rank <= n; ++rank) doubled.push_back(2 * static_cast<std::size_t>(rank));
    const auto two_sided = [&doubled](int w) {
      return 2 * pinnquad::detail::signed_rank_cdf(doubled, 2 * static_cast<std::size_t>(w));
    };
    CHECK(two_sided(critical) <= 0.05);
    CHECK(two_sided(critical + 1) > 0.05);
  }
}

TEST_CASE("Darwin's plants, as Wilcoxon's method is taught: 15 pairs, two losses, W = 24") {
  // Differences in eighths of an inch (Fisher, The Design of Experiments, 1935). R's wilcox.test(exact): W = 96 / 24.
  const PairedComparison result = compare_differences({49, -67, 8, 16, 6, 23, 28, 41, 14, 29, 56, 24, 75, 60, -48});
  CHECK(result.loss_rank_sum == 96);
  CHECK(result.win_rank_sum == 24);
  CHECK(result.p_value == doctest::Approx(0.0413).epsilon(0.001));
}

TEST_CASE("the p-value is that of all 2^n signs, with ties and zeros too") {
  std::mt19937_64 engine(17);
  for (std::size_t n = 1; n <= 12; ++n) {
    for (int trial = 0; trial < 12; ++trial) {
      Series differences(n);
      for (double& value : differences) {
        // even trials: all different; odd ones: whole numbers -3..3, full of ties and zeros
        value =
            trial % 2 == 0 ? pinnquad::standard_normal(engine) + 0.4 : std::floor(7 * pinnquad::uniform_01(engine)) - 3;
      }
      CAPTURE(n);
      CAPTURE(trial);
      const PairedComparison result = compare_differences(differences);
      CHECK(result.p_value == enumerated_p(differences));  // both are whole multiples of 2^-n
      const Series ranks = counted_ranks([&differences] {
        Series decided = differences;
        decided.erase(std::remove(decided.begin(), decided.end(), 0.0), decided.end());
        return decided;
      }());
      double total = 0;
      for (const double rank : ranks) total += rank;
      CHECK(result.win_rank_sum + result.loss_rank_sum == total);
    }
  }
}

TEST_CASE("the distribution is whole, symmetric, and exact at fifty pairs") {
  std::vector<std::size_t> ranks;
  for (std::size_t rank = 1; rank <= 50; ++rank) ranks.push_back(2 * rank);
  const std::size_t total = 50 * 51;
  using pinnquad::detail::signed_rank_cdf;
  CHECK(signed_rank_cdf(ranks, total) == 1);
  CHECK(signed_rank_cdf(ranks, 0) == std::ldexp(1.0, -50));
  CHECK(signed_rank_cdf(ranks, 2) == std::ldexp(2.0, -50));
  CHECK(signed_rank_cdf(ranks, 6) == std::ldexp(5.0, -50));  // 0, 1, 2, 3, 1 + 2
  for (std::size_t w = 0; w < total; w += 50) {
    CHECK(signed_rank_cdf(ranks, w) + signed_rank_cdf(ranks, total - w - 2) == 1);
  }
}

TEST_CASE("lower is better: who wins, by how much") {
  const PairedComparison result = compare_paired({3, 2, 5, 4, 1}, {4, 4, 5, 3, 4});
  CHECK(result.pairs == 5);
  CHECK(result.candidate_mean == 3);
  CHECK(result.baseline_mean == 4);
  CHECK(result.mean_difference == -1);
  CHECK(result.relative_difference == -0.25);
  CHECK(result.wins == 3);
  CHECK(result.ties == 1);
  CHECK(result.losses == 1);
  CHECK(result.win_rank_sum == 8.5);  // |d| = 1, 2, 1, 3: ranks 1.5, 3, 1.5, 4
  CHECK(result.loss_rank_sum == 1.5);
  CHECK(result.rank_biserial == 0.7);
  CHECK(std::isnan(compare_paired({1}, {0}).relative_difference));
  CHECK(compare_paired({-3}, {-2}).relative_difference == -0.5);  // of the magnitude: below 0 is better
}

TEST_CASE("equal models: nothing is decided") {
  const PairedComparison result = compare_paired({1, 2, 3}, {1, 2, 3});
  CHECK(result.ties == 3);
  CHECK(result.p_value == 1);
  CHECK(result.rank_biserial == 0);
  CHECK(result.mean_difference == 0);
  CHECK(compare_differences({1, 2, 3, 4}).rank_biserial == -1);
  CHECK(compare_differences({-1, -2}).rank_biserial == 1);
}

TEST_CASE("series that cannot be compared are refused") {
  CHECK_THROWS_WITH_AS(compare_paired({1, 2}, {1}), "compare_paired: expected series of equal length, found 2 and 1",
                       std::invalid_argument);
  CHECK_THROWS_WITH_AS(compare_paired({}, {}), "compare_paired: expected 1 to 500 pairs, found 0",
                       std::invalid_argument);
  CHECK_THROWS_AS(compare_paired(Series(501), Series(501)), std::invalid_argument);
  CHECK_THROWS_WITH_AS(compare_paired({1, std::nan("")}, {1, 2}), "compare_paired: pair 1 has no finite difference",
                       std::invalid_argument);
  CHECK_THROWS_AS(compare_paired({infinity}, {infinity}), std::invalid_argument);
}
