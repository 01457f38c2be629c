// SPDX-License-Identifier: MIT
// The drawings of a study's report: Figs. 2, 3, 7, 8 and 9 of the paper, and every seed's relative change per pair.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pictures/drawing.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/evaluation/summary.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "report/comparisons.hpp"
#include "training/ellipses_drawing.hpp"
#include "training/judgement.hpp"

namespace programs {

/// One seed of one model on its test block: flown and predicted sums over the angular accelerations.
struct StudySeries {
  std::vector<double> time_s;
  std::array<AxisSeries, 3> axes;
};

/// Reads series/model<ID>.csv. The signs of the sums come from the airframe's allocation, which all airframes of the
/// paper's rotor order share. Throws InputError.
inline StudySeries read_study_series(const std::string& path) {
  const auto rows = pinnquad::read_csv(
      path, {"time_s", "wdot_x", "wdot_y", "wdot_z", "u1", "u2", "u3", "u4", "p1", "p2", "p3", "p4"}, 3);
  constexpr auto airframe = pinnquad::airframe_value<pinnquad::PaperQuadrotor, double>();
  StudySeries series;
  for (const std::vector<double>& row : rows) {
    series.time_s.push_back(row[0]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto signs = pinnquad::allocation_signs(airframe, static_cast<int>(axis));
      series.axes[axis].angular_acceleration.push_back(row[1 + axis]);
      series.axes[axis].target.push_back(pinnquad::signed_sum(signs, {row[4], row[5], row[6], row[7]}));
      series.axes[axis].predicted.push_back(pinnquad::signed_sum(signs, {row[8], row[9], row[10], row[11]}));
    }
  }
  return series;
}

/// Fig. 3: the weight of the physics term over the epochs, Eq. (6).
inline std::string schedule_figure(const pinnquad::CyclicalAnnealing& schedule, int epochs) {
  const drawing::Axis x{0, static_cast<double>(epochs), 70, 1030}, y{0, 1.15 * schedule.maximum, 190, 16};
  drawing::Trace trace;
  for (int epoch = 0; epoch < epochs; ++epoch) trace.to(x(epoch), y(schedule.weight(epoch, epochs)));
  return drawing::svg(1060, 236,
                      drawing::vertical_axis(y, 70, 1030, 4, "weight λ") +
                          drawing::horizontal_axis(x, 16, 190, 6, "epoch") + drawing::path(trace.d(), "first"),
                      "Weight of the physics term",
                      "The weight λ over the epochs of a training: " + std::to_string(schedule.cycles) +
                          " cycles, each a hold at " + shown::number(schedule.maximum, 3) + " and a fall to 0.");
}

namespace detail {

inline const char* bar_colour(int model) {
  if (model == 1) return "grey";
  if (model <= 4) return "red";
  if (model <= 6) return "green";
  if (model <= 8) return "yellow";
  if (model <= 10) return "orange";
  return model <= 12 ? "violet" : "blue";
}

}  // namespace detail

/// Figs. 7 and 9: mean absolute errors as bars, deviations over the seeds as whiskers, the paper's values as diamonds.
/// Models without rows leave an empty line. The axis is that of the networks: the linearized model's bar, many times as
/// long, is broken at its end and says its length.
inline std::string errors_figure(const Study& study, const std::vector<int>& models, const std::string& title) {
  constexpr double row_height = 33, top = 8, left = 200, right = 1020;
  double most = 0;
  const auto reach = [&most](int model, const PaperEntry& entry) {
    if (model != 1) most = std::max(most, 1e3 * (entry.mean + entry.deviation));
  };
  std::string told;
  for (const int model : models) {
    const pinnquad::Summary ours = pinnquad::summarize(study.values(model, "mae"));
    reach(model, paper_entry(model, 0));
    if (ours.count > 0) reach(model, {ours.mean, ours.count > 1 ? ours.deviation : 0});
    told += (told.empty() ? "" : "; ") + ("model " + std::to_string(model)) + " " +
            (ours.count > 0 ? shown::number(1e3 * ours.mean, 3) : "not in this study");
  }
  const double bottom = top + row_height * static_cast<double>(models.size());
  const drawing::Axis x{0, 1.04 * most, left, right};
  std::string text = drawing::horizontal_axis(x, top, bottom, 8, "mean absolute error of the commands, 10⁻³");
  const auto whisker = [&](double from, double to, double y) {
    text += drawing::line(from, y, to, y, "deviation") + drawing::line(from, y - 4, from, y + 4, "deviation") +
            drawing::line(to, y - 4, to, y + 4, "deviation");
  };
  const auto broken = [&](double length, double paper, double y) {
    text += drawing::path("M" + drawing::at(right - 190) + " " + drawing::at(y + 12) + "l8 -24h6l-8 24z", "gap-mark") +
            drawing::label(right - 6, y + 4, shown::number(length, 1) + "; the paper " + shown::number(paper, 1),
                           "on-bar end");
  };
  for (std::size_t i = 0; i < models.size(); ++i) {
    const int model = models[i];
    const double middle = top + row_height * (static_cast<double>(i) + 0.5);
    const pinnquad::Summary ours = pinnquad::summarize(study.values(model, "mae"));
    const double length = 1e3 * ours.mean;
    text += drawing::label(16, middle, "M" + std::to_string(model), "title") +
            drawing::label(58, middle, model_words(model), "name");
    if (ours.count == 0) {
      text += drawing::label(left + 8, middle, "not in this study", "small");
    } else {
      const bool vanilla = model != 1 && paper_model(model).term == PhysicsTerm::none;
      text += drawing::rectangle(left, middle - 13, std::min(x(length), right) - left, 17,
                                 std::string(detail::bar_colour(model)) + (vanilla ? " vanilla" : ""));
      if (length > x.most) broken(length, 1e3 * paper_entry(model, 0).mean, middle - 4.5);
      if (ours.count > 1 && length <= x.most) {
        whisker(x(length - 1e3 * ours.deviation), x(length + 1e3 * ours.deviation), middle - 4.5);
      }
    }
    const PaperEntry& paper = paper_entry(model, 0);
    if (1e3 * paper.mean > x.most) continue;
    const double at_paper = x(1e3 * paper.mean), below = middle + 10;
    text += drawing::line(x(1e3 * (paper.mean - paper.deviation)), below, x(1e3 * (paper.mean + paper.deviation)),
                          below, "reference-line") +
            drawing::path("M" + drawing::at(at_paper - 5) + " " + drawing::at(below) + "l5 -5l5 5l-5 5z", "reference");
  }
  text += drawing::line(left, top, left, bottom, "axis");
  return drawing::svg(1060, bottom + 44, text, title, "Mean absolute errors of the commands, 10⁻³: " + told + ".");
}

/// Every seed's relative change of the mean absolute error, per pair; a stroke is the mean, a diamond the paper's.
inline std::string changes_figure(const std::vector<Comparison>& comparisons) {
  constexpr double row_height = 32, top = 8, left = 250, right = 1020;
  std::vector<const Comparison*> compared;
  double least = -5, most = 5;
  for (const Comparison& c : comparisons) {
    if (c.measure != 0 || !std::isfinite(c.result.relative_difference)) continue;
    compared.push_back(&c);
    std::vector<double> changes = c.relative_changes();
    if (const std::optional<double> paper = paper_change(c.pair, 0)) changes.push_back(*paper);
    for (const double change : changes) {
      least = std::min(least, 100 * change);
      most = std::max(most, 100 * change);
    }
  }
  if (compared.empty()) return "";
  const double margin = 0.04 * (most - least);
  const double bottom = top + row_height * static_cast<double>(compared.size());
  const drawing::Axis x{least - margin, most + margin, left, right};
  std::string text = drawing::horizontal_axis(x, top, bottom, 8, "change of the mean absolute error, %") +
                     drawing::line(x(0), top, x(0), bottom, "axis");
  std::string told;
  for (std::size_t i = 0; i < compared.size(); ++i) {
    const Comparison& c = *compared[i];
    told += (told.empty() ? "" : "; ") + ("model " + std::to_string(c.pair.candidate)) + " against " +
            std::to_string(c.pair.baseline) + " " + shown::number(100 * c.result.relative_difference, 1, true) + " %";
    const double middle = top + row_height * (static_cast<double>(i) + 0.5);
    drawing::Trace seeds;
    const std::vector<double> changes = c.relative_changes();
    for (std::size_t k = 0; k < changes.size(); ++k) {  // five levels keep near seeds apart
      seeds.dot(x(100 * changes[k]), middle + 3.2 * (static_cast<double>(k * 2 % 5) - 2));
    }
    text += drawing::label(16, middle + 4,
                           "M" + std::to_string(c.pair.candidate) + " against M" + std::to_string(c.pair.baseline),
                           "title") +
            drawing::label(left - 12, middle + 4, data_words(paper_model(c.pair.candidate).data), "small end") +
            drawing::path(seeds.d(), "seed");
    const double mean = x(100 * c.result.relative_difference);
    text += drawing::line(mean, middle - 12, mean, middle + 12, "mean");
    if (const std::optional<double> paper = paper_change(c.pair, 0)) {
      text += drawing::path("M" + drawing::at(x(100 * *paper) - 5) + " " + drawing::at(middle) + "l5 -5l5 5l-5 5z",
                            "reference");
    }
  }
  return drawing::svg(1060, bottom + 44, text, "Relative change of the error by pair and seed",
                      "Mean change of the mean absolute error: " + told + ".");
}

/// Fig. 8 of the models by number.
inline std::string ellipses_figure(const std::vector<int>& models, const std::vector<StudySeries>& series) {
  std::vector<EllipsesRow> rows;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const std::string number = std::to_string(models[m]);
    rows.push_back({"M" + number, "model " + number, series[m].axes});
  }
  return ellipses_drawing(rows, "model");
}

