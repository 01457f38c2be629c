// SPDX-License-Identifier: MIT
// Two models compared seed by seed: who wins how often, by how much, and could it be chance?
// Exact Wilcoxon signed-rank test: no normal approximation, right for the few seeds that a study has.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/evaluation/summary.hpp"

namespace pinnquad {

/// Candidate against baseline, both measured on the same seeds; LOWER IS BETTER (an error).
/// d_i = candidate_i - baseline_i. Zeros are dropped before ranking (Wilcoxon's rule), equal |d| share their mid-rank.
struct PairedComparison {
  std::size_t pairs = 0;
  double candidate_mean = 0;
  double baseline_mean = 0;
  double mean_difference = 0;      ///< mean d; below 0: the candidate is better
  double relative_difference = 0;  ///< mean d / |baseline mean|; NaN if that is 0
  std::size_t wins = 0;            ///< d < 0
  std::size_t ties = 0;            ///< d = 0
  std::size_t losses = 0;          ///< d > 0
  double win_rank_sum = 0;         ///< sum of the ranks of |d| over the wins
  double loss_rank_sum = 0;        ///< the same over the losses; Wilcoxon's W is the smaller of both
  double p_value = 1;              ///< exact, two-sided; 1 if all d are 0
  /// Matched-pairs rank-biserial correlation (win_rank_sum - loss_rank_sum) / (their sum): +1 if the candidate always
  /// wins, -1 if it always loses, 0 if all d are 0.
  double rank_biserial = 0;
};

namespace detail {

/// P(W <= w) for W the sum of those ranks whose sign comes up positive, all 2^n signs equally likely.
/// Each rank doubles the distribution: p(s) = (p(s) + p(s - rank)) / 2; exact in a double up to 50 ranks.
double signed_rank_cdf(const std::vector<std::size_t>& ranks, std::size_t w);

}  // namespace detail

/// Most pairs that compare_paired() takes: the exact distribution costs n^3 steps.
inline constexpr std::size_t most_pairs = 500;

/// Compares the models pair by pair. p = min(1, 2 P(W <= min(win_rank_sum, loss_rank_sum))) under the hypothesis that
/// the sign of every d_i is a fair coin. Equal |d| means equal to the last bit. With n decided pairs p is never below
/// 2^(1-n): five seeds cannot reach 0.05.
/// Throws std::invalid_argument for series of different length, none or more than 500 pairs, NaN or Inf.
/// Source: Wilcoxon, Individual comparisons by ranking methods (1945); Kerby, The simple difference formula (2014).
PairedComparison compare_paired(const std::vector<double>& candidate, const std::vector<double>& baseline);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/evaluation/impl/paired_test.hpp"
#endif
