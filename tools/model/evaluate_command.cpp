// SPDX-License-Identifier: MIT
// Judges a model on recorded flights, by its block, which describes itself: no compiler is asked.
//   pinnquad evaluate my_model/model.hpp --flight flight.csv --json
#include "model/evaluate_command.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/console.hpp"
#include "command_line/options.hpp"
#include "command_line/progress_line.hpp"
#include "model/given_model.hpp"
#include "pinnquad/data/csv.hpp"
#include "training/derivatives.hpp"
#include "training/judgement.hpp"
#include "training/model_figures.hpp"
#include "training/training_flights.hpp"

namespace {

using namespace pinnquad;

struct EvaluateOptions {
  std::string model;
  std::vector<std::string> flights;
  std::string rows = "all";
  bool json = false;
};

/// A model on the rows of a flight.
struct EvaluatedModel {
  std::size_t without_features = 0;  ///< rows without a whole window
  std::size_t outside_envelope = 0;
  programs::PredictedRows answered;
  programs::DerivativeFigures derivatives;
};

EvaluatedModel evaluated(const BlockModel& model, const RowSet& rows) {
  EvaluatedModel result;
  programs::Predictions predictions(rows.size());
  std::vector<bool> counts(rows.size(), false);
  programs::DerivativeSigns signs;
  programs::ProgressLine progress("judging " + std::to_string(rows.size()) + " rows");
  model.answer(rows, [&](std::size_t row, const AnsweredRow& answer) {
    progress.update(static_cast<double>(row) / static_cast<double>(rows.size()));
    predictions[row] = answer.commands;
    counts[row] = true;
    signs.add(answer.derivatives);
    result.outside_envelope += answer.inside_envelope ? 0 : 1;
  });
  result.answered = programs::rows_that_count(rows, predictions, counts);
  result.without_features = rows.size() - result.answered.rows.size();
  result.derivatives = signs.figures();
  return result;
}

/// The rows to judge: all of the flights, or of each (of the last one, where there are more than two) those that
/// `train` tests on.
RowSet chosen_rows(const EvaluateOptions& options, const Dataset& dataset) {
  if (options.rows == "test") {
    return dataset.size() < 3 ? split_each_flight(dataset).test : split_by_flight(dataset).test;
  }
  RowSet all;
  for (const Flight& flight : dataset.flights()) all.add(flight, {0, flight.size()});
  return all;
}

void print_json(const EvaluateOptions& options, const BlockModel& model, const Dataset& dataset,
                const EvaluatedModel& evaluation, const programs::Judgement& judged) {
  nlohmann::json all = nlohmann::json::object();
  for (const programs::Figure& figure : programs::figures()) all[figure.name] = figure.of(judged, figure.index);
  nlohmann::json report = {{"model", model.path()},
                           {"answer", model.answer()},
                           {"airframe", model.airframe_name()},
                           {"flight", pinnquad::flight_names(dataset)},
                           {"rows", evaluation.answered.rows.size()},
                           {"rows_without_features", evaluation.without_features},
                           {"rows_judged", options.rows},
                           {"rows_outside_envelope", evaluation.outside_envelope},
                           {"golden_vectors", model.golden_count()},
                           {"golden_difference", model.golden_difference()},
                           {"figures", all}};
  report.update(programs::figures_of_model(judged));
  std::printf("%s\n", report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

void print_table(const BlockModel& model, const Dataset& dataset, const EvaluatedModel& evaluation,
                 const programs::Judgement& judged) {
  std::printf("model       %s: %s, for %s\n", printable(model.path()).c_str(), model.answer().c_str(),
              model.airframe_name().c_str());
  std::printf("rows        %zu of %s, %zu outside the training envelope\n", evaluation.answered.rows.size(),
              pinnquad::flight_names(dataset).c_str(), evaluation.outside_envelope);
  if (evaluation.without_features > 0) {
    std::printf("            %zu more without a whole window of instants, which count for nothing\n",
                evaluation.without_features);
  }
  programs::print_figures(judged);
}

int evaluate(const EvaluateOptions& options) {
  const BlockModel model = programs::read_model(options.model);
  const Dataset dataset = programs::read_flights(options.flights, minimum_flight_rows, model.columns());
  const EvaluatedModel evaluation = evaluated(model, chosen_rows(options, dataset));
  if (evaluation.answered.rows.empty()) {
    throw std::invalid_argument("--flight: no row of " + pinnquad::flight_names(dataset) +
                                " has the whole window of instants that the model asks for");
  }
  programs::Judgement judged = programs::judge(GivenAirframe(model.airframe_name(), model.airframe()),
                                               evaluation.answered.rows, evaluation.answered.predictions);
  judged.derivatives = evaluation.derivatives;
  if (options.json) {
    print_json(options, model, dataset, evaluation, judged);
  } else {
    print_table(model, dataset, evaluation, judged);
  }
  const double r_squared = judged.errors.mean.r_squared;
  if (std::isfinite(r_squared) && r_squared >= 0) return 0;
  programs::complain("evaluate", model.path() + ": worse than the mean of the commands on these rows");
  return programs::exit_failed;
}

}  // namespace

programs::Command programs::evaluate_command(CLI::App& program) {
  CLI::App* line =
      program.add_subcommand("evaluate", "Judges an exported model on recorded flights, without compiling");
  const auto options = std::make_shared<EvaluateOptions>();
  add_model(*line, options->model);
  add_paths(*line, "--flight", options->flights, "FILE.csv", "recorded flights to judge it on")->required();
  line->add_option("--rows", options->rows,
                   "all: every row; test: those that pinnquad train tests on when it is given these flights")
      ->capture_default_str()
      ->check(CLI::IsMember({"all", "test"}));
  line->add_flag("--json", options->json, "the figures as JSON");
  line->footer(
      "Examples:\n"
      "  pinnquad train --flight d1.csv --out my_model\n"
      "  pinnquad evaluate my_model/model.hpp --flight d1.csv --rows test\n"
      "  pinnquad evaluate my_model/model.block --flight d2.csv --json\n"
      "Exit codes: 0; 1 it is worse than the mean of the commands; 2 bad input or a file that can't be read; 130\n"
      "interrupted.");
  return {line, [options] { return evaluate(*options); }};
}
