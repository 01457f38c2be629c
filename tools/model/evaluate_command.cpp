// SPDX-License-Identifier: MIT
// Judges a model block on recorded flights: the network is put together at run time, from what the block says of itself.
//   pinnquad evaluate my_model/weights.block --flight flight.csv --json
#include "model/evaluate_command.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/console.hpp"
#include "command_line/options.hpp"
#include "logs/training_flights.hpp"
#include "model/identity.hpp"
#include "pinnquad/data/sample_inputs.hpp"
#include "pinnquad/training/context_airframe.hpp"
#include "training/judgement.hpp"

namespace {

using namespace pinnquad;

struct Options {
  std::string block;
  std::vector<std::string> flights;
  std::string airframe;
  std::string answer;
  std::string rows = "all";
  bool json = false;
};

/// A block's network between its scalers, in the scalar of the block or in another one.
template <class Features, class Outputs, class Scalar>
class RunTimeModel {
 public:
  using FeatureVector = std::array<Scalar, static_cast<std::size_t>(Features::size)>;

  RunTimeModel(const programs::Block& block, const programs::Identity& identity)
      : network_(identity.network, block.parameters), airframe_(identity.airframe.name, identity.airframe.value) {
    const auto cast = [](const std::vector<double>& from, auto& to) {
      for (std::size_t i = 0; i < to.size(); ++i) to[i] = static_cast<Scalar>(from[i]);
    };
    cast(block.input_mean, input_.mean);
    cast(block.input_spread, input_.spread);
    cast(block.output_mean, output_.mean);
    cast(block.output_spread, output_.spread);
  }

  Commands<Scalar> predict(const FeatureVector& x) const {
    std::vector<Scalar> standardised(x.size());
    input_.standardise(x.data(), standardised.data());
    const std::vector<Scalar> made = network_.forward(std::move(standardised));
    std::array<Scalar, static_cast<std::size_t>(OutputMap<Outputs>::size)> outputs{};
    output_.restore(made.data(), outputs.data());
    Commands<Scalar> commands{};
    OutputMap<Outputs>::commands(x.data(), static_cast<const Scalar*>(outputs.data()),
                                 airframe_.template output_setting<Outputs, Scalar>(), commands.data());
    return commands;
  }

  Scalar spread(int feature) const { return input_.spread[static_cast<std::size_t>(feature)]; }

 private:
  programs::RunTimeNetwork<Scalar> network_;
  ContextAirframe<GivenAirframe> airframe_;
  Scaler<Scalar, Features::size> input_{};
  Scaler<Scalar, OutputMap<Outputs>::size> output_{};
};

/// What was found.
struct Evaluation {
  double golden_difference = 0;  ///< the largest of the golden vectors' commands
  programs::Predictions predictions;
  std::size_t outside_envelope = 0;
  std::array<double, 3> wrong_derivatives{};  ///< per axis, share of rows
};

/// Share of rows in which the command sum about each axis falls as the angular acceleration asked for about it rises; by a
/// central difference of the network in double, a thousandth of the feature's spread wide.
template <class Features, class Outputs>
std::array<double, 3> wrong_derivatives(const programs::Block& block, const programs::Identity& identity,
                                        const RowSet& rows) {
  const RunTimeModel<Features, Outputs, double> model(block, identity);
  const ContextAirframe<GivenAirframe> airframe(identity.airframe.name, identity.airframe.value);
  const std::array<std::array<double, rotor_count>, 3> signs = {airframe.signs<Roll>(), airframe.signs<Pitch>(),
                                                                airframe.signs<Yaw>()};
  std::array<double, 3> wrong{};
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const auto x = sample_features<Features, double>(rows[row]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto feature = static_cast<std::size_t>(Features::angular_acceleration) + axis;
      const double step = 1e-3 * model.spread(static_cast<int>(feature));
      auto above = x, below = x;
      above[feature] += step;
      below[feature] -= step;
      const double rise = signed_sum(signs[axis], model.predict(above)) - signed_sum(signs[axis], model.predict(below));
      wrong[axis] += rise < 0 ? 1.0 : 0.0;
    }
  }
  for (double& share : wrong) share /= static_cast<double>(rows.size());
  return wrong;
}

