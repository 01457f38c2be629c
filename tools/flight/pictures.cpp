// SPDX-License-Identifier: MIT
#include "flight/pictures.hpp"

#include <algorithm>
#include <cmath>

#include "flight/axis_motion.hpp"
#include "page/text.hpp"
#include "page/viridis.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/evaluation/summary.hpp"

namespace programs {
namespace {

/// Every n-th row, so that a picture has no more points than the eye.
std::size_t stride_for(std::size_t rows, std::size_t most) { return rows / most + 1; }

/// An axis of the box: whole steps around the flight, so that a wall stands where its axis says.
struct Side {
  double least = 0, most = 0, step = 1;

  Side(double lowest, double highest) {
    const double span = highest - lowest;
    for (const double by : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0}) {
      step = by;
      if (span <= 6 * by) break;
    }
    least = step * std::floor(lowest / step);
    most = std::max(step * std::ceil(highest / step), least + step);
  }
  double share(double value) const { return (value - least) / (most - least) - 0.5; }
  std::vector<double> ticks() const {
    std::vector<double> list;
    for (int i = 0; least + i * step <= most + 1e-9; ++i) list.push_back(least + i * step);
    return list;
  }
  std::string text(double tick) const { return shown::number(std::abs(tick) < 1e-9 ? 0 : tick, step < 1 ? 1 : 0); }
};

/// Places in space, seen from the south-east and from above.
struct Box {
  Side east, north, height;

  void add(Series& series, double east_m, double north_m, double height_m) const {
    constexpr double turn = 0.61, tilt = 1.08;  // rad: about the vertical, and from it
    const double e = east.share(east_m), n = north.share(north_m), h = height.share(height_m);
    series.add(e * std::cos(turn) + n * std::sin(turn),
               (n * std::cos(turn) - e * std::sin(turn)) * std::cos(tilt) + 0.8 * h * std::sin(tilt));
  }
  void add(Series& series, const TraceRow& row) const {
    add(series, row.position_m[1], row.position_m[0], row.height_m);
  }
  Label label(const std::string& text, const std::string& anchor, double east_m, double north_m, double height_m,
              double right, double up) const {
    Series place;
    add(place, east_m, north_m, height_m);
    return {text, anchor, place.x[0] + right, place.y[0] + up};
  }

