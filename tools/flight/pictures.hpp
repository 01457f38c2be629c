// SPDX-License-Identifier: MIT
// Pictures of a flight as the paper has them: trajectory (Fig. 4 d), correlation (Fig. 2), ground effect (Fig. 5), wind
// (Fig. 6).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "command_line/interrupt.hpp"
#include "command_line/progress_line.hpp"
#include "flight/axis_motion.hpp"
#include "flight/trace.hpp"
#include "pictures/gnuplot.hpp"
#include "pictures/viridis.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/evaluation/summary.hpp"
#include "pinnquad/simulation/switchable_quadrotor.hpp"

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
  const auto split = pinnquad::split_contiguous(time_s.size());
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

/// The ends of an axis, whole steps around the flight, so that a wall stands where its axis says.
struct Wall {
  double least = 0, most = 0;
};
template <class Get>
Wall wall(const std::vector<TraceRow>& trace, const Get& get) {
  double least = get(trace.front()), most = least;
  for (const TraceRow& row : trace) {
    least = std::min(least, get(row));
    most = std::max(most, get(row));
  }
  const double step_m = most - least > 40 ? 10 : (most - least > 4 ? 1 : 0.1);
  const Wall ends{step_m * std::floor(least / step_m), step_m * std::ceil(most / step_m)};
  return ends.least < ends.most ? ends : Wall{ends.least, ends.least + step_m};
}

inline std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

inline std::string no_labels() { return "unset label\n"; }

}  // namespace detail

/// Fig. 4 (d): the flown path in space, coloured by speed in steps of half a metre per second, with its shadows on the
/// floor and on the two walls behind, its start and its end.
inline bool plot_trajectory(const std::string& svg, const std::vector<TraceRow>& trace) {
  constexpr double step_m_s = 0.5;
  const std::size_t stride = detail::stride_for(trace.size(), 4000);
  double fastest_m_s = 0;
  for (const TraceRow& row : trace) fastest_m_s = row.speed_m_s > fastest_m_s ? row.speed_m_s : fastest_m_s;
  const int steps = static_cast<int>(fastest_m_s / step_m_s) + 1;
  const auto step_of = [&](std::size_t i) {
    return static_cast<int>((trace[i].speed_m_s + trace[i + stride].speed_m_s) / 2 / step_m_s);
  };
  std::ostringstream out;
  const auto place = [&out](const TraceRow& row) {
    char line[96];
    std::snprintf(line, sizeof line, "%.2f %.2f %.3f\n", row.position_m[1], row.position_m[0], row.height_m);
    out << line;
  };
  for (int step = 0; step < steps; ++step) {          // one line per colour, broken where another begins: a small file
    out << "$speed" << step << " << EOD\n0 0 NaN\n";  // a colour that nobody flew is no error
    bool open = false;
    for (std::size_t i = 0; i + stride < trace.size(); i += stride) {
      const bool here = step_of(i) == step;
      if (here && !open) {
        out << '\n';
        place(trace[i]);
      }
      if (here) place(trace[i + stride]);
      open = here;
    }
    out << "EOD\n";
  }
  out << "$path << EOD\n";
  for (std::size_t i = 0; i < trace.size(); i += stride) place(trace[i]);
  out << "EOD\n$shadow << EOD\n";
  for (std::size_t i = 0; i < trace.size(); i += detail::stride_for(trace.size(), 1500)) place(trace[i]);
  out << "EOD\n$start << EOD\n";
  place(trace.front());
  out << "EOD\n$end << EOD\n";
  place(trace.back());
  const detail::Wall east = detail::wall(trace, [](const TraceRow& row) { return row.position_m[1]; });
  const detail::Wall north = detail::wall(trace, [](const TraceRow& row) { return row.position_m[0]; });
  out << "EOD\nset palette " << viridis_palette(steps) << '\n'
      << "set cbrange [0:" << steps * step_m_s << "]\nset cbtics 1 scale 0.5\nset cblabel 'speed, m/s' offset 0.3,0\n"
      << "set colorbox user origin 0.915,0.24 size 0.02,0.52\n"
      << "set xlabel 'east, m' offset 0,-0.8\nset ylabel 'north, m' offset 1.2,-0.8\n"
      << "set zlabel 'height, m' rotate offset 0.5,0\nset xtics offset -0.3,-0.4\nset ytics offset 0.6,-0.3\n"
      << "set xrange [" << east.least << ':' << east.most << "]\nset yrange [" << north.least << ':' << north.most
      << "]\nset xyplane at 0\nset zrange [0:*]\nset view 62,35,1.0,1.08\nset origin -0.03,-0.01\n"
      << "set size 0.99,1.02\nset border 4095 lc rgb '#c8c8c8'\nset tics tc rgb '#303030'\n"
      << "set grid x y z lc rgb '#e4e4e4'\nset key at screen 0.98,0.985 right top horizontal samplen 1.5\nsplot "
      << "$shadow using 1:2:(0) with lines lw 0.8 lc rgb '#b9bfc6' t 'shadows on floor and walls', "
      << "$shadow using (" << east.least << "):2:3 with lines lw 0.8 lc rgb '#d3d7db' notitle, "
      << "$shadow using 1:(" << north.most << "):3 with lines lw 0.8 lc rgb '#d3d7db' notitle, "
      << "$path using 1:2:3 with lines lw 2.2 lc rgb '#737d88' notitle";  // an edge: yellow is faint on white
  for (int step = 0; step < steps; ++step) {
    out << ", $speed" << step << " using 1:2:3 with lines lw 1.3 lc rgb '" << viridis_step(step, steps) << "' notitle";
  }
  out << ", $start using 1:2:3 with points pt 7 ps 1.3 lc rgb '#d1541a' t 'start'"
      << ", $end using 1:2:3 with points pt 5 ps 1.2 lc rgb '#101010' t 'end'"
      << ", NaN with lines lc palette notitle\n";  // for the colour box
  return draw_svg(svg,
                  {900, 640, "The flown path in space, coloured by speed",
                   "North, east and height in metres; the colour is the speed, 0 to " + detail::rounded(fastest_m_s) +
                       " m/s. Grey: the path's shadows on the floor and two walls. A dot marks the start, a square the "
                       "end."},
                  out.str());
}

