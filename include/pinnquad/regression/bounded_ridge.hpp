// SPDX-License-Identifier: MIT
// Ridge regression of one output some of whose weights must add up to enough: w of least mean |y - b - w x|^2 + penalty
// |w|^2 with c w >= d for each of a few bounds, or c w = d for one that is pinned. Where the free fit keeps them it is
// the free fit.
#pragma once

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/regression/ridge.hpp"

namespace pinnquad {

/// sum of factor x weight over `terms` >= least, or = least.
struct WeightBound {
  std::vector<std::pair<int, double>> terms;  ///< feature and factor
  double least = 0;
  bool pinned = false;
};

/// The map to the one output of `sums` under the bounds. `taken` as for fit_ridge(). Each choice of bounds that hold with equality is solved; of those that keep all bounds the one of least cost
/// is taken, which is the minimum: the cost is convex. Throws std::invalid_argument for no rows, several outputs, a
/// penalty that is no number from 0, more than 8 bounds, a bound of a feature that is not taken, and where no choice
/// keeps all.
inline AffineMap fit_bounded_ridge(const RegressionSums& sums, double penalty, const std::vector<bool>& taken,
                                   const std::vector<WeightBound>& bounds) {
  constexpr std::size_t most_bounds = 8;
  if (!(sums.rows() > 0)) throw std::invalid_argument("ridge: expected at least one row, found none");
  if (sums.outputs() != 1) {
    throw std::invalid_argument("ridge: expected one output, found " + std::to_string(sums.outputs()));
  }
  detail::require_penalty(penalty);
  if (bounds.size() > most_bounds) throw std::invalid_argument("ridge: expected 8 bounds at most");
  const DynamicMatrix covariances = sums.covariances();
  const Eigen::VectorXd mean = sums.means();
  std::vector<int> columns, place(static_cast<std::size_t>(sums.inputs()), -1);
  for (int i = 0; i < sums.inputs(); ++i) {
    if (!taken.empty() && !taken[std::size_t(i)]) continue;
    place[std::size_t(i)] = static_cast<int>(columns.size());
    columns.push_back(i);
  }
  const auto size = static_cast<Eigen::Index>(columns.size());
  const auto count = static_cast<Eigen::Index>(bounds.size());
  DynamicMatrix a(size, size), right = DynamicMatrix::Zero(size, 1 + count);  // the free fit, then each bound's
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) a(i, j) = covariances(columns[std::size_t(i)], columns[std::size_t(j)]);
    a(i, i) += penalty;
    right(i, 0) = covariances(columns[std::size_t(i)], sums.inputs());
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    for (const auto& [feature, factor] : bounds[std::size_t(k)].terms) {
      const bool has = feature >= 0 && feature < sums.inputs();
      const int row = has ? place[std::size_t(feature)] : -1;
      if (row < 0) throw std::invalid_argument("ridge: a bound of feature " + std::to_string(feature) + ", not taken");
      right(row, 1 + k) = factor;
    }
  }
  const DynamicMatrix solution = solve_symmetric(a, right);
  const DynamicMatrix by = right.rightCols(count), moved = solution.rightCols(count);
  const Eigen::VectorXd free = solution.col(0);
  constexpr double tolerance = 1e-9;  // of a bound that holds with equality, after rounding
  Eigen::VectorXd best;
  double least_cost = 0;
  for (std::size_t active = 0; active < (std::size_t{1} << bounds.size()); ++active) {
    std::vector<Eigen::Index> held;
    bool allowed = true;
    for (Eigen::Index k = 0; k < count; ++k) {
      const bool is_held = (active >> k & 1U) != 0;
      allowed = allowed && (is_held || !bounds[std::size_t(k)].pinned);
      if (is_held) held.push_back(k);
    }
    if (!allowed) continue;
    Eigen::VectorXd weights = free;
    if (!held.empty()) {
      const auto rows = static_cast<Eigen::Index>(held.size());
      DynamicMatrix gram(rows, rows), missing(rows, 1);
      for (Eigen::Index i = 0; i < rows; ++i) {
        for (Eigen::Index j = 0; j < rows; ++j)
          gram(i, j) = by.col(held[std::size_t(i)]).dot(moved.col(held[std::size_t(j)]));
        missing(i, 0) = bounds[std::size_t(held[std::size_t(i)])].least - by.col(held[std::size_t(i)]).dot(free);
      }
      const DynamicMatrix forces = solve_symmetric(gram, missing);
      for (Eigen::Index i = 0; i < rows; ++i) weights += forces(i, 0) * moved.col(held[std::size_t(i)]);
    }
    bool keeps = true;
    for (Eigen::Index k = 0; k < count; ++k) {
      const double short_of = bounds[std::size_t(k)].least - by.col(k).dot(weights);
      const double scale = by.col(k).cwiseAbs().dot(weights.cwiseAbs()) + std::abs(bounds[std::size_t(k)].least);
      keeps = keeps && short_of <= tolerance * scale;
    }
    if (!keeps) continue;
    const double cost = weights.dot(a * weights) - 2 * weights.dot(right.col(0));
    if (best.size() == 0 || cost < least_cost) {
      best = weights;
      least_cost = cost;
    }
  }
  if (best.size() == 0 && size > 0) throw std::invalid_argument("ridge: no weights keep all bounds");
  AffineMap map;
  map.inputs = sums.inputs();
  map.outputs = 1;
  map.weights.assign(std::size_t(map.inputs), 0.0);
  double at_mean = 0;
  for (Eigen::Index i = 0; i < size; ++i) {
    const int column = columns[std::size_t(i)];
    map.weights[std::size_t(column)] = best[i];
    at_mean += best[i] * mean[column];
  }
  map.intercept = {mean[sums.inputs()] - at_mean};
  return map;
}

}  // namespace pinnquad
