// SPDX-License-Identifier: MIT
// Ordinary least squares with intercept: what a linear map of the features predicts. The bar for a network, which has
// to earn its weights. Rank-revealing: features that stand still or repeat others do no harm.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "pinnquad/evaluation/summary.hpp"

namespace pinnquad {

namespace detail {

/// y = intercept + C x with C of OutputCount rows and InputCount columns; x and y in their own units.
template <std::size_t InputCount, std::size_t OutputCount>
struct LinearRegression {
  std::array<std::array<double, InputCount>, OutputCount> coefficients{};
  std::array<double, OutputCount> intercept{};
  int rank = 0;  ///< of the centred features: how many of them were taken

  std::array<double, OutputCount> predict(const std::array<double, InputCount>& x) const {
    std::array<double, OutputCount> y = intercept;
    for (std::size_t k = 0; k < OutputCount; ++k) {
      for (std::size_t i = 0; i < InputCount; ++i) y[k] += coefficients[k][i] * x[i];
    }
    return y;
  }
};

/// Gauss-Jordan on the symmetric matrix of moments, of which only the features' rows are needed: one feature after
/// another, the one that varies most beside those before it first. Features that those before explain up to `threshold`
/// of their variance are left out. The number taken.
template <std::size_t InputCount, std::size_t Size>
int sweep(std::array<std::array<double, Size>, InputCount>& moments, std::array<bool, InputCount>& taken,
          double threshold) {
  for (int rank = 0;; ++rank) {
    std::size_t pivot = InputCount;
    for (std::size_t i = 0; i < InputCount; ++i) {
      if (taken[i] || !(moments[i][i] > threshold)) continue;
      if (pivot == InputCount || moments[i][i] > moments[pivot][pivot]) pivot = i;
    }
    if (pivot == InputCount) return rank;
    taken[pivot] = true;
    const double diagonal = moments[pivot][pivot];
    moments[pivot][pivot] = 1;
    for (double& value : moments[pivot]) value /= diagonal;
    for (std::size_t i = 0; i < InputCount; ++i) {
      if (i == pivot) continue;
      const double factor = moments[i][pivot];
      moments[i][pivot] = 0;
      for (std::size_t j = 0; j < Size; ++j) moments[i][j] -= factor * moments[pivot][j];
    }
  }
}

}  // namespace detail

/// Minimises sum |intercept + C x_n - y_n|^2 over the rows, by the sweep of the second moments of features and outputs,
/// centred and divided by their deviation. A feature that the others explain to all but 1e-9 of its variance gets the
/// coefficients 0: what could be fitted to the rest is rounding.
/// Throws std::invalid_argument for no rows or tables of different length.
/// Source: Goodnight, A tutorial on the SWEEP operator (1979).
template <std::size_t InputCount, std::size_t OutputCount>
detail::LinearRegression<InputCount, OutputCount> fit_linear_regression(
    const std::vector<std::array<double, InputCount>>& features,
    const std::vector<std::array<double, OutputCount>>& outputs) {
  constexpr double rank_threshold = 1e-9;
  constexpr double rounding = 1e-12;  // of a constant column's deviation, relative to its mean
  constexpr std::size_t size = InputCount + OutputCount;
  detail::require_equal_length("fit_linear_regression", features.size(), outputs.size());
  if (features.empty()) throw std::invalid_argument("fit_linear_regression: expected at least one row, found none");
  const auto value = [&](std::size_t row, std::size_t i) {
    return i < InputCount ? features[row][i] : outputs[row][i - InputCount];
  };
  const auto rows = static_cast<double>(features.size());
  std::array<double, size> mean{}, deviation{};
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t row = 0; row < features.size(); ++row) mean[i] += value(row, i) / rows;
    double squares = 0;
    for (std::size_t row = 0; row < features.size(); ++row) {
      const double difference = value(row, i) - mean[i];
      squares += difference * difference;
    }
    deviation[i] = std::sqrt(squares / rows);
    if (!(deviation[i] > rounding * std::abs(mean[i]))) deviation[i] = 0;
  }
  std::array<std::array<double, size>, InputCount> moments{};
  for (std::size_t row = 0; row < features.size(); ++row) {
    std::array<double, size> z{};
    for (std::size_t i = 0; i < size; ++i) z[i] = deviation[i] > 0 ? (value(row, i) - mean[i]) / deviation[i] : 0;
    for (std::size_t i = 0; i < InputCount; ++i) {
      for (std::size_t j = 0; j < size; ++j) moments[i][j] += z[i] * z[j] / rows;
    }
  }
  detail::LinearRegression<InputCount, OutputCount> fit;
  std::array<bool, InputCount> taken{};
  fit.rank = detail::sweep(moments, taken, rank_threshold);
  for (std::size_t k = 0; k < OutputCount; ++k) {
    fit.intercept[k] = mean[InputCount + k];
    for (std::size_t i = 0; i < InputCount; ++i) {
      if (!taken[i]) continue;
      fit.coefficients[k][i] = moments[i][InputCount + k] * deviation[InputCount + k] / deviation[i];
      fit.intercept[k] -= fit.coefficients[k][i] * mean[i];
    }
  }
  return fit;
}

}  // namespace pinnquad
