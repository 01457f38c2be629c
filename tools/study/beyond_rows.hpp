// SPDX-License-Identifier: MIT
// Columns of rows.csv of the command `beyond`: the figures of a model (training/model_figures.hpp), of each motor, and
// of the closed loop.
#pragma once

#include <string>

#include "study/rows.hpp"
#include "training/model_figures.hpp"

namespace study {

/// Calls `function(column, value)` for each figure; values are NaN where there is no judgement, or no flight.
template <class Function>
void each_beyond_figure(const Outcome& outcome, const Function& function) {
  const programs::Judgement& judged = outcome.test;
  for (const programs::ModelFigure& figure : programs::model_figures) {
    for (std::size_t axis = 0; axis < (figure.has_axes ? programs::axis_names.size() : 1); ++axis) {
      const std::string suffix = figure.has_axes ? std::string("_") + programs::axis_names[axis] : "";
      function(figure.name + suffix, figure.of(judged, axis));
    }
  }
  for (std::size_t motor = 0; motor < judged.errors.per_motor.size(); ++motor) {
    function("mean_absolute_error_u" + std::to_string(motor + 1), judged.errors.per_motor[motor].mean_absolute);
  }
  for (std::size_t i = 0; i < loop_trajectories.size(); ++i) {
    const std::string flown = loop_trajectories[i];
    function(flown + "_rmse_m", outcome.loop.rmse_m[i]);
    function(flown + "_declined_share", outcome.loop.declined_share[i]);
  }
  function("proven", outcome.proven ? 1 : 0);
  function("residual_kept", outcome.residual_kept ? 1 : 0);
}

inline std::string beyond_header() {
  std::string header = "model,flight,flight_seed,seed,epochs,weights";
  each_beyond_figure({}, [&header](const std::string& column, double) { header += "," + column; });
  return header + ",validation_mae,training_s";
}

inline std::string beyond_row(const RowId& id, int epochs, const Outcome& outcome) {
  using pinnquad::number_text;
  std::string text = id.model + "," + id.flight + "," + std::to_string(id.flight_seed) + "," + std::to_string(id.seed) +
                     "," + std::to_string(epochs) + "," + weights_name(outcome.best_weights);
  each_beyond_figure(outcome, [&text](const std::string&, double value) { text += "," + number_text(value); });
  return text + "," + number_text(outcome.validation_mae) + "," + number_text(outcome.training_s);
}

}  // namespace study
