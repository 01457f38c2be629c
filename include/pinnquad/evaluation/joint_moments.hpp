// SPDX-License-Identifier: MIT
// Means and 2x2 covariance of paired series, by two passes: what correlation, ellipse and slope are made of.
// A series of one repeated value has variance exactly 0.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/evaluation/summary.hpp"

namespace pinnquad {

namespace detail {

inline void require_equal_length(const char* who, std::size_t first, std::size_t second) {
  if (first != second) {
    throw std::invalid_argument(std::string(who) + ": expected series of equal length, found " + std::to_string(first) +
                                " and " + std::to_string(second));
  }
}

}  // namespace detail

/// First and second moments of paired series x, y: means, and the 2x2 covariance matrix (divisor n - 1).
struct JointMoments {
  double mean_x = not_a_number;
  double mean_y = not_a_number;
  double variance_x = not_a_number;
  double variance_y = not_a_number;
  double covariance = not_a_number;
};

/// Moments of the pairs (x[i], y[i]). Variances and covariance are NaN for fewer than two pairs.
/// Throws std::invalid_argument for series of different length.
inline JointMoments joint_moments(const std::vector<double>& x, const std::vector<double>& y) {
  detail::require_equal_length("joint_moments", x.size(), y.size());
  JointMoments moments;
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

}  // namespace pinnquad
