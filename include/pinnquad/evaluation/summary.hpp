// SPDX-License-Identifier: MIT
// Mean and standard deviation of a series, by two passes: how a result over seeds is told.
// A series of one repeated value has deviation exactly 0, so that "degenerate" is a test, not a threshold.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace pinnquad {

/// A figure that is not defined: of a series that is empty, or that does not vary.
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

namespace detail {

/// The mean, corrected by the mean residual; the value itself if there is only one value.
inline double mean_of(const std::vector<double>& series) {
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

}  // namespace detail

/// Mean and standard deviation of a series, in its unit.
struct Summary {
  std::size_t count = 0;
  double mean = not_a_number;
  double deviation = not_a_number;
};

/// mean = sum x / n, deviation = sqrt(sum (x - mean)^2 / (n - 1)).
/// NaN where undefined: the mean of none, the deviation of fewer than two.
inline Summary summarize(const std::vector<double>& series) {
  Summary summary;
  summary.count = series.size();
  summary.mean = detail::mean_of(series);
  if (series.size() < 2) return summary;
  double squares = 0;
  for (const double value : series) squares += (value - summary.mean) * (value - summary.mean);
  summary.deviation = std::sqrt(squares / static_cast<double>(series.size() - 1));
  return summary;
}

}  // namespace pinnquad
