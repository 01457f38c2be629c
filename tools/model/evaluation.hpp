// SPDX-License-Identifier: MIT
// A model on rows of recorded flights, judged: what `evaluate` says.
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "training/derivatives.hpp"
#include "training/judgement.hpp"
#include "training/model_figures.hpp"

namespace programs {

/// A model on the rows of flights.
struct EvaluatedModel {
  std::size_t without_features = 0;  ///< rows without a whole window
  std::size_t outside_envelope = 0;
  PredictedRows answered;
  Judgement judged;
};

/// `share_done` is told now and then. Throws std::invalid_argument where no row has the window that the model asks for,
/// and for a flight without a column of the model's.
inline EvaluatedModel evaluated(const pinnquad::BlockModel& model, const pinnquad::RowSet& rows,
                                const std::function<void(double)>& share_done) {
  EvaluatedModel result;
  Predictions predictions(rows.size());
  std::vector<bool> counts(rows.size(), false);
  DerivativeSigns signs;
  model.answer(rows, [&](std::size_t row, const pinnquad::BlockModel::AnsweredRow& answer) {
    share_done(static_cast<double>(row) / static_cast<double>(rows.size()));
    predictions[row] = answer.commands;
    counts[row] = true;
    signs.add(answer.derivatives);
    result.outside_envelope += answer.inside_envelope ? 0 : 1;
  });
  result.answered = rows_that_count(rows, predictions, counts);
  result.without_features = rows.size() - result.answered.rows.size();
  if (result.answered.rows.empty()) {
    throw std::invalid_argument("no row of the flights has the whole window of instants that the model asks for");
  }
  result.judged = judge(pinnquad::GivenAirframe(model.airframe_name(), model.airframe()), result.answered.rows,
                        result.answered.predictions);
  result.judged.derivatives = signs.figures();
  return result;
}

/// The rows to judge: all of the flights, or ("test") of each (of the last one, where there are more than two) those
/// that `train` tests on.
inline pinnquad::RowSet rows_to_judge(const pinnquad::Dataset& dataset, const std::string& which) {
  if (which == "test") {
    return dataset.size() < 3 ? pinnquad::split_each_flight(dataset).test : pinnquad::split_by_flight(dataset).test;
  }
  return pinnquad::all_rows(dataset.flights());
}

/// The answer of `evaluate --json`. `which`: of rows_to_judge().
inline nlohmann::json evaluation_json(const pinnquad::BlockModel& model, const pinnquad::Dataset& dataset,
                                      const std::string& which, const EvaluatedModel& evaluation) {
  nlohmann::json all = nlohmann::json::object();
  for (const Figure& figure : figures()) all[figure.name] = figure.of(evaluation.judged);
  nlohmann::json report = {{"model", model.path()},
                           {"answer", model.answer()},
                           {"airframe", model.airframe_name()},
                           {"flight", pinnquad::flight_names(dataset)},
                           {"rows", evaluation.answered.rows.size()},
                           {"rows_without_features", evaluation.without_features},
                           {"rows_judged", which},
                           {"rows_outside_envelope", evaluation.outside_envelope},
                           {"golden_vectors", model.golden_count()},
                           {"golden_difference", model.golden_difference()},
                           {"figures", all}};
  report.update(figures_of_model(evaluation.judged));
  return report;
}

}  // namespace programs
