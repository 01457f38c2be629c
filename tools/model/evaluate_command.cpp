// SPDX-License-Identifier: MIT
// Judges a model, a block or an exported header, on recorded flights: the network is put together at run time, from
// what the model says of itself.
//   pinnquad evaluate my_model/model.hpp --flight flight.csv --json
#include "model/evaluate_command.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/console.hpp"
#include "command_line/interrupt.hpp"
#include "command_line/options.hpp"
#include "command_line/progress_line.hpp"
#include "logs/training_flights.hpp"
#include "model/run_time_model.hpp"
#include "pinnquad/data/sample_inputs.hpp"
#include "training/derivatives.hpp"
#include "training/judgement.hpp"
#include "training/model_figures.hpp"

namespace {

using namespace pinnquad;

struct Options {
  std::string model;
  std::vector<std::string> flights;
  std::string airframe;
  std::string answer;
  std::string rows = "all";
  bool json = false;
};

/// What was found.
struct Evaluation {
  double golden_difference = 0;  ///< the largest of the golden vectors' commands
  programs::Predictions predictions;
  std::size_t outside_envelope = 0;
  std::array<double, 3> wrong_derivatives{};  ///< see wrong_derivative_shares()
};

template <class Features, class Outputs, class Scalar>
Evaluation evaluated(const programs::Block& block, const programs::Identity& identity, const RowSet& rows) {
  using Model = programs::RunTimeModel<Features, Outputs, Scalar>;
  const Model model(block, identity);
  Evaluation result;
  for (std::size_t vector = 0; vector < block.golden_count; ++vector) {
    typename Model::FeatureVector x{};
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = static_cast<Scalar>(block.golden_features[vector * x.size() + i]);
    }
    const Commands<Scalar> commands = model.predict(x);
    for (std::size_t rotor = 0; rotor < commands.size(); ++rotor) {
      const double golden = block.golden_commands[vector * commands.size() + rotor];
      result.golden_difference =
          std::max(result.golden_difference, std::abs(static_cast<double>(commands[rotor]) - golden));
    }
  }
  programs::ProgressLine progress("judging " + std::to_string(rows.size()) + " rows");
  std::size_t steps_done = 0;  // two per row
  const auto advance = [&] {
    progress.update(static_cast<double>(steps_done++) / (2 * static_cast<double>(rows.size())));
  };
  for (std::size_t row = 0; row < rows.size(); ++row) {
    advance();
    const auto x = sample_features<Features, Scalar>(rows[row]);
    bool inside = true;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto value = static_cast<double>(x[i]);
      inside = inside && value >= block.envelope_lower[i] && value <= block.envelope_upper[i];
    }
    result.outside_envelope += inside ? 0 : 1;
    const Commands<Scalar> u = model.predict(x);
    result.predictions.push_back(
        {static_cast<double>(u[0]), static_cast<double>(u[1]), static_cast<double>(u[2]), static_cast<double>(u[3])});
  }
  using Derivatives = programs::NetworkDerivatives<Features, Outputs>;
  const Derivatives derivatives(
      identity.networks.front(), block.parameters,
      programs::scaler_of<typename Derivatives::InputScaler>(block.input_mean, block.input_spread),
      programs::scaler_of<typename Derivatives::OutputScaler>(block.output_mean, block.output_spread),
      programs::RunTimeAirframe(identity.airframe.name, identity.airframe.value));
  result.wrong_derivatives = programs::wrong_derivative_shares(rows, [&](const Sample& sample) {
    advance();
    return derivatives(sample);
  });
  return result;
}

Evaluation evaluated(const programs::Block& block, const programs::Identity& identity, const RowSet& rows) {
  Evaluation result;
  programs::each_schema([&](auto features, auto outputs) {
    using Features = decltype(features);
    using Outputs = decltype(outputs);
    if (programs::detail::shape_hash_of<Features, Outputs>(identity.answer, identity.airframe) != block.shape_hash) {
      return;
    }
    result = block.is_double ? evaluated<Features, Outputs, double>(block, identity, rows)
                             : evaluated<Features, Outputs, float>(block, identity, rows);
  });
  return result;
}

/// The rows to judge: all of the flights, or of each (of the last one, where there are more than two) those that
/// `train` tests on.
RowSet chosen_rows(const Options& options, const Dataset& dataset) {
  if (options.rows == "test") {
    return dataset.size() < 3 ? split_each_flight(dataset).test : split_by_flight(dataset).test;
  }
  RowSet all;
  for (const Flight& flight : dataset.flights()) all.add(flight, {0, flight.size()});
  return all;
}

