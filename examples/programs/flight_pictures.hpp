// SPDX-License-Identifier: MIT
// Pictures of a flight as the paper has them: trajectory (Fig. 4 d), correlation (Fig. 2), ground effect (Fig. 5), wind
// (Fig. 6).
#pragma once

#include <array>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "flight_trace.hpp"
#include "gnuplot.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/dynamics/rotor.hpp"
#include "pinnquad/evaluation/correlation.hpp"

namespace programs {

namespace detail {

/// Every n-th row, so that a picture has no more points than the eye.
inline std::size_t stride_for(std::size_t rows, std::size_t most) { return rows / most + 1; }

/// A panel of a page, in shares of its height and width.
inline std::string panel(double left, double right, double top, double bottom) {
  char text[200];
  std::snprintf(text, sizeof text,
                "set lmargin at screen %.4f\nset rmargin at screen %.4f\nset tmargin at screen %.4f\n"
                "set bmargin at screen %.4f\n",
                left, right, top, bottom);
  return text;
}

/// Shades the three blocks of the 60/20/20 split over a time axis, named along the upper edge.
inline std::string shaded_split(const std::vector<double>& time_s, bool named) {
  const pinnquad::DatasetSplit split = pinnquad::split_contiguous(time_s.size());
  struct Block {
    const char* name;
    const char* colour;
    pinnquad::IndexRange range;
  };
  const std::array<Block, 3> blocks = {{{"training", "#e8f1fa", split.train},
                                        {"validation", "#fdf1dd", split.validation},
                                        {"test", "#e6f4e8", split.test}}};
  std::ostringstream out;
  int number = 1;
  for (const Block& block : blocks) {
    const double from = block.range.begin == 0 ? 0 : time_s[block.range.begin], to = time_s[block.range.end - 1];
    out << "set object " << number << " rectangle from first " << from << ", graph 0 to first " << to
        << ", graph 1 behind fc rgb '" << block.colour << "' fs solid noborder\n";
    if (named) {
      out << "set label " << number << " '" << block.name << "' at first " << (from + to) / 2
          << ", graph 1.0 center offset 0,0.6 font ',11' tc rgb '#505050'\n";
    }
    ++number;
  }
  return out.str();
}

inline std::string no_labels() { return "unset label\n"; }

}  // namespace detail

/// Fig. 4 (d): the flown path in space, coloured by speed.
inline bool plot_trajectory(const std::string& svg, const std::vector<TraceRow>& trace) {
  std::ostringstream out;
  const std::size_t stride = detail::stride_for(trace.size(), 1500);
  out << "$path << EOD\n";
  for (std::size_t i = 0; i < trace.size(); i += stride) {
    const TraceRow& row = trace[i];
    char line[96];
    std::snprintf(line, sizeof line, "%.2f %.2f %.3f %.2f\n", row.position_m[1], row.position_m[0], row.height_m,
                  row.speed_m_s);
    out << line;
  }
  out << "EOD\nset palette defined (0 '#2c3e8f', 0.35 '#2a9d8f', 0.7 '#e9b44c', 1 '#c8321a')\n"
      << "set xlabel 'east, m' offset 0,-0.5\nset ylabel 'north, m' offset 0,-0.5\n"
      << "set zlabel 'height above ground, m' rotate offset -1,0\n"
      << "set cblabel 'speed, m/s' offset 0.8,0\nset cbrange [0:*]\nset zrange [0:*]\nset xyplane at 0\n"
      << "set view 62,38,1.0,0.95\nset ticslevel 0\nset grid x y z\nunset key\n"
      << "splot $path using 1:2:3:4 with lines lw 1.1 lc palette\n";
  return draw_svg(svg, 860, 640, out.str());
}

/// Fig. 2: angular acceleration and signed command sum over some seconds, and over each other with their PCC.
inline bool plot_correlation(const std::string& svg, const pinnquad::Flight& flight,
                             const pinnquad::Airframe<double>& airframe) {
  constexpr std::array<const char*, 3> names = {"roll", "pitch", "yaw"}, rates = {"dp/dt", "dq/dt", "dr/dt"};
  constexpr std::array<double, 3> tops = {0.945, 0.63, 0.315};
  constexpr double panel_height = 0.225;
  constexpr std::size_t shown_rows = 240, cloud_points = 700;
  const std::size_t first = flight.size() > 3 * shown_rows ? flight.size() / 3 : 0;
  const std::size_t last = first + shown_rows < flight.size() ? first + shown_rows : flight.size();
  std::ostringstream out;
  out << "set multiplot\n";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::array<double, pinnquad::rotor_count> signs =
        pinnquad::allocation_signs(airframe, static_cast<int>(axis));
    std::vector<double> accelerations, sums;
    for (const pinnquad::Sample& sample : flight) {
      accelerations.push_back(sample.angular_acceleration_rad_s2[static_cast<int>(axis)]);
      sums.push_back(pinnquad::signed_sum(signs, sample.commands));
    }
    const auto line = [&](double x, std::size_t i) {
      char text[96];
      std::snprintf(text, sizeof text, "%.2f %.3f %.4f\n", x, accelerations[i], sums[i]);
      out << text;
    };
    out << "$series << EOD\n";
    for (std::size_t i = first; i < last; ++i) line(flight[i].time_s, i);
    out << "EOD\n$cloud << EOD\n";
    for (std::size_t i = 0; i < flight.size(); i += detail::stride_for(flight.size(), cloud_points)) line(0, i);
    out << "EOD\n";
    std::string sum = "S = ";
    for (std::size_t i = 0; i < signs.size(); ++i) {
      sum += (signs[i] < 0 ? "-" : (i == 0 ? "" : "+")) + ("u_" + std::to_string(i + 1));
    }
    const bool lowest = axis == 2;
    const double top = tops[axis], bottom = top - panel_height;
    out << detail::panel(0.07, 0.60, top, bottom) << "unset label\nset autoscale\n"
        << "set title '" << names[axis] << ":  " << sum << "' font ',13' offset 0,-0.6\n"
        << "set xlabel " << (lowest ? "'time, s'" : "''") << "\nset ylabel '" << rates[axis]
        << ", rad/s^2' tc rgb '#1f6fb2' offset 1.2,0\nset ytics nomirror tc rgb '#1f6fb2'\n"
        << "set y2label 'S' tc rgb '#d1541a' offset -1.2,0\nset y2tics nomirror tc rgb '#d1541a'\nunset key\n"
        << "stats $series using 2 nooutput\nm = 1.1*(abs(STATS_min) > STATS_max ? abs(STATS_min) : STATS_max)\n"
        << "set yrange [-m:m]\n"
        << "stats $series using 3 nooutput\nm = 1.1*(abs(STATS_min) > STATS_max ? abs(STATS_min) : STATS_max)\n"
        << "set y2range [-m:m]\nset xrange [" << flight[first].time_s << ":" << flight[last - 1].time_s << "]\n"
        << "plot $series using 1:2 w l lw 1.4 lc rgb '#1f6fb2', $series using 1:3 axes x1y2 w l lw 1.4 lc rgb '#d1541a'\n"
        << detail::panel(0.755, 0.975, top, bottom);
    char label[120];
    std::snprintf(label, sizeof label,
                  "set label 'PCC %.3f' at graph 0.05, graph 0.90 left font ',13' tc rgb '#303030' front boxed\n",
                  pinnquad::pearson_correlation(accelerations, sums));
    out << "set style textbox opaque noborder fillcolor rgb '#f0f0f0' margins 0.8,0.5\n" << label
        << "set title ''\nunset y2label\nunset y2tics\nset ytics mirror tc rgb '#303030'\nset autoscale\n"
        << "set xlabel '" << rates[axis] << ", rad/s^2' offset 0,0.4\nset ylabel 'S' tc rgb '#303030' offset 1.2,0\n"
        << "plot $cloud using 2:3 w p pt 7 ps 0.3 lc rgb '#6b8fb5'\n";
  }
  out << "unset multiplot\n";
  return draw_svg(svg, 1100, 860, out.str());
}

