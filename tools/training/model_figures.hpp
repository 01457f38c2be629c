// SPDX-License-Identifier: MIT
// The figures of a model that scripts read, by their names: of one model (`pinnquad evaluate --json`), and of a kind of
// model over its seeds (`report.json` of `pinnquad train`). Figures that are not finite are null.
#pragma once

#include <array>
#include <cstddef>
#include <cstdio>
#include <string>

#include <nlohmann/json.hpp>

#include "pinnquad/evaluation/summary.hpp"
#include "training/judgement.hpp"

namespace programs {

/// Errors in commands of 0 to 1; shares of rows, and of pairs of rows that follow each other; derivatives over the
/// airframe's own in hover.
struct ModelFigure {
  const char* name;
  bool has_axes;
  double (*of)(const Judgement&, std::size_t axis);  ///< axis: 0 where it has none
  const char* title = nullptr;                       ///< in print_figures(); null: it is one of figures()
  double shown_times = 1;
};

inline constexpr std::array<ModelFigure, 11> model_figures = {
    {{"mean_absolute_error", false, [](const Judgement& j, std::size_t) { return j.errors.mean.mean_absolute; }},
     {"rmse", false, [](const Judgement& j, std::size_t) { return j.errors.mean.root_mean_square; }},
     {"r2", false, [](const Judgement& j, std::size_t) { return j.errors.mean.r_squared; }},
     {"slope_error", true, [](const Judgement& j, std::size_t i) { return j.axes[i].slope_error; }},
     {"pair_violations", true, [](const Judgement& j, std::size_t i) { return j.axes[i].sign_violation_share; }},
     {"pair_violations_flown", true, [](const Judgement& j, std::size_t i) { return j.pairs.of_flown[i]; },
      "  of the flown commands", 100},
     {"large_step_violations", true, [](const Judgement& j, std::size_t i) { return j.pairs.large[i]; },
      "violations, % of large steps", 100},
     {"large_step_violations_flown", true, [](const Judgement& j, std::size_t i) { return j.pairs.large_of_flown[i]; },
      "  of the flown commands", 100},
     {"wrong_derivative_share", true, [](const Judgement& j, std::size_t i) { return j.derivatives.wrong_share[i]; },
      "wrong derivatives, % of rows", 100},
     {"least_derivative_over_nominal", true,
      [](const Judgement& j, std::size_t i) { return j.derivatives.least[i] / j.nominal_slopes[i]; },
      "least derivative over nominal"},
     {"median_derivative_over_nominal", true,
      [](const Judgement& j, std::size_t i) { return j.derivatives.median[i] / j.nominal_slopes[i]; },
      "median derivative over nominal"}}};

inline nlohmann::json by_axis(const AxisFigures& values) {
  return {{axis_names[0], values[0]}, {axis_names[1], values[1]}, {axis_names[2], values[2]}};
}

/// Of one model: numbers, those of axes as {"roll": .., "pitch": .., "yaw": ..}.
inline nlohmann::json figures_of_model(const Judgement& judged) {
  nlohmann::json result = nlohmann::json::object();
  for (const ModelFigure& figure : model_figures) {
    if (!figure.has_axes) result[figure.name] = figure.of(judged, 0);
    if (figure.has_axes) {
      result[figure.name] = by_axis({figure.of(judged, 0), figure.of(judged, 1), figure.of(judged, 2)});
    }
  }
  return result;
}

/// Of one model, a line each on standard output.
inline void print_figures(const Judgement& judged) {
  const auto line = [](const std::string& label, double value, int digits) {
    std::printf("%-40s %12.*f\n", label.c_str(), digits, value);
  };
  for (const Figure& figure : figures()) {
    const bool error = figure.name.rfind("mae", 0) == 0 || figure.name.rfind("rmse", 0) == 0;
    const bool share = figure.name.rfind("slope_error", 0) == 0 || figure.name.rfind("sign_", 0) == 0;
    const double value = figure.of(judged);
    line(figure.name + (error   ? ", 1e-3"
                        : share ? ", %"
                                : ""),
         value * (error   ? 1e3
                  : share ? 100
                          : 1),
         error || share ? 2 : 4);
  }
  for (const ModelFigure& figure : model_figures) {
    for (std::size_t axis = 0; figure.title != nullptr && axis < axis_names.size(); ++axis) {
      line(std::string(figure.title) + ", " + axis_names[axis], figure.shown_times * figure.of(judged, axis), 2);
    }
  }
}

}  // namespace programs
