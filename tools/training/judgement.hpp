// SPDX-License-Identifier: MIT
// How good one model is on rows that it was not trained on.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "command_line/in_words.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/dynamics/allocation.hpp"
#include "pinnquad/evaluation/judgement.hpp"
#include "pinnquad/evaluation/summary.hpp"

namespace programs {

constexpr std::array<const char*, 3> axis_names = {"roll", "pitch", "yaw"};
/// Of the four commands: all of one sign, then those about the axes.
constexpr std::array<const char*, 4> sum_names = {"thrust", "roll", "pitch", "yaw"};

/// Signs of the commands in each of these sums.
inline std::array<std::array<double, pinnquad::rotor_count>, 4> sum_signs(const pinnquad::Airframe<double>& airframe) {
  const auto about = pinnquad::axis_signs(airframe);
  return {{{1, 1, 1, 1}, about[0], about[1], about[2]}};
}

using pinnquad::axis_series;
using pinnquad::AxisSeries;
using pinnquad::judge;
using pinnquad::no_axis_figures;
using pinnquad::pair_signs;
using AxisFigures = std::array<double, 3>;  ///< of roll, pitch and yaw
using PairSigns = pinnquad::Judgement::PairSigns;

/// Commands of every row of a block, one model's.
using Predictions = std::vector<pinnquad::Commands<double>>;

/// Exact derivatives of the signed command sums by the angular acceleration, over the rows (training/derivatives.hpp).
struct DerivativeFigures {
  AxisFigures wrong_share = no_axis_figures;  ///< of the rows: where it is below 0
  AxisFigures least = no_axis_figures;        ///< s^2/rad
  AxisFigures median = no_axis_figures;
  bool sees_acceleration = false;  ///< false: all are 0, it does not look at the angular acceleration
};

/// The library's judgement, and the derivatives: NaN until they were asked.
struct Judgement : pinnquad::Judgement {
  Judgement() = default;
  Judgement(const pinnquad::Judgement& judged)
      : pinnquad::Judgement(judged) {}  // NOLINT: the same, but for derivatives
  DerivativeFigures derivatives;
};

/// Rows of a set, and what was predicted for them.
struct PredictedRows {
  pinnquad::RowSet rows;
  Predictions predictions;
};

/// Those that count.
inline PredictedRows rows_that_count(const pinnquad::RowSet& rows, const Predictions& predictions,
                                     const std::vector<bool>& counts) {
  PredictedRows result;
  std::size_t row = 0;
  for (const pinnquad::FlightRows& piece : rows.pieces()) {
    std::size_t begin = piece.rows.begin;
    for (std::size_t i = piece.rows.begin; i < piece.rows.end; ++i, ++row) {
      if (counts[row]) {
        result.predictions.push_back(predictions[row]);
        continue;
      }
      result.rows.add(*piece.flight, {begin, i});
      begin = i + 1;
    }
    result.rows.add(*piece.flight, {begin, piece.rows.end});
  }
  return result;
}

/// A figure of a Judgement with its column name: the one list behind table, CSV and JSON.
struct Figure {
  std::string name;
  std::function<double(const Judgement&)> of;
};

inline std::vector<Figure> figures() {
  using Errors = pinnquad::detail::ErrorMeasures;
  using Consistency = pinnquad::PhysicalConsistency;
  constexpr std::pair<const char*, double Errors::*> of_errors[] = {
      {"mae", &Errors::mean_absolute}, {"rmse", &Errors::root_mean_square}, {"r2", &Errors::r_squared}};
  constexpr std::pair<const char*, double Consistency::*> of_axes[] = {
      {"angle_difference_deg", &Consistency::angle_difference_deg},
      {"raw_angle_difference_deg", &Consistency::raw_angle_difference_deg},
      {"slope_error", &Consistency::slope_error},
      {"correlation", &Consistency::predicted_correlation},
      {"target_correlation", &Consistency::target_correlation},
      {"sign_violation_share", &Consistency::sign_violation_share}};
  std::vector<Figure> list;
  for (const auto& [name, of] : of_errors) {
    list.push_back({name, [of = of](const Judgement& j) { return j.errors.mean.*of; }});
  }
  for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
    for (const auto& [name, of] : of_errors) {
      list.push_back({std::string(name) + "_u" + std::to_string(motor + 1),
                      [of = of, motor](const Judgement& j) { return j.errors.per_motor[motor].*of; }});
    }
  }
  for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
    for (const auto& [name, of] : of_axes) {
      list.push_back({std::string(name) + "_" + axis_names[axis],
                      [of = of, axis](const Judgement& j) { return j.axes[axis].*of; }});
    }
  }
  return list;
}

inline std::string decimals(double value, int digits) { return in_words("%.*f", digits, value); }

/// "27.5e-3" of 0.0275.
inline std::string thousandths(double value, int digits) { return decimals(1e3 * value, digits) + "e-3"; }

/// "12.34 +- 0.56", or without deviation for a single value.
inline std::string mean_and_deviation(const std::vector<double>& values, double scale, int digits) {
  const pinnquad::Summary summary = pinnquad::summarize(values);
  const std::string mean = decimals(scale * summary.mean, digits);
  return summary.count < 2 ? mean : mean + " +- " + decimals(scale * summary.deviation, digits);
}

}  // namespace programs
