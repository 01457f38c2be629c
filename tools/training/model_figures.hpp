// SPDX-License-Identifier: MIT
// The figures of a model that scripts read, by their names: of one model (`pinnquad evaluate --json`), and of a kind of
// model over its seeds (`report.json` of `pinnquad train`). Figures that are not finite are null.
#pragma once

#include <array>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

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
  const char* title = nullptr;                       ///< in print_signs(); null: it stands in print_table()
  double shown_times = 1;
};

inline constexpr std::array<ModelFigure, 10> model_figures = {
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
      "least derivative over nominal"}}};

namespace detail {

/// `value_of(figure, axis)` of each figure, those with axes as {"roll": .., "pitch": .., "yaw": ..}.
template <class ValueOf>
nlohmann::json each_model_figure(const ValueOf& value_of) {
  nlohmann::json result = nlohmann::json::object();
  for (const ModelFigure& figure : model_figures) {
    if (!figure.has_axes) {
      result[figure.name] = value_of(figure, 0);
      continue;
    }
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
      result[figure.name][axis_names[axis]] = value_of(figure, axis);
    }
  }
  return result;
}

}  // namespace detail

/// Of one model: numbers.
inline nlohmann::json figures_of_model(const Judgement& judged) {
  return detail::each_model_figure(
      [&](const ModelFigure& figure, std::size_t axis) { return nlohmann::json(figure.of(judged, axis)); });
}

/// Of all results of a kind of model: {"mean": .., "deviation": .., "per_seed": [..]}. The deviation of fewer than two
/// is null.
inline nlohmann::json figures_over_seeds(const std::vector<Result>& results, const std::string& model) {
  return detail::each_model_figure([&](const ModelFigure& figure, std::size_t axis) {
    std::vector<double> values;
    for (const Result& result : results) {
      if (result.model == model) values.push_back(figure.of(result.test, axis));
    }
    const pinnquad::Summary summary = pinnquad::summarize(values);
    return nlohmann::json{{"mean", summary.mean}, {"deviation", summary.deviation}, {"per_seed", values}};
  });
}

/// The lines of signs below print_table()'s.
inline void print_signs(const std::vector<Result>& results, const std::vector<std::string>& models) {
  for (const ModelFigure& figure : model_figures) {
    if (figure.title == nullptr) continue;
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
      std::printf("  %-*s", label_width, (std::string(figure.title) + ", " + axis_names[axis]).c_str());
      for (const std::string& model : models) {
        std::vector<double> values;
        for (const Result& result : results) {
          if (result.model == model) values.push_back(figure.of(result.test, axis));
        }
        std::printf("  %20s", mean_and_deviation(values, figure.shown_times, 2).c_str());
      }
      std::printf("\n");
    }
  }
}

}  // namespace programs
