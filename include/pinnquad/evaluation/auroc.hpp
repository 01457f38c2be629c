// SPDX-License-Identifier: MIT
// How well a score tells the rows that matter from the others: the area under the receiver operating characteristic,
// which is the probability that a positive row scores higher than a negative one, ties counted half.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/evaluation/summary.hpp"

namespace pinnquad {

/// By ranks (Mann and Whitney 1947): (sum of the positives' ranks - n (n + 1) / 2) / (n m), equal scores sharing their
/// mean rank. NaN unless there are positives and negatives. Throws std::invalid_argument for series of different
/// length.
inline double auroc(const std::vector<double>& scores, const std::vector<bool>& positive) {
  if (scores.size() != positive.size()) {
    throw std::invalid_argument("auroc: expected as many scores as rows, found " + std::to_string(scores.size()) +
                                " and " + std::to_string(positive.size()));
  }
  std::vector<std::size_t> order(scores.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return scores[a] < scores[b]; });
  double ranks = 0, positives = 0;
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first;
    double among = 0;
    for (; last < order.size() && !(scores[order[first]] < scores[order[last]]); ++last) {
      among += positive[order[last]] ? 1 : 0;
    }
    ranks += among * (static_cast<double>(first + last + 1) / 2);  // ranks first + 1 to last
    positives += among;
    first = last;
  }
  const double negatives = static_cast<double>(order.size()) - positives;
  if (!(positives > 0 && negatives > 0)) return not_a_number;
  return (ranks - positives * (positives + 1) / 2) / (positives * negatives);
}

}  // namespace pinnquad
