// SPDX-License-Identifier: MIT
// Pearson correlation (PCC) of two series, the paper's measure of how alike they run (Sec. 4.2, Fig. 2).
// It is blind to where they disagree: footnote 2 has two very different pairs with the same value.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "pinnquad/evaluation/joint_moments.hpp"

namespace pinnquad {

/// r = cov(x, y) / (spread(x) spread(y)), in -1..1, no unit.
/// Two passes: an offset that is large against the spread costs no digits. Rounding beyond +-1 is cut off.
/// NaN where undefined: fewer than two pairs, a constant series (or one whose variance underflows), NaN or Inf in
/// the data.
/// Throws std::invalid_argument for series of different length.
inline double pearson_correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const JointMoments moments = joint_moments(x, y);
  if (!(moments.variance_x > 0) || !(moments.variance_y > 0)) return not_a_number;
  const double correlation = moments.covariance / (std::sqrt(moments.variance_x) * std::sqrt(moments.variance_y));
  return std::isnan(correlation) ? correlation : std::clamp(correlation, -1.0, 1.0);
}

}  // namespace pinnquad
