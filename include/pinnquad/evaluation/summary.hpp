// SPDX-License-Identifier: MIT
// Statistics of a series and of pairs of series, by two passes: an offset that is large beside the deviation costs no
// digits. A series of one repeated value has deviation exactly 0, so that "degenerate" is a test, not a threshold.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace pinnquad {

/// A figure that is not defined: of a series that is empty, or that does not vary.
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

namespace detail {

/// The mean, corrected by the mean residual; the value itself if there is only one value.
double mean_of(const std::vector<double>& series);

/// Doubled mid-ranks of a sorted series: whole numbers even with ties, so that rank sums can index an array.
std::vector<std::size_t> doubled_ranks(const std::vector<double>& sorted);

void require_equal_length(const char* who, std::size_t first, std::size_t second);

/// First and second moments of paired series x, y: means, and the 2x2 covariance matrix (divisor n - 1).
struct JointMoments {
  double mean_x = not_a_number;
  double mean_y = not_a_number;
  double variance_x = not_a_number;
  double variance_y = not_a_number;
  double covariance = not_a_number;
};

}  // namespace detail

/// Mean and standard deviation of a series, in its unit.
struct Summary {
  std::size_t count = 0;
  double mean = not_a_number;
  double deviation = not_a_number;
};

/// mean = sum x / n, deviation = sqrt(sum (x - mean)^2 / (n - 1)).
/// NaN where undefined: the mean of none, the deviation of fewer than two.
Summary summarize(const std::vector<double>& series);

/// Moments of the pairs (x[i], y[i]). Variances and covariance are NaN for fewer than two pairs.
/// Throws std::invalid_argument for series of different length.
detail::JointMoments joint_moments(const std::vector<double>& x, const std::vector<double>& y);

/// Pearson's correlation (PCC), the paper's measure of how alike two series run (Sec. 4.2, Fig. 2): r = cov(x, y) /
/// (deviation(x) deviation(y)), cut off at -1 and 1. It is blind to where they disagree (footnote 2). NaN for fewer
/// than two pairs, a constant series (or one whose variance underflows), NaN or Inf in the data. Throws
/// std::invalid_argument for series of different length.
double pearson_correlation(const std::vector<double>& x, const std::vector<double>& y);

/// By ranks (Mann and Whitney 1947): (sum of the positives' ranks - n (n + 1) / 2) / (n m), equal scores sharing their
/// mean rank. NaN unless there are positives and negatives. Throws std::invalid_argument for series of different
/// length.
double auroc(const std::vector<double>& scores, const std::vector<bool>& positive);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/core/body.hpp"
#include "pinnquad/evaluation/impl/summary.hpp"
#endif
