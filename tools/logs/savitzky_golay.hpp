// SPDX-License-Identifier: MIT
// Smoothed values and derivatives of a series on a uniform clock: in a window that slides over it, the least-squares
// polynomial. At the ends the same window's polynomial is evaluated off its centre: no sample is made up, none outside
// the segment is read.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/data/split.hpp"

namespace programs {

/// A polynomial of `order` over 2 `half_window` + 1 rows.
struct SavitzkyGolay {
  int order = 2;
  int half_window = 2;  ///< rows on each side; 2 half_window >= order
};

/// Rows at an end of a segment whose polynomial is evaluated off its centre: their noise is larger, see
/// savitzky_golay_weights().
constexpr std::size_t edge_rows(const SavitzkyGolay& filter) noexcept {
  return static_cast<std::size_t>(filter.half_window);
}

namespace detail {

inline void require_savitzky_golay(const SavitzkyGolay& filter, int derivative) {
  constexpr int largest_half_window = 1 << 20;
  if (filter.order >= 0 && filter.half_window >= 0 && filter.half_window <= largest_half_window &&
      filter.order <= 2 * filter.half_window && derivative >= 0 && derivative <= 2) {
    return;
  }
  throw std::invalid_argument(
      "savitzky-golay: expected an order of 0 to twice the half window and a derivative of 0 to 2, found order " +
      std::to_string(filter.order) + ", half window " + std::to_string(filter.half_window) + ", derivative " +
      std::to_string(derivative));
}

/// Orthonormal polynomials of degree 0 to `order` over the rows -m..m: P[degree][row + m]. Gram's recursion, in x = row
/// / m.
inline std::vector<std::vector<double>> gram_polynomials(int order, int half_window) {
  const std::size_t rows = 2 * static_cast<std::size_t>(half_window) + 1;
  std::vector<std::vector<double>> basis(static_cast<std::size_t>(order) + 1, std::vector<double>(rows, 1.0));
  const double scale = half_window > 0 ? 1.0 / half_window : 1.0;
  for (std::size_t degree = 0; degree < basis.size(); ++degree) {
    std::vector<double>& p = basis[degree];
    if (degree > 0) {
      for (std::size_t row = 0; row < rows; ++row) {
        p[row] = (static_cast<double>(row) - half_window) * scale * basis[degree - 1][row];
      }
    }
    for (int pass = 0; pass < 2; ++pass) {  // the second pass takes what rounding left of the first
      for (std::size_t lower = 0; lower < degree; ++lower) {
        double along = 0;
        for (std::size_t row = 0; row < rows; ++row) along += p[row] * basis[lower][row];
        for (std::size_t row = 0; row < rows; ++row) p[row] -= along * basis[lower][row];
      }
    }
    double squares = 0;
    for (const double value : p) squares += value * value;
    for (double& value : p) value /= std::sqrt(squares);
  }
  return basis;
}

/// The polynomials of gram_polynomials(), or their first or second derivative, at `position` rows from the centre: by
/// the same recursion, whose factors are sums over the window's rows.
inline std::vector<double> gram_derivatives(const std::vector<std::vector<double>>& basis, int half_window,
                                            double position, int derivative) {
  const std::size_t rows = basis[0].size(), degrees = basis.size();
  const double scale = half_window > 0 ? 1.0 / half_window : 1.0;
  const double x = position * scale;
  // values[k][d]: d-th derivative of p_k with respect to x; repeats the orthogonalisation that made p_k of x p_(k-1)
  std::vector<std::array<double, 3>> values(degrees);
  values[0] = {basis[0][0], 0, 0};
  for (std::size_t k = 1; k < degrees; ++k) {
    std::array<double, 3> next = {x * values[k - 1][0], x * values[k - 1][1] + values[k - 1][0],
                                  x * values[k - 1][2] + 2 * values[k - 1][1]};
    // x p_(k-1) = sum_l c_l p_l + c_k p_k
    std::vector<double> raw(rows);
    for (std::size_t row = 0; row < rows; ++row) {
      raw[row] = (static_cast<double>(row) - half_window) * scale * basis[k - 1][row];
    }
    const auto along = [&](std::size_t l) {
      double sum = 0;
      for (std::size_t row = 0; row < rows; ++row) sum += raw[row] * basis[l][row];
      return sum;
    };
    for (std::size_t l = 0; l < k; ++l) {
      const double c = along(l);
      for (std::size_t d = 0; d < 3; ++d) next[d] -= c * values[l][d];
    }
    const double c = along(k);
    for (std::size_t d = 0; d < 3; ++d) values[k][d] = next[d] / c;
  }
  std::vector<double> result(degrees);
  for (std::size_t k = 0; k < degrees; ++k) {
    result[k] = values[k][static_cast<std::size_t>(derivative)] * std::pow(scale, derivative);
  }
  return result;
}

}  // namespace detail

/// h_i, i = -m..m, with y^(d)(position) = sum_i h_i y_i / period^d for y the least-squares polynomial: h_i = sum_k
/// p_k(i) p_k^(d)(position), p_k orthonormal over the window. Of noise of variance s^2, white, sum_i h_i^2 s^2 /
/// period^2d remains; it grows towards the window's ends. `position` in rows from the centre, -m..m. Throws
/// std::invalid_argument for a filter that is none.
/// Source: Savitzky, Golay (1964); off the centre: Gorry (1990).
inline std::vector<double> savitzky_golay_weights(const SavitzkyGolay& filter, int derivative, double position = 0) {
  detail::require_savitzky_golay(filter, derivative);
  const auto basis = detail::gram_polynomials(filter.order, filter.half_window);
  const auto at = detail::gram_derivatives(basis, filter.half_window, position, derivative);
  std::vector<double> weights(basis[0].size(), 0.0);
  for (std::size_t k = 0; k < basis.size(); ++k) {
    for (std::size_t row = 0; row < weights.size(); ++row) weights[row] += basis[k][row] * at[k];
  }
  return weights;
}

/// The d-th derivative, 1/s^d, of each row of a segment that has no gap and no NaN. A segment shorter than the window
/// gets a window that fits into it, and an order that fits the window; one row has no derivative: NaN. Throws
/// std::invalid_argument for a filter or a period that is none.
inline std::vector<double> savitzky_golay(const std::vector<double>& segment, double period_s,
                                          const SavitzkyGolay& filter, int derivative) {
  detail::require_savitzky_golay(filter, derivative);
  if (!(period_s > 0)) throw std::invalid_argument("savitzky-golay: expected a period above 0 s");
  const std::size_t rows = segment.size();
  std::vector<double> result(rows, std::nan(""));
  if (rows == 0) return result;
  SavitzkyGolay fitting = filter;
  fitting.half_window = static_cast<int>(std::min(static_cast<std::size_t>(filter.half_window), (rows - 1) / 2));
  fitting.order = std::min(filter.order, 2 * fitting.half_window);
  if (fitting.order < derivative) return result;
  const auto m = static_cast<std::size_t>(fitting.half_window);
  const double unit = std::pow(period_s, derivative);
  const auto sum = [&](const std::vector<double>& weights, std::size_t first) {
    double value = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) value += weights[i] * segment[first + i];
    return value / unit;
  };
  const std::vector<double> centre = savitzky_golay_weights(fitting, derivative);
  for (std::size_t row = m; row + m < rows; ++row) result[row] = sum(centre, row - m);
  for (std::size_t row = 0; row < m; ++row) {
    const double before = static_cast<double>(row) - static_cast<double>(m);
    result[row] = sum(savitzky_golay_weights(fitting, derivative, before), 0);
    result[rows - 1 - row] = sum(savitzky_golay_weights(fitting, derivative, -before), rows - 1 - 2 * m);
  }
  return result;
}

