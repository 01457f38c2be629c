// SPDX-License-Identifier: MIT
// Picture of the command `beyond`: errors over those of the paper's network, and how far off the closed loop flies.
#pragma once

#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "pictures/gnuplot.hpp"
#include "study/beyond_summary.hpp"

namespace study {

namespace detail {

struct DrawnModel {
  const char* name;
  const char* colour;
  int point;  ///< gnuplot's type
};

/// As gnuplot takes a text between single quotes.
inline std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "''" : std::string(1, c);
  return result + "'";
}

/// A panel: a place per condition, a point per model; empty where no model has a figure. `value_of(entry)`: NaN where
/// there is none.
template <std::size_t Count, class ValueOf>
std::string panel(const nlohmann::json& found, const std::vector<Condition>& conditions,
                  const std::array<DrawnModel, Count>& models, const ValueOf& value_of) {
  std::ostringstream names, data, plots;
  int place = 0;
  std::array<bool, Count> stands{};
  for (const Condition& condition : conditions) {
    if (!found.contains(condition.name)) continue;
    std::ostringstream line;
    bool any = false;
    for (std::size_t i = 0; i < Count; ++i) {
      const nlohmann::json& of_models = found[condition.name];
      const double value =
          of_models.contains(models[i].name) ? value_of(of_models[models[i].name]) : pinnquad::not_a_number;
      any = any || std::isfinite(value);
      stands[i] = stands[i] || std::isfinite(value);
      line << ' ' << (std::isfinite(value) ? std::to_string(value) : "NaN");
    }
    if (!any) continue;
    names << (place > 0 ? ", " : "") << quoted(condition.name) << ' ' << place;
    data << place++ << line.str() << '\n';
  }
  if (place == 0) return {};
  for (std::size_t i = 0; i < Count; ++i) {
    if (!stands[i]) continue;
    plots << (plots.str().empty() ? "" : ", ") << "$found using ($1+"
          << 0.09 * (static_cast<double>(i) - 0.5 * (Count - 1)) << "):" << i + 2 << " with points pt "
          << models[i].point << " ps 1 lc rgb '" << models[i].colour << "' title '" << models[i].name << "'";
  }
  std::ostringstream out;
  out << "$found << EOD\n"
      << data.str() << "EOD\nset xtics (" << names.str() << ")\nset xrange [-0.6:" << place - 0.4 << "]\nplot "
      << plots.str() << '\n';
  return out.str();
}

inline double mean_of(const nlohmann::json& entry, const char* figure, const char* what) {
  const auto found = entry.at(figure).find(what);
  return found != entry.at(figure).end() && found->is_number() ? found->get<double>() : pinnquad::not_a_number;
}

}  // namespace detail

/// False, after one line on stderr, where gnuplot is missing or failed.
inline bool draw_found(const std::string& svg, const nlohmann::json& found, const std::vector<Condition>& conditions) {
  constexpr std::array<detail::DrawnModel, 6> judged = {{{"vanilla", "#9a9a9a", 6},
                                                         {"vanilla_mirrored", "#b07aa1", 12},
                                                         {"vanilla_physics", "#e0a526", 4},
                                                         {"inverse", "#59a14f", 8},
                                                         {"ridge", "#1f6fb2", 10},
                                                         {"structured", "#d1541a", 7}}};
  constexpr std::array<detail::DrawnModel, 5> flown = {{{"none", "#9a9a9a", 2},
                                                        {"inverse", "#59a14f", 8},
                                                        {"vanilla", "#b8b8b8", 6},
                                                        {yardstick, "#1f6fb2", 5},
                                                        {"structured", "#d1541a", 7}}};
  const std::string errors = detail::panel(found, conditions, judged, [](const nlohmann::json& entry) {
    return detail::mean_of(entry, "mean_absolute_error", "ratio");
  });
  const std::string loop = detail::panel(found, conditions, flown, [](const nlohmann::json& entry) {
    return 100 * detail::mean_of(entry, "eight_rmse_m", "mean");
  });
  const int panels = (errors.empty() ? 0 : 1) + (loop.empty() ? 0 : 1);
  if (panels == 0) return false;
  std::string script =
      "set tics font ',11' tc rgb '#303030'\nset xtics rotate by 35 right scale 0 noenhanced\nset logscale y\n"
      "set key outside right top samplen 1 noenhanced\nset multiplot layout " +
      std::to_string(panels) + ",1\n";
  if (!errors.empty()) {
    script +=
        "set ylabel \"error over the paper network's\"\nset arrow 1 from graph 0, first 1 to graph 1, first 1 "
        "nohead dt 2 lc rgb '#707070'\n" +
        errors + "unset arrow 1\n";
  }
  if (!loop.empty()) script += "set ylabel 'RMSE on the figure-eight, cm'\n" + loop;
  script += "unset multiplot\n";
  return programs::draw_svg(
      svg,
      {900, 340 * panels, "Beyond the paper",
       "Above, per condition: mean absolute error of each model over that of the paper's network. "
       "Below: position error in the closed loop with the model as feed-forward."},
      script);
}

}  // namespace study