/// Fig. 2: angular acceleration and signed command sum over some seconds, and over each other with their PCC.
inline bool plot_correlation(const std::string& svg, const pinnquad::Flight& flight,
                             const pinnquad::Airframe<double>& airframe) {
  constexpr std::array<const char*, 3> names = {"roll", "pitch", "yaw"}, rates = {"dp/dt", "dq/dt", "dr/dt"};
  constexpr std::array<double, 3> tops = {0.945, 0.63, 0.315};
  constexpr double panel_height = 0.225;
  constexpr std::size_t shown_rows = 200, cloud_points = 450;
  const std::size_t first = flight.size() > 3 * shown_rows ? flight.size() / 3 : 0;
  const std::size_t last = first + shown_rows < flight.size() ? first + shown_rows : flight.size();
  std::ostringstream out;
  out << "set multiplot\n";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisMotion motion = axis_motion(flight, airframe, static_cast<int>(axis));
    const std::vector<double>&accelerations = motion.angular_acceleration, &sums = motion.command_sum;
    const auto line = [&](double x, std::size_t i) {
      char text[96];
      std::snprintf(text, sizeof text, "%.2f %.3f %.4f\n", x, accelerations[i], sums[i]);
      out << text;
    };
    out << "$series << EOD\n";
    for (std::size_t i = first; i < last; ++i) line(flight[i].time_s, i);
    const auto [least, most] = std::minmax_element(accelerations.begin(), accelerations.end());
    const double stroke = 0.008 * (*most - *least);
    out << "EOD\n$cloud << EOD\n";  // strokes as long as wide: a tenth of the bytes of point symbols
    for (std::size_t i = 0; i < flight.size(); i += detail::stride_for(flight.size(), cloud_points)) {
      char text[96];
      std::snprintf(text, sizeof text, "%.3f %.4f\n%.3f %.4f\n\n", accelerations[i] - stroke / 2, sums[i],
                    accelerations[i] + stroke / 2, sums[i]);
      out << text;
    }
    out << "EOD\n";
    std::string sum = "S = ";
    for (std::size_t i = 0; i < motion.signs.size(); ++i) {
      sum += (motion.signs[i] < 0 ? (i == 0 ? "-" : " - ") : (i == 0 ? "" : " + ")) + ("u_" + std::to_string(i + 1));
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
        << "set y2range [-m:m]\nset xtics 2\nset xrange [" << flight[first].time_s << ":" << flight[last - 1].time_s
        << "]\n"
        << "plot $series using 1:2 w l lw 3.2 lc rgb '#4f93cf', $series using 1:3 axes x1y2 w l lw 1.2 lc rgb "
           "'#d1541a'\n"
        << detail::panel(0.755, 0.975, top, bottom);
    char label[120];
    std::snprintf(label, sizeof label,
                  "set label 'PCC %.3f' at graph 0.05, graph 0.90 left font ',13' tc rgb '#303030' front boxed\n",
                  pinnquad::pearson_correlation(accelerations, sums));
    out << "set style textbox opaque noborder fillcolor rgb '#f0f0f0' margins 0.8,0.5\n"
        << label
        << "set title ''\nset xtics autofreq\nunset y2label\nunset y2tics\nset ytics mirror tc rgb '#303030'\nset "
           "autoscale\n"
        << "set xlabel '" << rates[axis] << ", rad/s^2' offset 0,0.4\nset ylabel 'S' tc rgb '#303030' offset 1.2,0\n"
        << "plot $cloud w l lw 2.2 lc rgb '#4f7cac'\n";
  }
  out << "unset multiplot\n";
  return draw_svg(svg,
                  {1100, 860, "Angular acceleration and signed command sum, by axis",
                   "Left: both over some seconds for roll, pitch and yaw, acceleration in blue, command sum in orange. "
                   "Right: over each other, with the Pearson correlation of all rows."},
                  out.str());
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
  for (std::size_t i = 0; i < trace.size(); i += detail::stride_for(trace.size(), 350)) {
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
      << detail::panel(0.075, 0.975, 0.965, 0.58) << "set xrange [0:" << last_ratio
      << "]\nset xlabel 'Z / R' offset 0,0.4\n"
      << "set ylabel 'thrust in / out of ground effect' offset 1,0\nset key top right spacing 1.2\n"
      << "plot $curves using 1:2 w l lw 1.8 dt 2 lc rgb '#7a7a7a' t 'Cheeseman-Bennett', "
      << "$curves using 1:3 w l lw 1.8 lc rgb '#1f6fb2' t 'Conyers', "
      << "$flown using 1:2 w p pt 6 ps 0.45 lw 0.8 lc rgb '#d1541a' t 'flown'\n"
      << "set xrange [0:" << time_s.back() << "]\nset xlabel ''\nset format x ''\nunset key\n"
      << detail::shaded_split(time_s, true) << detail::panel(0.075, 0.975, 0.465, 0.29)
      << "set ylabel 'height, m'\nset yrange [0:*]\nset ytics 0.5\nplot $series using 1:2 w l lw 1.3 lc rgb '#303030'\n"
      << detail::no_labels() << detail::panel(0.075, 0.975, 0.265, 0.09)
      << "set format x '%g'\nset xlabel 'time, s' offset 0,0.4\nset ylabel 'ground effect, N'\nset autoscale y\nset "
         "ytics autofreq\n"
      << "plot $series using 1:3 w l lw 1.3 lc rgb '#d1541a'\nunset multiplot\n";
  return draw_svg(svg,
                  {1000, 760, "Ground effect: thrust ratio over height, height and force over time",
                   "Above: thrust in over thrust out of ground effect by Cheeseman and Bennett and by Conyers over the "
                   "height in rotor radii, with what was flown. Below: height in metres and force in newton over time, "
                   "with the blocks for training, validation and test."},
                  out.str());
}

/// Fig. 6: drag as in still air and what the wind adds to it, along the body's axes; below, the wind, with the split.
inline bool plot_wind(const std::string& svg, const std::vector<TraceRow>& trace) {
  constexpr std::array<const char*, 3> axes = {"x", "y", "z"};
  constexpr double first_top = 0.95, panel_height = 0.19, gap = 0.025;
  std::ostringstream out;
  out << "$series << EOD\n";
  for (std::size_t i = 0; i < trace.size(); i += detail::stride_for(trace.size(), 720)) {
    const TraceRow& row = trace[i];
    char line[160];
    std::snprintf(line, sizeof line, "%.2f %.3f %.3f %.3f %.3f %.3f %.3f %.3f\n", row.time_s, row.drag_N[0],
                  row.wind_N[0], row.drag_N[1], row.wind_N[1], row.drag_N[2], row.wind_N[2], row.wind_m_s);
    out << line;
  }
  std::vector<double> time_s;
  for (const TraceRow& row : trace) time_s.push_back(row.time_s);
  out << "EOD\nset multiplot\nset xrange [0:" << time_s.back() << "]\nset format x ''\n"
      << "set format y '%5.1f'\n"
      << detail::shaded_split(time_s, false);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double top = first_top - static_cast<double>(axis) * (panel_height + gap);
    out << detail::panel(0.085, 0.975, top, top - panel_height) << "set ylabel 'force, body " << axes[axis]
        << ", N' offset 1,0\n"
        << (axis == 0 ? "set key top right outside horizontal at screen 0.975, screen 0.99\n" : "unset key\n")
        << "plot $series using 1:" << 2 + 2 * axis << " w l lw 1.2 lc rgb '#1f6fb2' t 'drag as in still air', "
        << "$series using 1:" << 3 + 2 * axis << " w l lw 1.2 lc rgb '#d1541a' t 'added by the wind'\n";
  }
  const double top = first_top - 3 * (panel_height + gap) - 0.025;
  out << detail::panel(0.085, 0.975, top, 0.075) << detail::shaded_split(time_s, true)
      << "set format x '%g'\nset xlabel 'time, s' offset 0,0.4\nset ylabel 'wind north, m/s' offset 1,0\nset ytics 1\n"
      << "plot $series using 1:8 w l lw 1.5 lc rgb '#2a8f4f'\nunset multiplot\n";
  return draw_svg(svg,
                  {1000, 900, "Drag and what the wind adds to it, by body axis, and the wind over time",
                   "Three panels: force in newton along the body's x, y and z over time, in blue the drag as in still "
                   "air, in orange what the wind adds. Below: the wind towards north in m/s, with the blocks for "
                   "training, validation and test."},
                  out.str());
}

