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

#include "command_line/listed.hpp"
#include "flight/pictures.hpp"
#include "page/text.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/evaluation/summary.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "report/comparisons.hpp"
#include "training/judgement.hpp"
#include "training/pictures.hpp"

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
inline Chart schedule_chart(const pinnquad::CyclicalAnnealing& schedule, int epochs) {
  Panel panel;
  panel.x.name = "epoch";
  panel.y = {"weight λ", 0, 1.15 * schedule.maximum};
  panel.series = {{"", Shape::line, colour::blue}};
  for (int epoch = 0; epoch < epochs; ++epoch) {
    panel.series[0].x.push_back(epoch);
    panel.series[0].y.push_back(schedule.weight(epoch, epochs));
  }
  return {"Weight of the physics term",
          "The weight λ over the epochs of a training: " + std::to_string(schedule.cycles) +
              " cycles, each a hold at " + shown::number(schedule.maximum, 3) + " and a fall to 0.",
          {panel}};
}

namespace detail {

inline const char* bar_colour(int model) {
  if (model == 1) return colour::muted;
  if (model <= 4) return colour::red;
  if (model <= 6) return colour::green;
  if (model <= 8) return colour::amber;
  if (model <= 10) return colour::orange;
  return model <= 12 ? colour::violet : colour::blue;
}

}  // namespace detail

/// Figs. 7 and 9: mean absolute errors beside the paper's. The axis is that of the networks: the linearized model's
/// bar, many times as long, is broken.
inline Chart study_errors_chart(const Study& study, const std::vector<int>& models, const std::string& title) {
  double most = 0;
  std::vector<ErrorBar> bars;
  for (const int model : models) {
    const pinnquad::Summary ours = pinnquad::summarize(study.values(model, "mae"));
    const PaperEntry& paper = paper_entry(model, 0);
    const bool vanilla = model != 1 && paper_model(model).term == PhysicsTerm::none;
    bars.push_back({"M" + std::to_string(model) + "  " + model_words(model), detail::bar_colour(model),
                    vanilla ? 0.62 : 1, ours.count > 0 ? 1e3 * ours.mean : pinnquad::not_a_number,
                    ours.count > 1 ? 1e3 * ours.deviation : 0, 1e3 * paper.mean, 1e3 * paper.deviation});
    if (model == 1) continue;
    most = std::max(most, bars.back().reference + bars.back().reference_deviation);
    if (ours.count > 0) most = std::max(most, bars.back().mean + bars.back().deviation);
  }
  return errors_chart(title, "mean absolute error of the commands, 10⁻³", bars, 1.04 * most, 2);
}

/// Every seed's relative change of the mean absolute error, per pair; a stroke is the mean, a diamond the paper's.
inline Chart changes_chart(const std::vector<Comparison>& comparisons) {
  Panel panel;
  panel.x.name = "change of the mean absolute error, %";
  Series zero{"", Shape::line, colour::muted}, seeds{"a seed", Shape::dots, colour::blue, {}, {}, 5, 0.65};
  Series means{"mean", Shape::strokes, colour::text, {}, {}, 2.4}, paper{"the paper", Shape::diamonds, colour::orange};
  std::vector<std::string> told;
  for (const Comparison& c : comparisons) {
    if (c.measure != 0 || !std::isfinite(c.result.relative_difference)) continue;
    const auto row = static_cast<double>(panel.y.rows.size());
    const std::string name = "M" + std::to_string(c.pair.candidate) + " against M" + std::to_string(c.pair.baseline);
    panel.y.rows.push_back(name + ", " + data_words(paper_model(c.pair.candidate).data));
    const std::vector<double> changes = c.relative_changes();
    for (std::size_t k = 0; k < changes.size(); ++k) {  // five levels keep near seeds apart
      seeds.x.push_back(100 * changes[k]);
      seeds.y.push_back(row + 0.12 * (static_cast<double>(k * 2 % 5) - 2));
    }
    means.x.push_back(100 * c.result.relative_difference);
    means.y.push_back(row);
    told.push_back(name + " " + shown::number(means.x.back(), 1, true) + " %");
    if (const std::optional<double> change = paper_change(c.pair, 0)) {
      paper.x.push_back(100 * *change);
      paper.y.push_back(row);
    }
  }
  if (told.empty()) return {};
  zero.x = {0, 0};
  zero.y = {-0.5, static_cast<double>(told.size()) - 0.5};
  panel.series = {seeds, zero, means, paper};
  return {"Relative change of the error by pair and seed",
          "Mean change of the mean absolute error: " + listed(told) + ".",
          {panel}};
}

/// Fig. 2 of the test block.
inline Chart series_chart(const StudySeries& series) {
  std::array<MotionAndSum, 3> axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    axes[axis] = {axis_names[axis], series.axes[axis].angular_acceleration, series.axes[axis].target};
  }
  return correlation_chart(series.time_s, axes, 0);
}

}  // namespace programs
