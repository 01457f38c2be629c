// SPDX-License-Identifier: MIT
// Bodies of paired_test.hpp.
#pragma once

#include "pinnquad/evaluation/paired_test.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY double signed_rank_cdf(const std::vector<std::size_t>& ranks, std::size_t w) {
  std::size_t total = 0;
  for (const std::size_t rank : ranks) total += rank;
  const std::size_t most = std::min(w, total);  // values above are in no sum
  std::vector<double> probability(most + 1, 0.0);
  probability[0] = 1;
  std::size_t reached = 0;
  for (const std::size_t rank : ranks) {
    reached += rank;
    for (std::size_t s = std::min(reached, most) + 1; s-- > 0;) {
      probability[s] = (probability[s] + (s >= rank ? probability[s - rank] : 0.0)) / 2;
    }
  }
  double sum = 0;
  for (const double p : probability) sum += p;
  return sum;
}

}  // namespace detail

PINNQUAD_BODY PairedComparison compare_paired(const std::vector<double>& candidate,
                                              const std::vector<double>& baseline) {
  detail::require_equal_length("compare_paired", candidate.size(), baseline.size());
  if (candidate.empty() || candidate.size() > most_pairs) {
    throw std::invalid_argument("compare_paired: expected 1 to " + std::to_string(most_pairs) + " pairs, found " +
                                std::to_string(candidate.size()));
  }
  PairedComparison result;
  result.pairs = candidate.size();
  std::vector<double> differences;
  std::vector<double> decided;  // without zeros, sorted by magnitude
  for (std::size_t i = 0; i < candidate.size(); ++i) {
    const double difference = candidate[i] - baseline[i];
    if (!std::isfinite(difference)) {
      throw std::invalid_argument("compare_paired: pair " + std::to_string(i) + " has no finite difference");
    }
    differences.push_back(difference);
    if (difference != 0) decided.push_back(difference);
    ++(difference < 0 ? result.wins : difference > 0 ? result.losses : result.ties);
  }
  result.candidate_mean = detail::mean_of(candidate);
  result.baseline_mean = detail::mean_of(baseline);
  result.mean_difference = detail::mean_of(differences);
  result.relative_difference =
      result.baseline_mean != 0 ? result.mean_difference / std::abs(result.baseline_mean) : not_a_number;
  if (decided.empty()) return result;

  std::sort(decided.begin(), decided.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  std::vector<double> magnitudes;
  for (const double difference : decided) magnitudes.push_back(std::abs(difference));
  const std::vector<std::size_t> ranks = detail::doubled_ranks(magnitudes);
  std::size_t wins = 0;
  std::size_t losses = 0;
  for (std::size_t i = 0; i < decided.size(); ++i) (decided[i] < 0 ? wins : losses) += ranks[i];
  result.win_rank_sum = static_cast<double>(wins) / 2;
  result.loss_rank_sum = static_cast<double>(losses) / 2;
  result.rank_biserial = (result.win_rank_sum - result.loss_rank_sum) / (result.win_rank_sum + result.loss_rank_sum);
  result.p_value = std::min(1.0, 2 * detail::signed_rank_cdf(ranks, std::min(wins, losses)));
  return result;
}

}  // namespace pinnquad
