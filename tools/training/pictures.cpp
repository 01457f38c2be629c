// SPDX-License-Identifier: MIT
#include "training/pictures.hpp"

#include <cstddef>

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
        target.add(s.angular_acceleration[i] / deviation.x, s.target[i] / deviation.y);
        predicted.add(target.x.back(), s.predicted[i] / deviation.y);
      }
      panel.series = {target, predicted};
      const auto ellipse = [&](const std::string& name, const char* colour, const pinnquad::ConfidenceEllipse& e) {
        Series outline{name, Shape::line, colour}, major = outline;
        major.dashed = true;
        for (const auto& p : pinnquad::ellipse_outline(e, 91)) outline.add(p[0], p[1]);
        const auto tips = pinnquad::ellipse_outline(e, 3);
        for (const std::size_t tip : {std::size_t{0}, std::size_t{1}}) major.add(tips[tip][0], tips[tip][1]);
        panel.series.insert(panel.series.end(), {major, outline});
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

}  // namespace programs
