// SPDX-License-Identifier: MIT
// How far a model is off on held-out flights, and how much of that is a bias that stands still over a flight (battery,
// trim).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pinnquad/data/row_set.hpp"
#include "pinnquad/evaluation/summary.hpp"
#include "training/judgement.hpp"

namespace programs {

using MotorFigures = std::array<double, pinnquad::rotor_count>;

/// Errors e = predicted - flown command of the rows that count, per motor. With t the flown commands:
///   r2                     = 1 - sum e^2 / sum (t - mean t)^2              mean t: over all rows
///   r2_flight_bias_removed = 1 - sum (e - mean e)^2 / sum (t - mean t)^2   both means: of the row's own flight
///   r2_start_bias_removed  = 1 - sum (e - b)^2 / sum (t - mean t)^2        b: mean error of the flight's first 4 s;
///   rows after
/// 0 is as good as the mean of the held-out commands; the second is 0 for a model that answers with a constant.
struct FlightErrors {
  std::size_t rows = 0;
  MotorFigures mean_absolute{}, root_mean_square{}, r2{}, r2_flight_bias_removed{}, r2_start_bias_removed{};
};

/// Over which a motor's bias is fitted, from a flight's first row.
inline constexpr double start_bias_s = 4;

inline double mean_over_motors(const MotorFigures& figures) {
  double sum = 0;
  for (const double figure : figures) sum += figure / pinnquad::rotor_count;
  return sum;
}

namespace detail {

/// 1 - squares of what is left over squares about the mean; NaN where the target stands still.
inline double explained(double squares, double all_squares) {
  return all_squares > 0 ? 1 - squares / all_squares : pinnquad::not_a_number;
}

inline double squares_about(const std::vector<double>& values, double centre) {
  double sum = 0;
  for (const double value : values) sum += (value - centre) * (value - centre);
  return sum;
}

}  // namespace detail

/// `counts[row]` false: the row is left out. Predictions as many as rows.
inline FlightErrors flight_errors(const pinnquad::RowSet& rows, const Predictions& predictions,
                                  const std::vector<bool>& counts) {
  FlightErrors result;
  for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
    std::vector<double> all_targets, late_targets;
    double absolute = 0, squares = 0, squares_unbiased = 0, spread_in_flights = 0, squares_late = 0;
    std::size_t row = 0;
    for (const pinnquad::FlightRows& piece : rows.pieces()) {
      std::vector<double> errors, targets, start_errors;
      std::vector<bool> late;
      const double begin_s = (*piece.flight)[piece.rows.begin].time_s;
      for (std::size_t i = piece.rows.begin; i < piece.rows.end; ++i, ++row) {
        if (!counts[row]) continue;
        const pinnquad::Sample& sample = (*piece.flight)[i];
        targets.push_back(sample.commands[motor]);
        errors.push_back(predictions[row][motor] - sample.commands[motor]);
        late.push_back(sample.time_s - begin_s >= start_bias_s);
        if (!late.back()) start_errors.push_back(errors.back());
      }
      if (errors.empty()) continue;
      for (const double error : errors) absolute += std::abs(error);
      squares += detail::squares_about(errors, 0);
      squares_unbiased += detail::squares_about(errors, pinnquad::detail::mean_of(errors));
      spread_in_flights += detail::squares_about(targets, pinnquad::detail::mean_of(targets));
      all_targets.insert(all_targets.end(), targets.begin(), targets.end());
      const double start_bias = start_errors.empty() ? 0 : pinnquad::detail::mean_of(start_errors);
      for (std::size_t i = 0; i < errors.size(); ++i) {
        if (!late[i]) continue;
        squares_late += (errors[i] - start_bias) * (errors[i] - start_bias);
        late_targets.push_back(targets[i]);
      }
    }
    const auto count = static_cast<double>(all_targets.size());
    result.rows = all_targets.size();
    result.mean_absolute[motor] = absolute / count;
    result.root_mean_square[motor] = std::sqrt(squares / count);
    const auto about_mean = [](const std::vector<double>& targets) {
      return targets.empty() ? 0.0 : detail::squares_about(targets, pinnquad::detail::mean_of(targets));
    };
    result.r2[motor] = detail::explained(squares, about_mean(all_targets));
    result.r2_flight_bias_removed[motor] = detail::explained(squares_unbiased, spread_in_flights);
    result.r2_start_bias_removed[motor] = detail::explained(squares_late, about_mean(late_targets));
  }
  return result;
}

/// Root mean square over all motors of the rows of each piece that count; NaN where none does.
inline std::vector<double> error_by_flight(const pinnquad::RowSet& rows, const Predictions& predictions,
                                           const std::vector<bool>& counts) {
  std::vector<double> result;
  std::size_t row = 0;
  for (const pinnquad::FlightRows& piece : rows.pieces()) {
    double squares = 0;
    std::size_t count = 0;
    for (std::size_t i = piece.rows.begin; i < piece.rows.end; ++i, ++row) {
      if (!counts[row]) continue;
      for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
        const double error = predictions[row][motor] - (*piece.flight)[i].commands[motor];
        squares += error * error;
        ++count;
      }
    }
    result.push_back(count > 0 ? std::sqrt(squares / static_cast<double>(count)) : pinnquad::not_a_number);
  }
  return result;
}

}  // namespace programs
