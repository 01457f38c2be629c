// SPDX-License-Identifier: MIT
// Bodies of summary.hpp.
#pragma once

#include "pinnquad/evaluation/summary.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY double mean_of(const std::vector<double>& series) {
  if (series.empty()) return not_a_number;
  if (std::all_of(series.begin(), series.end(), [&series](double value) { return value == series.front(); })) {
    return series.front();
  }
  const auto count = static_cast<double>(series.size());
  double sum = 0;
  for (const double value : series) sum += value;
  const double mean = sum / count;
  double residual = 0;
  for (const double value : series) residual += value - mean;
  return mean + residual / count;
}

PINNQUAD_BODY std::vector<std::size_t> doubled_ranks(const std::vector<double>& sorted) {
  std::vector<std::size_t> ranks(sorted.size());
  for (std::size_t first = 0; first < sorted.size();) {
    std::size_t end = first;
    while (end < sorted.size() && !(sorted[first] < sorted[end])) ++end;
    for (std::size_t i = first; i < end; ++i) ranks[i] = first + 1 + end;  // ranks first+1 .. end, twice their mean
    first = end;
  }
  return ranks;
}

PINNQUAD_BODY void require_equal_length(const char* who, std::size_t first, std::size_t second) {
  if (first != second) {
    throw std::invalid_argument(std::string(who) + ": expected series of equal length, found " + std::to_string(first) +
                                " and " + std::to_string(second));
  }
}

}  // namespace detail

PINNQUAD_BODY Summary summarize(const std::vector<double>& series) {
  Summary summary;
  summary.count = series.size();
  summary.mean = detail::mean_of(series);
  if (series.size() < 2) return summary;
  double squares = 0;
  for (const double value : series) squares += (value - summary.mean) * (value - summary.mean);
  summary.deviation = std::sqrt(squares / static_cast<double>(series.size() - 1));
  return summary;
}

PINNQUAD_BODY detail::JointMoments joint_moments(const std::vector<double>& x, const std::vector<double>& y) {
  detail::require_equal_length("joint_moments", x.size(), y.size());
  detail::JointMoments moments;
  moments.mean_x = detail::mean_of(x);
  moments.mean_y = detail::mean_of(y);
  if (x.size() < 2) return moments;
  double xx = 0;
  double yy = 0;
  double xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = x[i] - moments.mean_x;
    const double dy = y[i] - moments.mean_y;
    xx += dx * dx;
    yy += dy * dy;
    xy += dx * dy;
  }
  const auto degrees_of_freedom = static_cast<double>(x.size() - 1);
  moments.variance_x = xx / degrees_of_freedom;
  moments.variance_y = yy / degrees_of_freedom;
  moments.covariance = xy / degrees_of_freedom;
  return moments;
}

PINNQUAD_BODY double pearson_correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const detail::JointMoments moments = joint_moments(x, y);
  if (!(moments.variance_x > 0) || !(moments.variance_y > 0)) return not_a_number;
  const double correlation = moments.covariance / (std::sqrt(moments.variance_x) * std::sqrt(moments.variance_y));
  return std::isnan(correlation) ? correlation : std::clamp(correlation, -1.0, 1.0);
}

PINNQUAD_BODY double auroc(const std::vector<double>& scores, const std::vector<bool>& positive) {
  if (scores.size() != positive.size()) {
    throw std::invalid_argument("auroc: expected as many scores as rows, found " + std::to_string(scores.size()) +
                                " and " + std::to_string(positive.size()));
  }
  std::vector<std::size_t> order(scores.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return scores[a] < scores[b]; });
  std::vector<double> sorted;
  for (const std::size_t row : order) sorted.push_back(scores[row]);
  const std::vector<std::size_t> ranks = detail::doubled_ranks(sorted);
  double rank_sum = 0, positives = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (!positive[order[i]]) continue;
    rank_sum += static_cast<double>(ranks[i]) / 2;
    positives += 1;
  }
  const double negatives = static_cast<double>(order.size()) - positives;
  if (!(positives > 0 && negatives > 0)) return not_a_number;
  return (rank_sum - positives * (positives + 1) / 2) / (positives * negatives);
}

}  // namespace pinnquad