template <class Features, class Outputs, class Scalar>
Evaluation evaluated(const programs::Block& block, const programs::Identity& identity, const RowSet& rows) {
  using Model = RunTimeModel<Features, Outputs, Scalar>;
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
  for (std::size_t row = 0; row < rows.size(); ++row) {
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
  result.wrong_derivatives = wrong_derivatives<Features, Outputs>(block, identity, rows);
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

/// The rows to judge: all of the flights, or of each (of the last one, where there are more than two) those that `train` tests on.
RowSet chosen_rows(const Options& options, const Dataset& dataset) {
  if (options.rows == "test") {
    return dataset.size() < 3 ? split_each_flight(dataset).test : split_by_flight(dataset).test;
  }
  RowSet all;
  for (const Flight& flight : dataset.flights()) all.add(flight, {0, flight.size()});
  return all;
}

nlohmann::json by_axis(const std::array<double, 3>& values) {
  return {{"roll", values[0]}, {"pitch", values[1]}, {"yaw", values[2]}};
}

void print_json(const Options& options, const programs::Block& block, const programs::Identity& identity,
                const Dataset& dataset, const RowSet& rows, const Evaluation& evaluation,
                const programs::Judgement& judged) {
  std::array<double, 3> violations{}, slopes{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    violations[axis] = judged.axes[axis].sign_violation_share;
    slopes[axis] = judged.axes[axis].slope_error;
  }
  nlohmann::json all = nlohmann::json::object();
  for (const programs::Figure& figure : programs::figures()) all[figure.name] = figure.of(judged, figure.index);
  const nlohmann::json report = {{"model", block.path},
                                 {"answer", identity.answer},
                                 {"airframe", identity.airframe.name},
                                 {"flight", programs::flight_names(dataset)},
                                 {"rows", rows.size()},
                                 {"rows_judged", options.rows},
                                 {"rows_outside_envelope", evaluation.outside_envelope},
                                 {"golden_vectors", block.golden_count},
                                 {"golden_difference", evaluation.golden_difference},
                                 {"mean_absolute_error", judged.errors.mean.mean_absolute},
                                 {"rmse", judged.errors.mean.root_mean_square},
                                 {"r2", judged.errors.mean.r_squared},
                                 {"wrong_derivative_share", by_axis(evaluation.wrong_derivatives)},
                                 {"pair_violations", by_axis(violations)},
                                 {"slope_error", by_axis(slopes)},
                                 {"figures", all}};
  std::printf("%s\n", report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

void print_table(const programs::Block& block, const programs::Identity& identity, const Dataset& dataset,
                 const RowSet& rows, const Evaluation& evaluation, const programs::Judgement& judged) {
  std::printf("model       %s: %s, for %s\n", printable(block.path).c_str(), identity.answer.c_str(),
              identity.airframe.name.c_str());
  std::printf("rows        %zu of %s, %zu outside the training envelope\n", rows.size(),
              programs::flight_names(dataset).c_str(), evaluation.outside_envelope);
  programs::print_table({{"block", 0, judged, 0, 0}}, {"block"});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::printf("  %-34s  %20.2f\n",
                (std::string("wrong derivatives, % of rows, ") + programs::axis_names[axis]).c_str(),
                100 * evaluation.wrong_derivatives[axis]);
  }
}

int evaluate(const Options& options) {
  const programs::Block block = programs::read_block(options.block);
  const programs::Identity identity = programs::identify(block, options.airframe, options.answer);
  const Dataset dataset = programs::read_flights(options.flights, minimum_flight_rows);
  const RowSet rows = chosen_rows(options, dataset);
  const Evaluation evaluation = evaluated(block, identity, rows);
  if (!(evaluation.golden_difference <= golden_tolerance)) {
    throw InputError(block.path, 0, 0, "golden commands that its weights give", "others");
  }
  const programs::Judgement judged = programs::judge(
      ContextAirframe<GivenAirframe>(identity.airframe.name, identity.airframe.value), rows, evaluation.predictions);
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
  CLI::App* line = program.add_subcommand("evaluate", "Judges a model block on recorded flights, without compiling");
  const auto options = std::make_shared<Options>();
  add_path(*line, "block", options->block, "BLOCK", "a model block, as pinnquad train --block writes it")->required();
  add_paths(*line, "--flight", options->flights, "FILE.csv", "recorded flights to judge it on")->required();
  line->add_option("--rows", options->rows,
                   "all: every row; test: those that pinnquad train tests on when it is given these flights")
      ->capture_default_str()
      ->check(CLI::IsMember({"all", "test"}));
  add_path(*line, "--airframe", options->airframe, "NAME|FILE.toml",
           "what flew: a file, or one of: " + airframe_names() + " (default: the one that the block was trained for)");
  line->add_option(
      "--answer", options->answer,
      "the network as the model's header states it (answer = ...); needed where hidden layers differ in width");
  line->add_flag("--json", options->json, "the figures as JSON");
  line->footer(
      "Examples:\n"
      "  pinnquad train --flight d1.csv --out my_model --block my_model/weights.block\n"
      "  pinnquad evaluate my_model/weights.block --flight d1.csv --rows test\n"
      "Exit codes: 0; 1 it is worse than the mean of the commands; 2 bad input or a file that can't be read.");
  return {line, [options] { return evaluate(*options); }};
}
