// SPDX-License-Identifier: MIT
// How good one model is on the test flight, and the tables that compare models over seeds.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "pinnquad/data/csv.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/dynamics/rotor.hpp"
#include "pinnquad/evaluation/judgement.hpp"
#include "pinnquad/evaluation/paired_test.hpp"
#include "pinnquad/evaluation/summary.hpp"
#include "pinnquad/io/csv_table.hpp"

namespace programs {

constexpr std::array<const char*, 3> axis_names = {"roll", "pitch", "yaw"};

using pinnquad::axis_series;
using pinnquad::AxisSeries;
using pinnquad::judge;
using pinnquad::no_axis_figures;
using pinnquad::pair_signs;
using AxisFigures = std::array<double, 3>;  ///< of roll, pitch and yaw
using PairSigns = pinnquad::Judgement::PairSigns;

/// Commands of every row of a block, one model's.
using Predictions = std::vector<pinnquad::Commands<double>>;

/// Exact derivatives of the signed command sums over the rows (training/derivatives.hpp).
struct DerivativeFigures {
  AxisFigures wrong_share = no_axis_figures;  ///< of the rows: where it is below 0
  AxisFigures least = no_axis_figures;        ///< s^2/rad
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

/// One row of results.csv: a model of one seed.
struct Result {
  std::string model;
  std::uint64_t seed = 0;
  Judgement test;
  double validation_error = 0;  ///< mean absolute error on the validation rows
  double training_s = 0;
};

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

/// One figure of one model over its seeds.
inline std::vector<double> over_seeds(const std::vector<Result>& results, const std::string& model,
                                      const Figure& figure) {
  std::vector<double> values;
  for (const Result& result : results) {
    if (result.model == model) values.push_back(figure.of(result.test, figure.index));
  }
  return values;
}

/// The best result of a model by its validation error, the test block has no say; none if no error is finite.
inline std::optional<std::size_t> best_of(const std::vector<Result>& results, const std::string& model) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].model != model || !std::isfinite(results[i].validation_error)) continue;
    if (!best || results[i].validation_error < results[*best].validation_error) best = i;
  }
  return best;
}

/// "12.34 +- 0.56", or without deviation for a single value.
inline std::string mean_and_deviation(const std::vector<double>& values, double scale, int digits) {
  const pinnquad::Summary summary = pinnquad::summarize(values);
  char text[64];
  if (summary.count < 2) {
    std::snprintf(text, sizeof text, "%.*f", digits, scale * summary.mean);
  } else {
    std::snprintf(text, sizeof text, "%.*f +- %.*f", digits, scale * summary.mean, digits, scale * summary.deviation);
  }
  return text;
}

/// Of the tables' first column: the longest label fits.
inline constexpr int label_width = 38;

/// Prints the comparison on stdout: rows are figures, columns models.
inline void print_table(const std::vector<Result>& results, const std::vector<std::string>& models) {
  const auto line = [&](const std::string& label, const std::string& figure_name, double scale, int digits) {
    std::printf("  %-*s", label_width, label.c_str());
    for (const Figure& figure : figures()) {
      if (figure.name != figure_name) continue;
      for (const std::string& model : models) {
        std::printf("  %20s", mean_and_deviation(over_seeds(results, model, figure), scale, digits).c_str());
      }
    }
    std::printf("\n");
  };
  std::printf("  %-*s", label_width, "test flight, mean +- deviation");
  for (const std::string& model : models) std::printf("  %20s", model.c_str());
  std::printf("\n");
  line("mean absolute error, 1e-3", "mae", 1e3, 2);
  line("RMSE, 1e-3", "rmse", 1e3, 2);
  line("R^2", "r2", 1, 4);
  for (int motor = 1; motor <= pinnquad::rotor_count; ++motor) {
    const std::string name = "u" + std::to_string(motor);
    line("  " + name + ": mean absolute error, 1e-3", "mae_" + name, 1e3, 2);
    line("  " + name + ": RMSE, 1e-3", "rmse_" + name, 1e3, 2);
    line("  " + name + ": R^2", "r2_" + name, 1, 4);
  }
  const auto per_axis = [&](const char* label, const char* figure, double scale, int digits) {
    for (const char* axis : axis_names)
      line(std::string(label) + ", " + axis, std::string(figure) + "_" + axis, scale, digits);
  };
  per_axis("ellipse angle difference, deg", "angle_difference_deg", 1, 3);
  per_axis("slope error, %", "slope_error", 100, 2);
  per_axis("correlation (PCC)", "correlation", 1, 4);
  per_axis("  of the flown commands", "target_correlation", 1, 4);
  per_axis("sign violations, % of pairs", "sign_violation_share", 100, 2);
}

/// Prints candidate against baseline, seed by seed. A seed that has no finite figure of both is left out and counted.
inline void print_paired(const std::vector<Result>& results, const std::string& candidate,
                         const std::string& baseline) {
  std::printf("  %s against %s, paired over seeds (lower is better):\n", candidate.c_str(), baseline.c_str());
  for (const Figure& figure : figures()) {
    const bool compared = figure.name == "mae" || figure.name == "rmse" ||
                          figure.name.rfind("angle_difference_deg", 0) == 0 ||
                          figure.name.rfind("slope_error", 0) == 0 || figure.name.rfind("sign_violation_share", 0) == 0;
    if (!compared) continue;
    std::vector<double> of_candidate, of_baseline;
    std::size_t undefined = 0;
    for (const Result& a : results) {
      for (const Result& b : results) {
        if (a.model != candidate || b.model != baseline || a.seed != b.seed) continue;
        const double x = figure.of(a.test, figure.index), y = figure.of(b.test, figure.index);
        if (!std::isfinite(x - y)) {
          ++undefined;
          continue;
        }
        of_candidate.push_back(x);
        of_baseline.push_back(y);
      }
    }
    if (undefined > 0) std::printf("    %-32s undefined for %zu seeds\n", figure.name.c_str(), undefined);
    if (of_candidate.empty()) continue;
    const pinnquad::PairedComparison c = pinnquad::compare_paired(of_candidate, of_baseline);
    std::printf("    %-32s %+7.2f %%   better in %zu of %zu, p = %.3f\n", figure.name.c_str(),
                100 * c.relative_difference, c.wins, c.pairs, c.p_value);
  }
}

/// results.csv: one row per finished training, whole or not at all.
inline void write_results(const std::string& path, const std::vector<Result>& results) {
  using pinnquad::number_text;
  const std::vector<Figure> list = figures();
  std::vector<std::string> cells = {"model", "seed"};
  for (const Figure& figure : list) cells.push_back(figure.name);
  cells.insert(cells.end(), {"validation_mae", "training_s"});
  std::string text = pinnquad::csv_line(cells);
  for (const Result& result : results) {
    cells = {result.model, std::to_string(result.seed)};
    for (const Figure& figure : list) cells.push_back(number_text(figure.of(result.test, figure.index)));
    cells.insert(cells.end(), {number_text(result.validation_error), number_text(result.training_s)});
    text += pinnquad::csv_line(cells);
  }
  pinnquad::AtomicFile file(path);
  file.stream() << text;
  file.commit();
}

}  // namespace programs