/// Fig. 5: both ratio curves with what was flown on them; below, height and force of the ground effect over time, with
/// the split.
inline bool plot_ground_effect(const std::string& svg, const std::vector<TraceRow>& trace,
                               const pinnquad::Airframe<double>& airframe) {
  const double radius_m = airframe.propeller_diameter_m / 2;
  double highest_m = 0;
  for (const TraceRow& row : trace) highest_m = row.height_m > highest_m ? row.height_m : highest_m;
  double last_ratio = highest_m / radius_m * 1.03;
  if (last_ratio > 20) last_ratio = 20;  // nothing left to see
  std::ostringstream out;
  char line[96];
  out << "$curves << EOD\n";
  constexpr int points = 300;
  constexpr double first_ratio = 0.5;
  for (int i = 0; i <= points; ++i) {
    const double x = first_ratio + (last_ratio - first_ratio) * i / points;
    std::snprintf(line, sizeof line, "%.3f %.5f %.5f\n", x, pinnquad::CheesemanBennett{}.thrust_ratio(x, airframe),
                  pinnquad::Conyers{}.thrust_ratio(x, airframe));
    out << line;
  }
  out << "EOD\n$flown << EOD\n";
  for (std::size_t i = 0; i < trace.size(); i += detail::stride_for(trace.size(), 500)) {
    std::snprintf(line, sizeof line, "%.3f %.5f\n", trace[i].height_m / radius_m, trace[i].thrust_ratio);
    out << line;
  }
  out << "EOD\n$series << EOD\n";
  for (std::size_t i = 0; i < trace.size(); i += detail::stride_for(trace.size(), 1500)) {
    std::snprintf(line, sizeof line, "%.2f %.3f %.4f\n", trace[i].time_s, trace[i].height_m, trace[i].ground_effect_N);
    out << line;
  }
  std::vector<double> time_s;
  for (const TraceRow& row : trace) time_s.push_back(row.time_s);
  out << "EOD\nset multiplot\n"
      << detail::panel(0.075, 0.975, 0.965, 0.58) << "set xrange [0:" << last_ratio << "]\nset xlabel 'Z / R' offset 0,0.4\n"
      << "set ylabel 'thrust in / out of ground effect' offset 1,0\nset key top right spacing 1.2\n"
      << "plot $curves using 1:2 w l lw 1.8 dt 2 lc rgb '#7a7a7a' t 'Cheeseman-Bennett', "
      << "$curves using 1:3 w l lw 1.8 lc rgb '#1f6fb2' t 'Conyers', "
      << "$flown using 1:2 w p pt 6 ps 0.45 lw 0.8 lc rgb '#d1541a' t 'flown'\n"
      << "set xrange [0:" << time_s.back() << "]\nset xlabel ''\nset format x ''\nunset key\n"
      << detail::shaded_split(time_s, true) << detail::panel(0.075, 0.975, 0.465, 0.29)
      << "set ylabel 'height, m'\nset yrange [0:*]\nplot $series using 1:2 w l lw 1.3 lc rgb '#303030'\n"
      << detail::no_labels() << detail::panel(0.075, 0.975, 0.265, 0.09)
      << "set format x '%g'\nset xlabel 'time, s' offset 0,0.4\nset ylabel 'ground effect, N'\nset autoscale y\n"
      << "plot $series using 1:3 w l lw 1.3 lc rgb '#d1541a'\nunset multiplot\n";
  return draw_svg(svg, 1000, 760, out.str());
}

