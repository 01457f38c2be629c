// SPDX-License-Identifier: MIT
// Pictures of a judgement as SVG, drawn by gnuplot from a script and data that go through a pipe.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "command_line/listed.hpp"
#include "pictures/gnuplot.hpp"
#include "pinnquad/evaluation/physical_consistency.hpp"
#include "training/judgement.hpp"

namespace programs {

/// Fig. 8: signed command sum over angular acceleration, standardised by the target's standard deviation; dots target,
/// plus signs prediction, 3-sigma ellipses with their major axis. One row of panels per model.
inline bool plot_ellipses(const std::string& svg, const std::vector<std::string>& models,
                          const std::vector<std::array<AxisSeries, 3>>& series, const std::vector<Judgement>& judged) {
  std::ostringstream out;
  const int rows = static_cast<int>(models.size());
  out << "set multiplot layout " << rows << ",3\n";
  for (std::size_t model = 0; model < models.size(); ++model) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const AxisSeries& s = series[model][axis];
      const pinnquad::PhysicalConsistency& c = judged[model].axes[axis];
      const auto deviation = pinnquad::axis_deviation(s.angular_acceleration, s.target);
      constexpr std::size_t most_points = 600;  // more only darkens the cloud
      const std::size_t stride = s.target.size() / most_points + 1;
      const auto points = [&](const char* name, const std::vector<double>& sum) {
        out << "$" << name << " << EOD\n";
        for (std::size_t i = 0; i < sum.size(); i += stride) {
          out << s.angular_acceleration[i] / deviation.x << ' ' << sum[i] / deviation.y << '\n';
        }
        out << "EOD\n";
      };
      const auto ellipse = [&](const char* name, const pinnquad::ConfidenceEllipse& e) {
        out << "$" << name << " << EOD\n";
        for (const auto& p : pinnquad::ellipse_outline(e, 121)) out << p[0] << ' ' << p[1] << '\n';
        out << "EOD\n$" << name << "_axis << EOD\n";
        const auto tips = pinnquad::ellipse_outline(e, 3);
        out << tips[0][0] << ' ' << tips[0][1] << '\n' << tips[1][0] << ' ' << tips[1][1] << "\nEOD\n";
      };
      points("target", s.target);
      points("predicted", s.predicted);
      ellipse("target_ellipse", c.target_standardized);
      ellipse("predicted_ellipse", c.predicted_standardized);
      char title[160];
      std::snprintf(title, sizeof title, "%s, %s\\nangle difference %.2f deg, slope error %.1f %%",
                    models[model].c_str(), axis_names[axis], c.angle_difference_deg, 100 * c.slope_error);
      const char* rate = axis == 0 ? "dp/dt" : (axis == 1 ? "dq/dt" : "dr/dt");
      out << "set title \"" << title << "\" noenhanced font ',12'\nset xlabel '" << rate
          << " (in standard deviations of the target)'\n"
          << "set ylabel 'signed command sum'\n"
          << (model == 0 && axis == 0 ? "set key top left font ',10' samplen 1.5 spacing 0.9\n" : "unset key\n")
          << "set xrange [-5:5]\nset yrange [-5:5]\n"
          << "plot $target w p pt 7 ps 0.35 lc rgb '#4f93cf' t 'target', "
          << "$predicted w p pt 1 ps 0.55 lc rgb '#d9742f' t 'prediction', "
          << "$target_ellipse w l lw 2 lc rgb '#0b4a85' t 'target, 3 sigma', "
          << "$predicted_ellipse w l lw 2 lc rgb '#9c3a0a' t 'prediction, 3 sigma', "
          << "$target_ellipse_axis w l dt 2 lw 1.5 lc rgb '#0b4a85' notitle, "
          << "$predicted_ellipse_axis w l dt 2 lw 1.5 lc rgb '#9c3a0a' notitle\n";
    }
  }
  out << "unset multiplot\n";
  return draw_svg(svg,
                  {1200, 60 + 370 * rows, "Signed command sum over angular acceleration, by model and axis",
                   "A row of panels per model (" + listed(models) +
                       "): roll, pitch and yaw, in standard deviations of the target. Dots: target; plus signs: "
                       "prediction; each with "
                       "its 3-sigma ellipse and major axis. The closer the two ellipses, the better."},
                  out.str());
}

