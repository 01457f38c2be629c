// SPDX-License-Identifier: MIT
// Confidence ellipses of flown and predicted command sums over angular accelerations, as an SVG drawing (Fig. 8).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "pictures/drawing.hpp"
#include "pictures/numbers.hpp"
#include "pinnquad/evaluation/physical_consistency.hpp"
#include "training/judgement.hpp"

namespace programs {

/// A row of three panels.
struct EllipsesRow {
  std::string title;  ///< above its panels: "M2"
  std::string name;   ///< to who does not see it: "model 2"
  std::array<AxisSeries, 3> axes;
};

/// `of_each` names what a row is of: "model".
inline std::string ellipses_drawing(const std::vector<EllipsesRow>& models, const std::string& of_each) {
  constexpr double panel = 300, gap = 50, left = 50, top = 38, range = 4.6;
  constexpr std::size_t most_points = 450;
  constexpr std::array<const char*, 3> rates = {"dp/dt", "dq/dt", "dr/dt"};
  std::string text, told;
  for (std::size_t m = 0; m < models.size(); ++m) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const AxisSeries& s = models[m].axes[axis];
      const double x0 = left + static_cast<double>(axis) * (panel + gap),
                   y0 = top + static_cast<double>(m) * (panel + 92);
      const drawing::Axis x{-range, range, x0, x0 + panel}, y{-range, range, y0 + panel, y0};
      const auto deviation = pinnquad::axis_deviation(s.angular_acceleration, s.target);
      const pinnquad::PhysicalConsistency c = pinnquad::physical_consistency(s);
      text += drawing::horizontal_axis(x, y0, y0 + panel, 5, std::string(rates[axis]) + ", target std. dev.") +
              drawing::vertical_axis(y, x0, x0 + panel, 5, "");
      drawing::Trace target, predicted;
      for (std::size_t i = 0; i < s.target.size(); i += s.target.size() / most_points + 1) {
        const double px = s.angular_acceleration[i] / deviation.x;
        const double flown = s.target[i] / deviation.y, said = s.predicted[i] / deviation.y;
        if (std::abs(px) > range) continue;
        if (std::abs(flown) <= range) target.dot(x(px), y(flown));
        if (std::abs(said) <= range) predicted.plus(x(px), y(said));
      }
      text += drawing::path(target.d(), "cloud") + drawing::path(predicted.d(), "plus");
      told += (told.empty() ? "" : "; ") + models[m].name + " " + axis_names[axis] + ": angle difference " +
              shown::number(c.angle_difference_deg, 2) + "°";
      const auto ellipse = [&](const pinnquad::ConfidenceEllipse& e, const std::string& kind) {
        drawing::Trace outline, major;
        for (const auto& p : pinnquad::ellipse_outline(e, 91)) outline.to(x(p[0]), y(p[1]));
        const auto tips = pinnquad::ellipse_outline(e, 3);
        major.to(x(tips[0][0]), y(tips[0][1]));
        major.to(x(tips[1][0]), y(tips[1][1]));
        text += drawing::path(outline.d(), kind) + drawing::path(major.d(), kind + " dash");
      };
      ellipse(c.target_standardized, "first");
      ellipse(c.predicted_standardized, "second");
      text += drawing::label(x0, y0 - 10, models[m].title + ", " + axis_names[axis], "title") +
              drawing::label(x0 + panel, y0 - 10,
                             "Δm " + shown::number(c.angle_difference_deg, 2) + "°, slope error " +
                                 shown::number(100 * c.slope_error, 1) + " %",
                             "small end");
    }
  }
  return drawing::svg(1060, top + static_cast<double>(models.size()) * (panel + 92) - 40, text,
                      "Confidence ellipses of target and prediction",
                      "Signed command sum over angular acceleration in roll, pitch and yaw, one row of panels per " +
                          of_each + "; " + told + ".");
}

}  // namespace programs
