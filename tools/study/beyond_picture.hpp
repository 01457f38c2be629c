// SPDX-License-Identifier: MIT
// Picture of the command `beyond`: errors over those of the paper's network, and how far off the closed loop flies.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "study/beyond_summary.hpp"
#include "training/pictures.hpp"

namespace study {

/// Ratios of the errors of one condition as bars; a log scale would hide what is gained.
inline programs::Chart ratios_chart(const nlohmann::json& models, const std::vector<BeyondModel>& order) {
  std::vector<programs::ErrorBar> bars;
  for (const BeyondModel& model : order) {
    const nlohmann::json::json_pointer place("/" + model.name + "/mean_absolute_error/ratio");
    if (!models.contains(place)) continue;
    bars.push_back({model.name});
    bars.back().mean = models[place].get<double>();
  }
  return programs::errors_chart("Errors over the paper's network", "mean absolute error over the paper network's", bars,
                                1.5, 2);
}

namespace detail {

/// A row per condition, a mark per model. `value_of(entry)`: NaN where there is no figure.
template <class ValueOf>
programs::Panel panel(const nlohmann::json& found, const std::vector<Condition>& conditions,
                      std::vector<programs::Series> models, const ValueOf& value_of) {
  programs::Panel panel;
  panel.x.logarithmic = true;
  for (const Condition& condition : conditions) {
    if (!found.contains(condition.name)) continue;
    const nlohmann::json& of_models = found[condition.name];
    const auto row = static_cast<double>(panel.y.rows.size());
    bool any = false;
    for (std::size_t i = 0; i < models.size(); ++i) {
      const auto entry = of_models.find(models[i].name);
      const double value = entry == of_models.end() ? pinnquad::not_a_number : value_of(*entry);
      if (!std::isfinite(value)) continue;
      models[i].x.push_back(value);
      models[i].y.push_back(row + 0.1 * (static_cast<double>(i) - 0.5 * static_cast<double>(models.size() - 1)));
      any = true;
    }
    if (any) panel.y.rows.push_back(condition.name);
  }
  for (const programs::Series& series : models) {
    if (!series.x.empty()) panel.series.push_back(series);
  }
  return panel;
}

inline double mean_of(const nlohmann::json& entry, const char* figure, const char* what) {
  const auto found = entry.at(figure).find(what);
  return found != entry.at(figure).end() && found->is_number() ? found->get<double>() : pinnquad::not_a_number;
}

}  // namespace detail

/// Draws what was found; nothing where nothing was.
inline void draw_found(const std::string& svg, const nlohmann::json& found, const std::vector<Condition>& conditions) {
  using programs::Shape;
  namespace colour = programs::colour;
  programs::Panel errors =
      detail::panel(found, conditions,
                    {{"vanilla", Shape::dots, colour::muted, {}, {}, 7},
                     {"vanilla_mirrored", Shape::pluses, colour::violet, {}, {}, 2},
                     {"vanilla_physics", Shape::squares, colour::amber},
                     {"inverse", Shape::triangles, colour::green},
                     {"ridge", Shape::diamonds, colour::blue},
                     {"structured", Shape::dots, colour::orange, {}, {}, 7}},
                    [](const nlohmann::json& entry) { return detail::mean_of(entry, "mean_absolute_error", "ratio"); });
  programs::Panel loop =
      detail::panel(found, conditions,
                    {{"none", Shape::strokes, colour::text},
                     {"inverse", Shape::triangles, colour::green},
                     {"vanilla", Shape::dots, colour::muted, {}, {}, 7},
                     {yardstick, Shape::squares, colour::blue},
                     {"structured", Shape::dots, colour::orange, {}, {}, 7}},
                    [](const nlohmann::json& entry) { return 100 * detail::mean_of(entry, "eight_rmse_m", "mean"); });
  errors.x.name = "error over the paper network's";
  loop.x.name = "RMSE on the figure-eight, cm";
  errors.series.push_back(
      {"", Shape::line, colour::muted, {1, 1}, {-0.5, static_cast<double>(errors.y.rows.size()) - 0.5}});
  programs::Chart chart{"Beyond the paper",
                        "Above, per condition: mean absolute error of each model over that of the paper's network. "
                        "Below: position error in the closed loop with the model as feed-forward."};
  for (const programs::Panel& panel : {errors, loop}) {
    if (!panel.y.rows.empty()) chart.panels.push_back(panel);
  }
  if (!chart.panels.empty()) programs::write_svg(svg, chart);
}

}  // namespace study