/// Fig. 7: mean absolute error of each model, mean and deviation over seeds. Where one model's bar would flatten the
/// others, those have a panel of their own with its own scale, and the picture says so; not where it is one bar alone.
inline bool plot_errors(const std::string& svg, const std::vector<Result>& results,
                        const std::vector<std::string>& models) {
  constexpr double flattened = 1.0 / 3;  // of the highest bar
  struct Bar {
    std::string model, value;
    double mean = 0, deviation = 0;
  };
  std::vector<Bar> bars, small;
  std::vector<std::string> values, large;
  const Figure mae = figures().front();
  double highest = 0;
  for (const std::string& model : models) {
    const pinnquad::Summary s = pinnquad::summarize(over_seeds(results, model, mae));
    char value[32];
    std::snprintf(value, sizeof value, "%.2f", 1e3 * s.mean);
    bars.push_back({model, value, 1e3 * s.mean, s.count > 1 ? 1e3 * s.deviation : 0.0});
    values.push_back(model + " " + value);
    if (std::isfinite(s.mean)) highest = std::max(highest, bars.back().mean);
  }
  for (const Bar& bar : bars) {
    if (bar.mean <= flattened * highest) {
      small.push_back(bar);
    } else {
      large.push_back(bar.model);
    }
  }
  const int panel_width = 125 * static_cast<int>(bars.size());  // names stand beside each other
  if (small.size() < 2) small.clear();
  std::ostringstream out;
  const auto panel = [&out](const std::string& title, const std::vector<Bar>& shown) {
    out << "$errors << EOD\n";
    for (const Bar& bar : shown) {
      out << '"' << bar.model << "\" " << bar.mean << ' ' << bar.deviation << ' ' << bar.value << '\n';
    }
    out << "EOD\nset title \"" << title << "\" noenhanced font ',13'\n"
        << "plot [-0.6:" << static_cast<double>(shown.size()) - 0.4 << "] $errors using 0:2:xtic(1) w boxes lc rgb "
        << "'#1f6fb2', $errors using 0:($2-$3):(0):(2*$3) w vectors heads size screen 0.006,90 lw 1.6 lc rgb "
           "'#303030', "
        << "$errors using 0:($2+$3):4 w labels offset 0,0.7 font ',12' tc rgb '#303030'\n";
  };
  out << "set style fill solid 0.85 noborder\nset boxwidth 0.6\nset yrange [0:*]\nset offsets 0,0,graph 0.08,0\n"
      << "set xtics noenhanced scale 0\nset grid noxtics ytics\nunset key\n"
      << "set ylabel 'mean absolute error of the commands, 1e-3'\n";
  if (small.empty()) {
    panel("", bars);
  } else {
    out << "set multiplot layout 1,2\n";
    panel("all models", bars);
    panel("without " + listed(large) + ": scale of its own", small);
    out << "unset multiplot\n";
  }
  return draw_svg(svg,
                  {std::max(small.empty() ? 700 : 1000, panel_width * (small.empty() ? 1 : 2)), 420,
                   "Mean absolute error of the commands by model",
                   "Mean and deviation over the seeds, in thousandths of the command range: " + listed(values) + "."},
                  out.str());
}

/// Commands of one rotor over some seconds of the test flight: flown and predicted.
inline bool plot_prediction(const std::string& svg, const std::vector<double>& time_s,
                            const std::vector<double>& target, const std::vector<std::string>& models,
                            const std::vector<std::vector<double>>& predicted) {
  static constexpr std::array<const char*, 5> colours = {"#8a8a8a", "#d1541a", "#2a8f4f", "#7b4fb5", "#a8791a"};
  std::ostringstream out;
  out << "$series << EOD\n";
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    out << time_s[i] << ' ' << target[i];
    for (const auto& p : predicted) out << ' ' << p[i];
    out << '\n';
  }
  out << "EOD\nset xlabel 'time, s'\nset ylabel 'command u_1'\nset key top right horizontal noenhanced\n"
      << "plot $series using 1:2 w l lw 3 lc rgb '#4f93cf' t 'flown'";
  for (std::size_t m = 0; m < models.size(); ++m) {
    out << ", $series using 1:" << m + 3 << " w l lw 1.3 lc rgb '" << colours[m % colours.size()] << "' t '"
        << models[m] << "'";
  }
  out << '\n';
  return draw_svg(svg,
                  {1200, 420, "Command of rotor 1 over time, flown and predicted",
                   "Some seconds of the test flight: the command as flown and as predicted by " + listed(models) + "."},
                  out.str());
}

}  // namespace programs