  /// Grid on the floor and on two walls; numbers along the near edges.
  void draw(Panel& panel) const {
    Series grid{"", Shape::line, colour::grid, {}, {}, 1};
    const auto line = [&](std::array<double, 3> from, std::array<double, 3> to) {
      add(grid, from[0], from[1], from[2]);
      add(grid, to[0], to[1], to[2]);
      grid.add_gap();
    };
    const double floor = height.least;
    for (const double e : east.ticks()) {
      line({e, north.least, floor}, {e, north.most, floor});
      line({e, north.most, floor}, {e, north.most, height.most});
      panel.labels.push_back(label(east.text(e), "end", e, north.least, floor, -0.005, -0.035));
    }
    for (const double n : north.ticks()) {
      line({east.least, n, floor}, {east.most, n, floor});
      line({east.least, n, floor}, {east.least, n, height.most});
      panel.labels.push_back(label(north.text(n), "start", east.most, n, floor, 0.015, -0.02));
    }
    for (const double h : height.ticks()) {
      line({east.least, north.least, h}, {east.least, north.most, h});
      line({east.least, north.most, h}, {east.most, north.most, h});
      if (h > floor) panel.labels.push_back(label(height.text(h), "end", east.least, north.least, h, -0.015, 0));
    }
    panel.labels.push_back(label("east, m", "end", (east.least + east.most) / 2, north.least, floor, -0.05, -0.1));
    panel.labels.push_back(label("north, m", "start", east.most, (north.least + north.most) / 2, floor, 0.07, -0.08));
    panel.labels.push_back(label("height, m", "middle", east.least, north.least, height.most, 0.02, 0.06));
    panel.series.push_back(grid);
  }
};

template <class Get>
Side side_of(const std::vector<TraceRow>& trace, const Get& get) {
  const auto [least, most] = std::minmax_element(trace.begin(), trace.end(),
                                                 [&](const TraceRow& a, const TraceRow& b) { return get(a) < get(b); });
  return {get(*least), get(*most)};
}

/// The three blocks of the 60/20/20 split.
std::vector<Band> split_bands(const std::vector<TraceRow>& trace, bool named) {
  const auto split = pinnquad::split_contiguous(trace.size());
  const auto band = [&](const char* name, const char* colour, const pinnquad::IndexRange& range) {
    return Band{named ? name : "", colour, trace[range.begin].time_s, trace[range.end - 1].time_s};
  };
  return {band("training", colour::blue, split.train), band("validation", colour::amber, split.validation),
          band("test", colour::green, split.test)};
}

/// A series over the time, at most `most` rows of it.
template <class Get>
Series over_time(const std::string& name, const char* colour, const std::vector<TraceRow>& trace, std::size_t most,
                 const Get& get) {
  Series series{name, Shape::line, colour, {}, {}, 1.3};
  for (std::size_t i = 0; i < trace.size(); i += stride_for(trace.size(), most)) {
    series.add(trace[i].time_s, get(trace[i]));
  }
  return series;
}

/// Fig. 5: both ratio curves with what was flown on them; below, height and force of the ground effect over time, with
/// the split.
Chart ground_effect_chart(const std::vector<TraceRow>& trace, const pinnquad::Airframe<double>& airframe) {
  constexpr int points = 300;
  constexpr double first_ratio = 0.5, nothing_left_to_see = 20;
  const double radius_m = airframe.propeller_diameter_m / 2;
  double highest_m = 0;
  for (const TraceRow& row : trace) highest_m = std::max(highest_m, row.height_m);
  const double last_ratio = std::min(highest_m / radius_m * 1.03, nothing_left_to_see);
  Series cheeseman{"Cheeseman-Bennett", Shape::line, colour::muted}, conyers{"Conyers", Shape::line, colour::blue};
  Series flown{"flown", Shape::dots, colour::orange, {}, {}, 3.4, 0.8};
  cheeseman.dashed = true;
  for (int i = 0; i <= points; ++i) {
    const double ratio = first_ratio + (last_ratio - first_ratio) * i / points;
    cheeseman.add(ratio, pinnquad::CheesemanBennett{}.thrust_ratio(ratio, airframe));
    conyers.add(ratio, pinnquad::Conyers{}.thrust_ratio(ratio, airframe));
  }
  for (std::size_t i = 0; i < trace.size(); i += stride_for(trace.size(), 350)) {
    flown.add(trace[i].height_m / radius_m, trace[i].thrust_ratio);
  }
  Panel ratios, height, force;
  ratios.x = {"height over rotor radius, Z / R", 0, last_ratio};
  ratios.y.name = "thrust in / out of ground effect";
  ratios.height = 200;
  ratios.series = {cheeseman, conyers, flown};
  height.y = {"height, m", 0};
  height.bands = split_bands(trace, true);
  height.x = {"", 0};
  height.x.numbered = false;
  height.series = {over_time("", colour::text, trace, 1000, [](const TraceRow& row) { return row.height_m; })};
  force.x = {"time, s", 0};
  force.y.name = "ground effect, N";
  force.bands = split_bands(trace, false);
  force.series = {over_time("", colour::orange, trace, 1000, [](const TraceRow& row) { return row.ground_effect_N; })};
  return {"Ground effect: thrust ratio over height, height and force over time",
          "Above: thrust in over thrust out of ground effect by Cheeseman and Bennett and by Conyers over the height "
          "in rotor radii, with what was flown. Below: height in metres and force in newton over time, with the blocks "
          "for training, validation and test.",
          {ratios, height, force}};
}

/// Fig. 6: drag as in still air and what the wind adds to it, along the body's axes; below, the wind, with the split.
Chart wind_chart(const std::vector<TraceRow>& trace) {
  constexpr std::array<const char*, 3> axes = {"x", "y", "z"};
  constexpr std::size_t most_rows = 720;
  Chart chart{"Drag and what the wind adds to it, by body axis, and the wind over time",
              "Three panels: force in newton along the body's x, y and z over time, in blue the drag as in still "
              "air, in orange what the wind adds. Below: the wind towards north in m/s, with the blocks for "
              "training, validation and test."};
  for (int axis = 0; axis < 3; ++axis) {
    Panel panel;
    panel.x = {"", 0};
    panel.x.numbered = false;
    panel.y.name = std::string("force, body ") + axes[static_cast<std::size_t>(axis)] + ", N";
    panel.bands = split_bands(trace, false);
    panel.series = {over_time("drag as in still air", colour::blue, trace, most_rows,
                              [axis](const TraceRow& row) { return row.drag_N[axis]; }),
                    over_time("added by the wind", colour::orange, trace, most_rows,
                              [axis](const TraceRow& row) { return row.wind_N[axis]; })};
    chart.panels.push_back(panel);
  }
  Panel wind;
  wind.x = {"time, s", 0};
  wind.y.name = "wind towards north, m/s";
  wind.bands = split_bands(trace, true);
  wind.series = {over_time("", colour::green, trace, most_rows, [](const TraceRow& row) { return row.wind_m_s; })};
  chart.panels.push_back(wind);
  return chart;
}

/// Fig. 2: angular acceleration and signed command sum over some rows from the first third on, and over each other with
/// their PCC over all rows.
Chart correlation_chart(const pinnquad::Flight& flight, const pinnquad::Airframe<double>& airframe) {
  constexpr std::array<const char*, 3> rates = {"dp/dt, rad/s²", "dq/dt, rad/s²", "dr/dt, rad/s²"};
  constexpr std::size_t shown_rows = 200, cloud_points = 450;
  const std::size_t first = flight.size() / 3, last = std::min(first + shown_rows, flight.size());
  std::vector<double> time_s;
  for (const pinnquad::Sample& sample : flight) time_s.push_back(sample.time_s);
  const auto part = [&](const std::vector<double>& all) {
    return std::vector<double>(all.begin() + static_cast<std::ptrdiff_t>(first),
                               all.begin() + static_cast<std::ptrdiff_t>(last));
  };
  const auto about_zero = [](const std::string& name, const std::vector<double>& values) {
    double most = 0;
    for (const double value : values) most = std::max(most, std::abs(value));
    return most > 0 ? Axis{name, -1.1 * most, 1.1 * most} : Axis{name};
  };
  Chart chart{"Angular acceleration and signed command sum, by axis",
              "Both over some seconds for roll, pitch and yaw, acceleration in blue, command sum in orange; beside "
              "it over each other, with the Pearson correlation of all rows.",
              {},
              2};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisMotion motion = axis_motion(flight, airframe, static_cast<int>(axis));
    Panel both, cloud;
    both.title = motion.words;
    both.share = 2;
    both.series = {
        {"angular acceleration", Shape::line, colour::blue, part(time_s), part(motion.angular_acceleration), 3, 0.75},
        {"command sum S", Shape::line, colour::orange, part(time_s), part(motion.command_sum), 1.2}};
    both.series[1].right = true;
    both.x.name = "time, s";
    both.y = about_zero(rates[axis], both.series[0].y);
    both.right = about_zero("S", both.series[1].y);
    cloud.title =
        "PCC " + shown::number(pinnquad::pearson_correlation(motion.angular_acceleration, motion.command_sum), 3);
    cloud.x.name = rates[axis];
    cloud.y.name = "S";
    cloud.series = {{"", Shape::dots, colour::blue, {}, {}, 3, 0.6}};
    for (std::size_t i = 0; i < time_s.size(); i += stride_for(time_s.size(), cloud_points)) {
      cloud.series[0].add(motion.angular_acceleration[i], motion.command_sum[i]);
    }
    chart.panels.insert(chart.panels.end(), {both, cloud});
  }
  return chart;
}

}  // namespace