/// Fig. 2: angular acceleration and signed sum of the flown commands over some seconds, each over its standard
/// deviation.
inline std::string correlation_figure(const StudySeries& series) {
  constexpr double height = 118, gap = 34, left = 70, right = 1030, top = 26;
  constexpr std::size_t shown = 240;
  constexpr std::array<const char*, 3> rates = {"dp/dt", "dq/dt", "dr/dt"};
  const std::size_t last = std::min(series.time_s.size(), shown) - 1;
  std::string text;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisSeries& s = series.axes[axis];
    const auto deviation = pinnquad::axis_deviation(s.angular_acceleration, s.target);
    const double y0 = top + static_cast<double>(axis) * (height + gap);
    const drawing::Axis x{series.time_s.front(), series.time_s[last], left, right}, y{-4, 4, y0 + height, y0};
    drawing::Trace acceleration, sum;
    for (std::size_t i = 0; i <= last; ++i) {
      acceleration.to(x(series.time_s[i]), y(std::clamp(s.angular_acceleration[i] / deviation.x, -4.0, 4.0)));
      sum.to(x(series.time_s[i]), y(std::clamp(s.target[i] / deviation.y, -4.0, 4.0)));
    }
    text += drawing::horizontal_axis(x, y0, y0 + height, 8, axis == 2 ? "time, s" : "", axis == 2) +
            drawing::vertical_axis(y, left, right, 4, axis == 1 ? "in standard deviations" : "") +
            drawing::path(acceleration.d(), "thick") + drawing::path(sum.d(), "thin") +
            drawing::label(left, y0 - 8, std::string(axis_names[axis]) + ": " + rates[axis] + " and its command sum",
                           "title") +
            drawing::label(right, y0 - 8,
                           "PCC " + shown::number(pinnquad::pearson_correlation(s.angular_acceleration, s.target), 3) +
                               " over the block",
                           "small end");
  }
  return drawing::svg(1060, top + 3 * (height + gap) + 14, text, "Angular acceleration and command sums",
                      "Angular acceleration and signed command sum over time in roll, pitch and yaw, each in its "
                      "standard deviation; they rise and fall together.");
}

}  // namespace programs
