// SPDX-License-Identifier: MIT
// The page of a comparison of controllers: errors by controller and condition, their ratios, gains found, recoveries.
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "loop/conditions.hpp"
#include "page/chart.hpp"
#include "page/page.hpp"
#include "study/loop_controllers.hpp"
#include "study/loop_summary.hpp"

namespace study {

namespace detail {

namespace colour = programs::colour;
using programs::Chart, programs::Panel, programs::Series, programs::Shape;

inline std::vector<std::string> named_in(const nlohmann::json& entries, const char* key) {
  std::vector<std::string> names;
  for (const nlohmann::json& each : entries) {
    if (std::find(names.begin(), names.end(), each[key]) == names.end()) names.push_back(each[key]);
  }
  return names;
}

inline std::string interval_text(const nlohmann::json& mean) {
  if (mean.is_null()) return "";
  char text[64];
  std::snprintf(text, sizeof text, "%.2f (%.2f to %.2f)", mean["mean"].get<double>(), mean["lower"].get<double>(),
                mean["upper"].get<double>());
  return text;
}

/// One after the other for the controllers, from the first again behind the last.
inline constexpr std::array<const char*, 6> loop_colours = {colour::blue,  colour::orange, colour::green,
                                                            colour::amber, colour::red,    colour::violet};

/// Conditions as rows, controllers as marks.
inline Chart loop_chart(const nlohmann::json& summary, const std::string& gains) {
  static constexpr Shape shapes[] = {Shape::squares, Shape::diamonds, Shape::triangles, Shape::pluses};
  Panel panel;
  panel.x.name = "RMSE of the position, cm";
  panel.x.logarithmic = true;
  panel.y.rows = named_in(summary, "condition");
  const std::vector<std::string> controllers = named_in(summary, "controller");
  for (std::size_t c = 0; c < controllers.size(); ++c) {
    Series series;
    series.name = controllers[c];
    series.colour = loop_colours[c % loop_colours.size()];
    series.shape = shapes[(c / loop_colours.size() + c) % std::size(shapes)];
    for (const nlohmann::json& each : summary) {
      if (each["gains"] != gains || each["controller"] != controllers[c] || each["rmse_cm"].is_null()) continue;
      const auto row = std::find(panel.y.rows.begin(), panel.y.rows.end(), each["condition"]) - panel.y.rows.begin();
      series.x.push_back(each["rmse_cm"]["mean"]);
      series.y.push_back(static_cast<double>(row) +
                         0.07 * (static_cast<double>(c) - 0.5 * static_cast<double>(controllers.size() - 1)));
    }
    panel.series.push_back(series);
  }
  return {"Errors, " + gains + " gains", "Position error of each controller under each condition", {panel}};
}

/// Errors over time of the flights of one condition that changes at half time.
inline Chart recovery_chart(const nlohmann::json& series, const std::string& condition, double half_s) {
  Chart chart{"Recovery", "Position error over time under " + condition, {}};
  for (const char* gains : {"equal", "tuned"}) {
    Panel panel;
    panel.title = std::string(gains) + " gains";
    panel.x.name = "time, s";
    panel.y.name = "error, cm";
    std::size_t count = 0;
    for (const nlohmann::json& each : series) {
      if (each["condition"] != condition || each["gains"] != gains) continue;
      Series line;
      line.name = each["controller"];
      line.colour = loop_colours[count % loop_colours.size()];
      line.dashed = count >= loop_colours.size();
      ++count;
      const std::vector<double> errors_cm = each["error_cm"];
      const double period_s = each["period_s"];
      for (std::size_t i = 0; i < errors_cm.size(); ++i) {
        const double time_s = static_cast<double>(i) * period_s;
        if (time_s < half_s - 3 || time_s > half_s + 8) continue;
        line.x.push_back(time_s);
        line.y.push_back(errors_cm[i]);
      }
      panel.series.push_back(line);
    }
    if (!panel.series.empty()) chart.panels.push_back(panel);
  }
  return chart;
}

}  // namespace detail

/// `result`: what is in loop.json.
inline std::string loop_page(const nlohmann::json& result) {
  const nlohmann::json& summary = result["summary"];
  char plan[400];
  std::snprintf(
      plan, sizeof plan,
      "The vehicle that %s was made for: %s, %s. Seeds 1 to %d, flights of %.0f s, errors of what comes after 10 s. "
      "What controllers see has white noise of %g m, %g m/s, %g rad, %g rad/s and comes %g ms late.",
      result["model"].get<std::string>().c_str(), result["airframe"].get<std::string>().c_str(),
      result["vehicle"].get<std::string>().c_str(), result["seeds"].get<int>(), result["duration_s"].get<double>(),
      result["noise"]["position_m"].get<double>(), result["noise"]["velocity_m_s"].get<double>(),
      result["noise"]["attitude_rad"].get<double>(), result["noise"]["body_rates_rad_s"].get<double>(),
      1e3 * result["delay_s"].get<double>());
  nlohmann::json content = {{"title", "Controllers in the loop"}, {"plan", plan}};
  const std::vector<std::string> controllers = detail::named_in(summary, "controller");
  const std::vector<std::string> conditions = detail::named_in(summary, "condition");
  content["sets"] = nlohmann::json::array();
  for (const std::string& gains : detail::named_in(summary, "gains")) {
    nlohmann::json titles = {"controller"}, tables = nlohmann::json::array();
    for (const std::string& condition : conditions) titles.push_back(condition);
    const auto table = [&](const std::string& name, const auto& text_of) {
      nlohmann::json lines = nlohmann::json::array();
      for (const std::string& controller : controllers) {
        nlohmann::json cells = {controller};
        for (const nlohmann::json& each : summary) {
          if (each["gains"] == gains && each["controller"] == controller) cells.push_back(text_of(each));
        }
        lines.push_back({{"cells", cells}});
      }
      tables.push_back({{"name", name}, {"titles", titles}, {"lines", lines}});
    };
    table("RMSE, cm, geometric mean over trajectories and seeds, 95 % interval", [](const nlohmann::json& each) {
      const int crashed = each["crashed"];
      return each["rmse_cm"].is_null() ? std::string("lost")
                                       : detail::interval_text(each["rmse_cm"]) +
                                             (crashed > 0 ? ", " + std::to_string(crashed) + " lost" : std::string());
    });
    for (const char* base : loop_baselines) {
      if (std::find(controllers.begin(), controllers.end(), base) == controllers.end()) continue;
      table(std::string("Ratio to ") + base + ", the same flights",
            [base](const nlohmann::json& each) { return detail::interval_text(each[std::string("over_") + base]); });
    }
    nlohmann::json found = {
        {"name", "Gains found, as factors of the equal ones"},
        {"titles", {"controller", "position, velocity", "attitude, rates", "learning", "evaluations"}},
        {"lines", nlohmann::json::array()}};
    for (const nlohmann::json& each : result["tuning"]) {
      const auto text = [&each](const char* key) {
        char number[32];
        std::snprintf(number, sizeof number, "%.2f", each[key].get<double>());
        return std::string(number);
      };
      found["lines"].push_back({{"cells",
                                 {each["tuned"], text("outer"), text("inner"), text("learning"),
                                  std::to_string(each["evaluations"].get<int>())}}});
    }
    if (gains == "tuned") tables.push_back(found);
    content["sets"].push_back(
        {{"name", gains == "equal" ? "Equal gains" : "Tuned gains"},
         {"words", gains == "equal" ? "Moderate gains, the same for all."
                                    : "Found for each by the same search on other trajectories and seeds."},
         {"picture", programs::inline_svg(detail::loop_chart(summary, gains))},
         {"tables", tables}});
  }
  content["recoveries"] = nlohmann::json::array();
  for (const std::string& condition : detail::named_in(result["series"], "condition")) {
    content["recoveries"].push_back(
        {{"name", "Recovery: " + condition},
         {"picture", programs::inline_svg(detail::recovery_chart(result["series"], condition,
                                                                 0.5 * result["duration_s"].get<double>()))}});
  }
  const auto described = [&content](const char* key, const auto& all, const std::vector<std::string>& names) {
    content[key] = nlohmann::json::array();
    for (const auto& each : all) {
      if (std::find(names.begin(), names.end(), each.name) == names.end()) continue;
      content[key].push_back({{"name", each.name}, {"summary", each.summary}});
    }
  };
  described("controllers", studied_controllers(), controllers);
  described("conditions", programs::loop_conditions, conditions);
  return programs::text_page("loop_page.html", content);
}

}  // namespace study