/// Segment by segment; rows in none of them are NaN.
inline std::vector<double> savitzky_golay(const std::vector<double>& series,
                                          const std::vector<pinnquad::IndexRange>& segments, double period_s,
                                          const SavitzkyGolay& filter, int derivative) {
  std::vector<double> result(series.size(), std::nan(""));
  for (const pinnquad::IndexRange& segment : segments) {
    const auto from = series.begin() + static_cast<std::ptrdiff_t>(segment.begin);
    const std::vector<double> part(from, from + static_cast<std::ptrdiff_t>(segment.size()));
    const std::vector<double> derived = savitzky_golay(part, period_s, filter, derivative);
    std::copy(derived.begin(), derived.end(), result.begin() + static_cast<std::ptrdiff_t>(segment.begin));
  }
  return result;
}

/// Runs of at least `minimum_rows` rows without NaN or infinity in any of the series, which are of one length.
inline std::vector<pinnquad::IndexRange> finite_segments(const std::vector<const std::vector<double>*>& series,
                                                         std::size_t minimum_rows = 1) {
  std::vector<pinnquad::IndexRange> segments;
  const std::size_t rows = series.empty() ? 0 : series.front()->size();
  pinnquad::IndexRange open;
  for (std::size_t row = 0; row <= rows; ++row) {
    const bool whole = row < rows && std::all_of(series.begin(), series.end(), [row](const std::vector<double>* one) {
                         return std::isfinite((*one)[row]);
                       });
    if (whole) {
      open.end = row + 1;
      continue;
    }
    if (open.end > open.begin && open.size() >= minimum_rows) segments.push_back(open);
    open = {row + 1, row + 1};
  }
  return segments;
}

}  // namespace programs
