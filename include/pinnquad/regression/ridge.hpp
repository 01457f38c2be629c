// SPDX-License-Identifier: MIT
// Ridge regression in closed form: y = b + W x that minimises mean |y_n - b - W x_n|^2 + penalty |W|^2. The intercept is free
// of the penalty. Features are to be standardised (training/training_data.hpp): the penalty takes all alike.
// Of sums over rows (regression/regression_sums.hpp): to leave a trajectory out is a subtraction, whatever its rows.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/regression/regression_sums.hpp"
#include "pinnquad/regression/symmetric_system.hpp"

namespace pinnquad {

namespace detail {
inline void require_penalty(double penalty) {
  if (!(penalty >= 0) || penalty > 1e12) {
    throw std::invalid_argument("ridge: expected a penalty from 0, found " + std::to_string(penalty));
  }
}
}  // namespace detail

/// The map of these rows. `taken`: of `inputs` entries, false for a feature that gets no weight; empty takes all. A feature that
/// stands still, or that the others repeat, does no harm, without a penalty too (regression/symmetric_system.hpp).
/// Throws std::invalid_argument for no rows and for a penalty that is no number from 0.
inline AffineMap fit_ridge(const RegressionSums& sums, double penalty, const std::vector<bool>& taken = {}) {
  if (!(sums.rows() > 0)) throw std::invalid_argument("ridge: expected at least one row, found none");
  detail::require_penalty(penalty);
  std::vector<int> columns;
  for (int i = 0; i < sums.inputs(); ++i) {
    if (taken.empty() || taken[std::size_t(i)]) columns.push_back(i);
  }
  const DynamicMatrix covariances = sums.covariances();
  const auto size = static_cast<Eigen::Index>(columns.size());
  DynamicMatrix a(size, size), b(size, sums.outputs());
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) a(i, j) = covariances(columns[std::size_t(i)], columns[std::size_t(j)]);
    a(i, i) += penalty;
    for (int k = 0; k < sums.outputs(); ++k) b(i, k) = covariances(columns[std::size_t(i)], sums.inputs() + k);
  }
  const DynamicMatrix solution = solve_symmetric(a, b);
  const Eigen::VectorXd mean = sums.means();
  AffineMap map;
  map.inputs = sums.inputs();
  map.outputs = sums.outputs();
  map.weights.assign(std::size_t(map.inputs) * std::size_t(map.outputs), 0.0);
  for (int k = 0; k < map.outputs; ++k) {
    double at_mean = 0;
    for (Eigen::Index i = 0; i < size; ++i) {
      const int column = columns[std::size_t(i)];
      map.weights[std::size_t(k * map.inputs + column)] = solution(i, k);
      at_mean += solution(i, k) * mean[column];
    }
    map.intercept.push_back(mean[map.inputs + k] - at_mean);
  }
  return map;
}

/// Sum of (y - map(x))^2 over the rows and outputs of these sums.
inline double squared_error(const RegressionSums& sums, const AffineMap& map) {
  const DynamicMatrix covariances = sums.covariances();
  const Eigen::VectorXd mean = sums.means();
  const int n = map.inputs;
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const RowMajor> w(map.weights.data(), map.outputs, n);
  double sum = 0;
  for (int k = 0; k < map.outputs; ++k) {
    const Eigen::VectorXd of = w.row(k).transpose();
    const double bias = mean[n + k] - map.intercept[std::size_t(k)] - of.dot(mean.head(n));
    sum += covariances(n + k, n + k) - 2 * of.dot(covariances.col(n + k).head(n)) +
           of.dot(covariances.topLeftCorner(n, n) * of) + bias * bias;
  }
  return sum * sums.rows();
}

/// Penalties that are tried: half decades, of features and outputs with spread 1.
inline std::vector<double> usual_penalties() {
  return {1e-7, 3e-7, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1, 3e-1, 1.0, 3.0, 10.0};
}

struct PenaltyChoice {
  double penalty = 0;  ///< of the least error; of equals the largest
  std::vector<double>
      mean_squared_error;  ///< of each candidate, over all rows, each predicted by a fit without its group
};

/// The penalty that predicts best what was left out: each group of rows (a trajectory with its repeats) by the fit to all
/// others. Throws std::invalid_argument for fewer than two groups or no candidate.
inline PenaltyChoice choose_penalty(const std::vector<RegressionSums>& groups,
                                    const std::vector<double>& candidates = usual_penalties(),
                                    const std::vector<bool>& taken = {}) {
  if (groups.size() < 2) {
    throw std::invalid_argument("ridge: expected two groups of rows or more, to leave one out in turn, found " +
                                std::to_string(groups.size()));
  }
  if (candidates.empty()) throw std::invalid_argument("ridge: expected a penalty to choose, found none");
  RegressionSums all = groups.front();
  for (std::size_t i = 1; i < groups.size(); ++i) all += groups[i];
  PenaltyChoice choice;
  choice.mean_squared_error.assign(candidates.size(), 0.0);
  for (const RegressionSums& left_out : groups) {
    RegressionSums others = all;
    others -= left_out;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      choice.mean_squared_error[i] +=
          squared_error(left_out, fit_ridge(others, candidates[i], taken)) / (all.rows() * all.outputs());
    }
  }
  std::size_t best = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    const double error = choice.mean_squared_error[i], least = choice.mean_squared_error[best];
    if (error < least || (!(error > least) && candidates[i] > candidates[best])) best = i;
  }
  choice.penalty = candidates[best];
  return choice;
}

}  // namespace pinnquad