void print_json(const Options& options, const programs::Block& block, const programs::Identity& identity,
                const Dataset& dataset, const RowSet& rows, const Evaluation& evaluation,
                const programs::Judgement& judged) {
  nlohmann::json all = nlohmann::json::object();
  for (const programs::Figure& figure : programs::figures()) all[figure.name] = figure.of(judged, figure.index);
  nlohmann::json report = {{"model", block.path},
                           {"answer", identity.answer},
                           {"airframe", identity.airframe.name},
                           {"flight", programs::flight_names(dataset)},
                           {"rows", rows.size()},
                           {"rows_judged", options.rows},
                           {"rows_outside_envelope", evaluation.outside_envelope},
                           {"golden_vectors", block.golden_count},
                           {"golden_difference", evaluation.golden_difference},
                           {"figures", all}};
  report.update(programs::figures_of_model(judged));
  std::printf("%s\n", report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

void print_table(const programs::Block& block, const programs::Identity& identity, const Dataset& dataset,
                 const RowSet& rows, const Evaluation& evaluation, const programs::Judgement& judged) {
  std::printf("model       %s: %s, for %s\n", printable(block.path).c_str(), identity.answer.c_str(),
              identity.airframe.name.c_str());
  std::printf("rows        %zu of %s, %zu outside the training envelope\n", rows.size(),
              programs::flight_names(dataset).c_str(), evaluation.outside_envelope);
  const std::vector<programs::Result> results = {{"model", 0, judged, 0, 0}};
  programs::print_table(results, {"model"});
  programs::print_wrong_derivatives(results, {"model"});
}

int evaluate(const Options& options) {
  programs::end_at_interrupt();
  programs::ModelHints hints{options.airframe, options.answer, {}};
  const programs::Block block = programs::read_block(options.model, programs::block_bytes(options.model, hints));
  programs::require_present_alone(block);
  const programs::Identity identity = programs::identify(block, hints);
  if (identity.networks.size() != 1) throw InputError(block.path, 0, 0, "a network by itself", "a sum of some");
  const Dataset dataset = programs::read_flights(options.flights, minimum_flight_rows);
  const RowSet rows = chosen_rows(options, dataset);
  const Evaluation evaluation = evaluated(block, identity, rows);
  if (!(evaluation.golden_difference <= golden_tolerance)) {
    throw InputError(block.path, 0, 0, "golden commands that its weights give", "others");
  }
  programs::Judgement judged = programs::judge(
      programs::RunTimeAirframe(identity.airframe.name, identity.airframe.value), rows, evaluation.predictions);
  judged.wrong_derivative_share = evaluation.wrong_derivatives;
  if (options.json) {
    print_json(options, block, identity, dataset, rows, evaluation, judged);
  } else {
    print_table(block, identity, dataset, rows, evaluation, judged);
  }
  const double r_squared = judged.errors.mean.r_squared;
  if (std::isfinite(r_squared) && r_squared >= 0) return 0;
  programs::complain("evaluate", block.path + ": worse than the mean of the commands on these rows");
  return programs::exit_failed;
}

}  // namespace

programs::Command programs::evaluate_command(CLI::App& program) {
  CLI::App* line =
      program.add_subcommand("evaluate", "Judges an exported model on recorded flights, without compiling");
  const auto options = std::make_shared<Options>();
  add_path(*line, "model", options->model, "MODEL",
           "a header that pinnquad train exported (MODEL.hpp), or a model block, as --block writes it")
      ->required();
  add_paths(*line, "--flight", options->flights, "FILE.csv", "recorded flights to judge it on")->required();
  line->add_option("--rows", options->rows,
                   "all: every row; test: those that pinnquad train tests on when it is given these flights")
      ->capture_default_str()
      ->check(CLI::IsMember({"all", "test"}));
  add_path(*line, "--airframe", options->airframe, "NAME|FILE.toml",
           "what flew: a file, or one of: " + airframe_names() + " (default: the one that the model was trained for)");
  line->add_option("--answer", options->answer,
                   "the network as the model's header states it (answer = ...); needed of a block whose hidden layers "
                   "differ in width");
  line->add_flag("--json", options->json, "the figures as JSON");
  line->footer(
      "Examples:\n"
      "  pinnquad train --flight d1.csv --out my_model --block my_model/weights.block\n"
      "  pinnquad evaluate my_model/model.hpp --flight d1.csv --rows test\n"
      "  pinnquad evaluate my_model/weights.block --flight d2.csv --json\n"
      "Exit codes: 0; 1 it is worse than the mean of the commands; 2 bad input or a file that can't be read; 130\n"
      "interrupted.");
  return {line, [options] { return evaluate(*options); }};
}
