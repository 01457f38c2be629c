// SPDX-License-Identifier: MIT
// Errors of predictions, per motor and as their mean over motors: mean absolute error, root mean square error,
// coefficient of determination. The verdict sets them beside the two predictors that cost nothing: the mean of the
// commands, and linear regression on the same features, which a network has to beat.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

#include "pinnquad/core/finite.hpp"
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
/// of their variance are left out. Returns the number taken.
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

/// Errors e_i = prediction_i - target_i of one output over n rows, t its targets:
///   mean_absolute    = sum |e_i| / n               in the unit of the output; Delta Y of Table 3
///   root_mean_square = sqrt(sum e_i^2 / n)         in the unit of the output
///   r_squared        = 1 - sum e_i^2 / sum (t_i - mean t)^2    1 is perfect, 0 as good as the mean, NaN for constant t
struct ErrorMeasures {
  double mean_absolute = 0;
  double root_mean_square = 0;
  double r_squared = 0;
};

/// Errors per motor, and the arithmetic mean of each measure over the motors.
template <std::size_t Motors>
struct PredictionErrors {
  std::array<ErrorMeasures, Motors> per_motor{};
  ErrorMeasures mean;
};

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

/// Compares predictions with targets, row by row. A NaN in a column gives NaN for that motor and the mean.
/// Throws std::invalid_argument for no rows or tables of different length.
template <std::size_t Motors>
detail::PredictionErrors<Motors> prediction_errors(const std::vector<std::array<double, Motors>>& predictions,
                                                   const std::vector<std::array<double, Motors>>& targets) {
  static_assert(Motors > 0, "prediction_errors: a row needs at least one output");
  detail::require_equal_length("prediction_errors", predictions.size(), targets.size());
  if (targets.empty()) throw std::invalid_argument("prediction_errors: expected at least one row, found none");

  const auto rows = static_cast<double>(targets.size());
  detail::PredictionErrors<Motors> errors;
  for (std::size_t motor = 0; motor < Motors; ++motor) {
    std::vector<double> target(targets.size());
    for (std::size_t i = 0; i < targets.size(); ++i) target[i] = targets[i][motor];
    const double mean_target = detail::mean_of(target);

    double absolute = 0;
    double squares = 0;
    double squares_of_mean = 0;
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const double error = predictions[i][motor] - target[i];
      absolute += std::abs(error);
      squares += error * error;
      squares_of_mean += (target[i] - mean_target) * (target[i] - mean_target);
    }
    detail::ErrorMeasures& measures = errors.per_motor[motor];
    measures.mean_absolute = absolute / rows;
    measures.root_mean_square = std::sqrt(squares / rows);
    measures.r_squared = squares_of_mean > 0 ? 1 - squares / squares_of_mean : not_a_number;

    constexpr auto motors = static_cast<double>(Motors);
    errors.mean.mean_absolute += measures.mean_absolute / motors;
    errors.mean.root_mean_square += measures.root_mean_square / motors;
    errors.mean.r_squared += measures.r_squared / motors;
  }
  return errors;
}

/// Coefficients of determination on the test rows (evaluation/errors.hpp); but for the worst motor's the mean over the
/// commands.
struct Verdict {
  double test_r_squared = 0;               ///< of the model
  double linear_regression_r_squared = 0;  ///< of evaluation/errors.hpp, fitted on the model's training rows
  /// The model's least R^2 over the motors; NaN if one is NaN or none is known.
  double worst_motor_r_squared = std::numeric_limits<double>::quiet_NaN();
  /// Share of the test rows that the guard of its export lets it answer; NaN: not known.
  double answered_share = std::numeric_limits<double>::quiet_NaN();

  /// Answering always with the mean command would have been better; so too if R^2 is NaN. Such a model is not for
  /// flight.
  bool worse_than_mean() const noexcept { return !(is_finite(test_r_squared) && test_r_squared >= 0); }
  /// True if one motor's R^2 is below 0, which a good mean may hide.
  bool has_poor_motor() const noexcept { return is_finite(worst_motor_r_squared) && worst_motor_r_squared < 0; }
  /// False if the plain linear map predicts the commands as well or better: the network has learned nothing beyond it.
  bool beats_linear_regression() const noexcept {
    return is_finite(test_r_squared) &&
           (!is_finite(linear_regression_r_squared) || test_r_squared > linear_regression_r_squared);
  }
};

/// The verdict on a model by its errors on the test rows.
template <std::size_t Motors>
Verdict verdict_on(const detail::PredictionErrors<Motors>& errors, double linear_regression_r_squared) noexcept {
  double worst = errors.per_motor[0].r_squared;
  for (const detail::ErrorMeasures& motor : errors.per_motor) {
    if (is_finite(worst) && (!is_finite(motor.r_squared) || motor.r_squared < worst)) worst = motor.r_squared;
  }
  return {errors.mean.r_squared, linear_regression_r_squared, worst};
}

}  // namespace pinnquad