/// Fig. 6: drag as in still air and what the wind adds to it, along the body's axes; below, the wind, with the split.
inline bool plot_wind(const std::string& svg, const std::vector<TraceRow>& trace) {
  constexpr std::array<const char*, 3> axes = {"x", "y", "z"};
  constexpr double first_top = 0.95, panel_height = 0.19, gap = 0.025;
  std::ostringstream out;
  out << "$series << EOD\n";
  for (std::size_t i = 0; i < trace.size(); i += detail::stride_for(trace.size(), 1000)) {
    const TraceRow& row = trace[i];
    char line[160];
    std::snprintf(line, sizeof line, "%.2f %.3f %.3f %.3f %.3f %.3f %.3f %.3f\n", row.time_s, row.drag_N[0],
                  row.wind_N[0], row.drag_N[1], row.wind_N[1], row.drag_N[2], row.wind_N[2], row.wind_m_s);
    out << line;
  }
  std::vector<double> time_s;
  for (const TraceRow& row : trace) time_s.push_back(row.time_s);
  out << "EOD\nset multiplot\nset xrange [0:" << time_s.back() << "]\nset format x ''\n";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double top = first_top - static_cast<double>(axis) * (panel_height + gap);
    out << detail::panel(0.085, 0.975, top, top - panel_height) << "set ylabel 'force " << axes[axis] << ", N' offset 1,0\n"
        << (axis == 0 ? "set key top right outside horizontal at screen 0.975, screen 0.995\n" : "unset key\n")
        << "plot $series using 1:" << 2 + 2 * axis << " w l lw 1.2 lc rgb '#1f6fb2' t 'drag as in still air', "
        << "$series using 1:" << 3 + 2 * axis << " w l lw 1.2 lc rgb '#d1541a' t 'added by the wind'\n";
  }
  const double top = first_top - 3 * (panel_height + gap) - 0.025;
  out << detail::panel(0.085, 0.975, top, 0.075) << detail::shaded_split(time_s, true)
      << "set format x '%g'\nset xlabel 'time, s' offset 0,0.4\nset ylabel 'wind north, m/s' offset 1,0\n"
      << "plot $series using 1:8 w l lw 1.5 lc rgb '#2a8f4f'\nunset multiplot\n";
  return draw_svg(svg, 1000, 900, out.str());
}

}  // namespace programs