Chart trajectory_chart(const std::vector<TraceRow>& trace) {
  constexpr double step_m_s = 0.5;
  const Box box{side_of(trace, [](const TraceRow& row) { return row.position_m[1]; }),
                side_of(trace, [](const TraceRow& row) { return row.position_m[0]; }),
                {0, side_of(trace, [](const TraceRow& row) { return row.height_m; }).most}};
  Panel space, speeds;
  space.height = 400;
  space.x.hidden = space.y.hidden = true;
  box.draw(space);
  Series floor{"shadows on floor and walls", Shape::line, colour::muted, {}, {}, 0.7, 0.55}, walls = floor;
  for (const int wall : {0, 1}) {
    for (std::size_t i = 0; i < trace.size(); i += stride_for(trace.size(), 1500)) {
      const TraceRow& row = trace[i];
      if (wall == 0) box.add(floor, row.position_m[1], row.position_m[0], box.height.least);
      box.add(walls, wall == 0 ? box.east.least : row.position_m[1], wall == 0 ? row.position_m[0] : box.north.most,
              row.height_m);
    }
    walls.add_gap();
  }
  walls.opacity = 0.5;
  const std::size_t stride = stride_for(trace.size(), 4000);
  double fastest_m_s = 0;
  for (const TraceRow& row : trace) fastest_m_s = std::max(fastest_m_s, row.speed_m_s);
  const int steps = static_cast<int>(fastest_m_s / step_m_s) + 1;
  Series edge{"", Shape::line, colour::muted, {}, {}, 2.6};  // the ends of viridis are faint on white and on black
  std::vector<Series> path;
  for (int step = 0; step < steps; ++step) {
    path.push_back({"", Shape::line, viridis_step(step, steps), {}, {}, 1.5});
    speeds.series.push_back(path.back());
    speeds.series.back().x = {step * step_m_s, (step + 1) * step_m_s};
    speeds.series.back().y = {0, 0};
    speeds.series.back().width = 12;
  }
  int last = -1;
  for (std::size_t i = 0; i + stride < trace.size(); i += stride) {
    const TraceRow &from = trace[i], &to = trace[i + stride];
    const int step = static_cast<int>((from.speed_m_s + to.speed_m_s) / 2 / step_m_s);
    Series& here = path[static_cast<std::size_t>(step)];
    if (step != last) {
      here.add_gap();
      box.add(here, from);
    }
    box.add(here, to);
    box.add(edge, from);
    last = step;
  }
  Series start{"start", Shape::dots, colour::red, {}, {}, 10}, end{"end", Shape::squares, colour::text, {}, {}, 3};
  box.add(start, trace.front());
  box.add(end, trace.back());
  space.series.insert(space.series.end(), {floor, walls, edge});
  space.series.insert(space.series.end(), path.begin(), path.end());
  space.series.insert(space.series.end(), {start, end});
  space.x.least = -0.83, space.x.most = 0.83;
  space.y.least = -0.69, space.y.most = 0.69;
  speeds.x = {"speed, m/s", 0, steps * step_m_s};
  speeds.y.hidden = true;
  speeds.height = 12;
  return {"The flown path in space, coloured by speed",
          "North, east and height in metres; the colour is the speed, 0 to " + shown::number(fastest_m_s, 1) +
              " m/s. Grey: the path's shadows on the floor and two walls. A dot marks the start, a square the end.",
          {space, speeds}};
}

void draw_flight(const std::string& folder, const pinnquad::Flight& flight, const std::vector<TraceRow>& trace,
                 const pinnquad::Airframe<double>& airframe, pinnquad::GroundEffectModel ground_effect, bool windy) {
  write_svg(folder + "/trajectory.svg", trajectory_chart(trace));
  write_svg(folder + "/correlation.svg", correlation_chart(flight, airframe));
  if (ground_effect != pinnquad::GroundEffectModel::none) {
    write_svg(folder + "/ground_effect.svg", ground_effect_chart(trace, airframe));
  }
  if (windy) write_svg(folder + "/wind.svg", wind_chart(trace));
}

}  // namespace programs
