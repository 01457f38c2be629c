// SPDX-License-Identifier: MIT
// How good one model is on rows that it was not trained on.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "command_line/in_words.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/dynamics/rotor.hpp"
#include "pinnquad/evaluation/judgement.hpp"
#include "pinnquad/evaluation/summary.hpp"

namespace programs {

constexpr std::array<const char*, 3> axis_names = {"roll", "pitch", "yaw"};
/// Of the four commands: all of one sign, then those about the axes.
constexpr std::array<const char*, 4> sum_names = {"thrust", "roll", "pitch", "yaw"};

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
  double (*of)(const Judgement&, std::size_t axis_or_motor);
  std::size_t index;
};

inline std::vector<Figure> figures() {
  std::vector<Figure> list = {
      {"mae", [](const Judgement& j, std::size_t) { return j.errors.mean.mean_absolute; }, 0},
      {"rmse", [](const Judgement& j, std::size_t) { return j.errors.mean.root_mean_square; }, 0},
      {"r2", [](const Judgement& j, std::size_t) { return j.errors.mean.r_squared; }, 0}};
  for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
    const std::string suffix = "_u" + std::to_string(motor + 1);
    list.push_back(
        {"mae" + suffix, [](const Judgement& j, std::size_t i) { return j.errors.per_motor[i].mean_absolute; }, motor});
    list.push_back({"rmse" + suffix,
                    [](const Judgement& j, std::size_t i) { return j.errors.per_motor[i].root_mean_square; }, motor});
    list.push_back(
        {"r2" + suffix, [](const Judgement& j, std::size_t i) { return j.errors.per_motor[i].r_squared; }, motor});
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string suffix = std::string("_") + axis_names[axis];
    list.push_back({"angle_difference_deg" + suffix,
                    [](const Judgement& j, std::size_t i) { return j.axes[i].angle_difference_deg; }, axis});
    list.push_back({"raw_angle_difference_deg" + suffix,
                    [](const Judgement& j, std::size_t i) { return j.axes[i].raw_angle_difference_deg; }, axis});
    list.push_back(
        {"slope_error" + suffix, [](const Judgement& j, std::size_t i) { return j.axes[i].slope_error; }, axis});
    list.push_back({"correlation" + suffix,
                    [](const Judgement& j, std::size_t i) { return j.axes[i].predicted_correlation; }, axis});
    list.push_back({"target_correlation" + suffix,
                    [](const Judgement& j, std::size_t i) { return j.axes[i].target_correlation; }, axis});
    list.push_back({"sign_violation_share" + suffix,
                    [](const Judgement& j, std::size_t i) { return j.axes[i].sign_violation_share; }, axis});
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
