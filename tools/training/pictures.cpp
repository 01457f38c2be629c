// SPDX-License-Identifier: MIT
#include "training/pictures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "command_line/listed.hpp"
#include "page/text.hpp"
#include "pinnquad/evaluation/physical_consistency.hpp"

namespace programs {

Chart ellipses_chart(const std::vector<EllipsesOf>& models) {
  constexpr double range = 4.9;
  constexpr std::size_t most_points = 450;  // more only darkens the cloud
  constexpr std::array<const char*, 3> rates = {"dp/dt", "dq/dt", "dr/dt"};
  Chart chart{"Confidence ellipses of target and prediction, by model and axis", "", {}, 3};
  std::string told;
  for (const EllipsesOf& of : models) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const AxisSeries& s = of.axes[axis];
      const auto deviation = pinnquad::axis_deviation(s.angular_acceleration, s.target);
      const pinnquad::PhysicalConsistency c = pinnquad::physical_consistency(s);
      const std::string angle = shown::number(c.angle_difference_deg, 2) + "°";
      Panel panel;
      panel.title = of.model + ", " + axis_names[axis];
      panel.note = "Δm " + angle + ", slope error " + shown::number(100 * c.slope_error, 1) + " %";
      panel.x = {std::string(rates[axis]) + ", std. dev.", -range, range};
      panel.y = {"S, std. dev.", -range, range};
      panel.height = 0;
      Series target{"target", Shape::dots, colour::blue, {}, {}, 2.4, 0.55};
      Series predicted{"prediction", Shape::pluses, colour::orange, {}, {}, 0.9, 0.7};
      for (std::size_t i = 0; i < s.target.size(); i += s.target.size() / most_points + 1) {
        target.x.push_back(s.angular_acceleration[i] / deviation.x);
        target.y.push_back(s.target[i] / deviation.y);
        predicted.x.push_back(target.x.back());
        predicted.y.push_back(s.predicted[i] / deviation.y);
      }
      panel.series = {target, predicted};
      const auto ellipse = [&](const std::string& name, const char* colour, const pinnquad::ConfidenceEllipse& e) {
        Series outline{name, Shape::line, colour}, major{"", Shape::line, colour};
        major.dashed = true;
        const auto add = [](Series& series, const auto& point) {
          series.x.push_back(point[0]);
          series.y.push_back(point[1]);
        };
        for (const auto& p : pinnquad::ellipse_outline(e, 91)) add(outline, p);
        const auto tips = pinnquad::ellipse_outline(e, 3);
        for (const std::size_t tip : {std::size_t{0}, std::size_t{1}}) add(major, tips[tip]);
        panel.series.insert(panel.series.end(), {outline, major});
      };
      ellipse("target, 3 σ", colour::blue, c.target_standardized);
      ellipse("prediction, 3 σ", colour::orange, c.predicted_standardized);
      told += "; " + of.model + " " + axis_names[axis] + ": angle difference " + angle;
      chart.panels.push_back(panel);
    }
  }
  chart.description =
      "Signed command sum S over angular acceleration in roll, pitch and yaw, in standard deviations of the target: "
      "dots and plus signs, ellipses, dashed their major axes; the closer the two ellipses, the better" +
      told + ".";
  return chart;
}

Chart errors_chart(const std::string& title, const std::string& axis, const std::vector<ErrorBar>& bars, double most,
                   int decimals) {
  Panel panel;
  panel.x = {axis, 0, most};
  Series references{"the paper", Shape::diamonds, colour::orange};
  std::vector<std::string> told;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const ErrorBar& bar = bars[i];
    const auto row = static_cast<double>(i);
    std::string value = std::isfinite(bar.mean) ? shown::number(bar.mean, decimals) : "no figure";
    told.push_back(bar.name + " " + value);
    if (bar.mean > most && std::isfinite(bar.reference))
      value += "; the paper " + shown::number(bar.reference, decimals);
    const bool has_reference = std::isfinite(bar.reference) && bar.reference <= most;
    panel.y.rows.push_back(bar.name);
    panel.series.push_back(
        {"", Shape::bars, bar.colour, {bar.mean}, {row - (has_reference ? 0.16 : 0)}, 13, bar.opacity});
    if (bar.mean <= most) panel.series.back().deviation = {bar.deviation};
    panel.series.back().labels = {value};
    if (!has_reference) continue;
    references.x.push_back(bar.reference);
    references.y.push_back(row + 0.26);
    references.deviation.push_back(bar.reference_deviation);
  }
  if (!references.x.empty()) panel.series.push_back(references);
  return {title, axis + ": " + listed(told) + ".", {panel}};
}

}  // namespace programs
