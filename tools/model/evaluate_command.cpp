// SPDX-License-Identifier: MIT
// Judges a model on recorded flights, by its block, which describes itself: no compiler is asked.
//   pinnquad evaluate my_model/model.hpp flight.csv --json
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/command.hpp"
#include "command_line/console.hpp"
#include "command_line/options.hpp"
#include "command_line/progress_line.hpp"
#include "model/evaluation.hpp"
#include "model/given_model.hpp"
#include "model/model_evidence.hpp"
#include "pinnquad/data/csv.hpp"
#include "training/training_flights.hpp"

namespace {

using namespace pinnquad;

struct EvaluateOptions {
  std::string model, mapping;
  std::vector<std::string> flights;
  std::string rows = "all";
  bool json = false;
};

void print_table(const BlockModel& model, const Dataset& dataset, const programs::EvaluatedModel& evaluation) {
  programs::print_entry("model", printable(model.path()) + ": " + model.answer() + ", for " + model.airframe_name());
  programs::print_entry(
      "rows", programs::in_words("%zu of %s, %zu outside the training envelope", evaluation.answered.rows.size(),
                                 flight_names(dataset).c_str(), evaluation.outside_envelope));
  if (evaluation.without_features > 0) {
    std::printf("            %zu more without a whole window of instants, which count for nothing\n",
                evaluation.without_features);
  }
  programs::print_figures(evaluation.judged);
}

int evaluate(const EvaluateOptions& options) {
  if (options.rows == "test" && logs::kind_of_sources(options.flights, options.mapping) != logs::SourceKind::flights) {
    throw std::invalid_argument("--rows test is of recorded flights: of a dataset or logs train tests on --hold-out");
  }
  const BlockModel model = programs::read_model(options.model);
  const Dataset dataset =
      programs::read_flights(options.flights, options.mapping, minimum_flight_rows, model.columns());
  const RowSet rows = programs::rows_to_judge(dataset, options.rows);
  programs::ProgressLine progress("judging " + std::to_string(rows.size()) + " rows");
  const programs::EvaluatedModel evaluation =
      programs::evaluated(model, rows, [&progress](double share) { progress.update(share); });
  progress.clear();
  const double r_squared = evaluation.judged.errors.mean.r_squared;
  const programs::FlightVerdict verdict = programs::model_verdict(programs::evidence_of(model, evaluation));
  if (options.json) {
    nlohmann::json report = programs::evaluation_json(model, dataset, options.rows, evaluation);
    report["verdict"] = programs::verdict_json(verdict);
    std::printf("%s\n", report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  } else {
    programs::print_verdict(verdict);
    print_table(model, dataset, evaluation);
  }
  if (std::isfinite(r_squared) && r_squared >= 0) return 0;
  programs::complain("evaluate", model.path() + ": worse than the mean of the commands on these rows");
  return programs::exit_failed;
}

}  // namespace

namespace programs {

Command evaluate_command(CLI::App& program) {
  CLI::App* line =
      program.add_subcommand("evaluate", "Judges an exported model on recorded flights, without compiling");
  const auto options = std::make_shared<EvaluateOptions>();
  add_model(*line, options->model);
  add_sources(*line, options->flights, options->mapping);
  line->add_option("--rows", options->rows,
                   "all: every row; test: those that pinnquad train tests on when it is given these flights")
      ->capture_default_str()
      ->check(CLI::IsMember({"all", "test"}));
  line->add_flag("--json", options->json, "the figures as JSON");
  line->footer(
      "Examples:\n"
      "  pinnquad train d1.csv --out my_model\n"
      "  pinnquad evaluate my_model/model.hpp d1.csv --rows test\n"
      "  pinnquad evaluate my_model/model.block d2.csv --json\n"
      "Exit codes: 0; 1 it is worse than the mean of the commands; 2 bad input or a file that can't be read; 130\n"
      "interrupted.");
  return {line, [options] { return evaluate(*options); }};
}

}  // namespace programs