/// The files that draw_flight may write.
inline constexpr std::array<const char*, 4> flight_picture_names = {"trajectory.svg", "correlation.svg",
                                                                    "ground_effect.svg", "wind.svg"};

/// All of them into a folder that is there: trajectory.svg, correlation.svg, ground_effect.svg where there is one,
/// wind.svg if `windy`. False, after one line on stderr, where gnuplot is missing or
/// failed.
inline bool draw_flight(const std::string& folder, const pinnquad::Flight& flight, const std::vector<TraceRow>& trace,
                        const pinnquad::Airframe<double>& airframe, pinnquad::GroundEffectModel ground_effect,
                        bool windy) {
  const std::string start = folder + "/";
  std::vector<std::function<bool()>> pictures = {
      [&] { return plot_trajectory(start + "trajectory.svg", trace); },
      [&] { return plot_correlation(start + "correlation.svg", flight, airframe); }};
  if (ground_effect != pinnquad::GroundEffectModel::none) {
    pictures.emplace_back([&] { return plot_ground_effect(start + "ground_effect.svg", trace, airframe); });
  }
  if (windy) pictures.emplace_back([&] { return plot_wind(start + "wind.svg", trace); });
  ProgressLine progress("drawing " + std::to_string(pictures.size()) + " pictures");
  for (std::size_t drawn = 0; drawn < pictures.size();) {
    stop_if_interrupted();
    if (!pictures[drawn]()) return false;
    progress.show(static_cast<double>(++drawn) / static_cast<double>(pictures.size()));
  }
  return true;
}

}  // namespace programs
