// SPDX-License-Identifier: MIT
#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "airframe/choice.hpp"
#include "command_line/command.hpp"
#include "command_line/console.hpp"
#include "command_line/file_roles.hpp"
#include "command_line/folder_lock.hpp"
#include "command_line/interrupt.hpp"
#include "command_line/options.hpp"
#include "command_line/progress_line.hpp"
#include "pinnquad/deploy/cpp_text.hpp"
#include "pinnquad/deploy/export_model.hpp"
#include "study/wrench_fit.hpp"
#include "training/train_input.hpp"

namespace study {

namespace {

using namespace programs;

constexpr std::array<const char*, 3> wrench_files = {"wrench.hpp", "wrench.block", "wrench.json"};
constexpr std::array<const char*, 6> component_names = {"force_x",  "force_y",  "force_z",
                                                        "torque_x", "torque_y", "torque_z"};

nlohmann::json by_component(const std::array<double, 6>& values) {
  nlohmann::json object = nlohmann::json::object();
  for (std::size_t k = 0; k < values.size(); ++k) object[component_names[k]] = values[k];
  return object;
}

/// The share of the variance that is left, mean over the components.
double left_share(const WrenchJudgement& judged) {
  double sum = 0;
  for (const double r_squared : judged.r_squared) sum += 1 - r_squared;
  return sum / static_cast<double>(judged.r_squared.size());
}

int train_wrench(const TrainOptions& options) {
  pinnquad::require_identifier("--name", options.model_name);
  const NamedAirframe airframe = chosen_airframe(options.airframe.empty() ? PaperQuadrotor::name : options.airframe);
  FileRoles roles;
  for (const auto* paths : {&options.flights, &options.logs}) {
    for (const std::string& path : *paths) roles.reads("FLIGHTS", path);
  }
  if (!options.dataset.empty()) roles.reads("FLIGHTS", options.dataset);
  if (is_airframe_file(options.airframe)) roles.reads("--airframe", options.airframe);
  for (const char* name : wrench_files) roles.writes("--out", options.out + "/" + name);
  pinnquad::logs::ImportedDataset dataset = dataset_of(options, airframe.value);
  // what is left of the rotors' lag: of flights only a latency was removed
  const double lag_removed_s = options.flights.empty() ? dataset.lag_removed_s : 0;
  Dataset flights;
  for (const Flight& flight : dataset.flights.flights()) {
    flights.add(with_rotor_states(flight, airframe.value, lag_removed_s));
  }
  dataset.flights = std::move(flights);
  const std::vector<Fold> folds = folds_asked_for(options, dataset);
  require_sound(options, dataset, folds);
  const RowSplit& split = folds.front().split;
  const GivenAirframe flown(airframe.name, airframe.value);

  WrenchTraining how;
  if (options.epochs > 0) how.epochs = options.epochs;
  WrenchModel best{WrenchContext{flown}};
  WrenchJudgement validated;
  std::uint64_t best_seed = options.seed;
  {
    ProgressLine progress("residual wrench");
    for (int i = 0; i < options.seeds; ++i) {
      how.seed = options.seed + static_cast<std::uint64_t>(i);
      const WrenchModel model = fit_wrench(split.train, split.validation, flown, how, [&](int epoch) {
        stop_if_interrupted();
        progress.update((i + static_cast<double>(epoch) / how.epochs) / options.seeds);
        return true;
      });
      const WrenchJudgement judged = judge_wrench(model, split.validation);
      if (i > 0 && !(left_share(judged) < left_share(validated))) continue;
      best = model;
      validated = judged;
      best_seed = how.seed;
    }
  }
  const WrenchJudgement judged = judge_wrench(best, split.test);
  std::printf("residual wrench of %s, %zu rows to train on, seed %llu; on %zu rows that it has not seen:\n",
              printable(airframe.name).c_str(), split.train.size(), static_cast<unsigned long long>(best_seed),
              split.test.size());
  for (std::size_t k = 0; k < component_names.size(); ++k) {
    std::printf("  %-9s R^2 %6.3f of a standard deviation of %.3g %s\n", component_names[k], judged.r_squared[k],
                judged.deviation[k], AccelerationOutputs::units[k]);
  }
  if (!(left_share(judged) < 1) && !options.allow_poor) {
    complain("wrench", "nothing exported: on the rows held out it is worse than the mean of their residual wrench");
    return exit_failed;
  }

  const FolderLock lock(options.out);
  Provenance from;
  from.training_data = flight_names(dataset.flights);
  from.training_data_hash = content_hash(dataset.flights);
  from.training_rows = split.train.size();
  from.seed = best_seed;
  from.epochs = how.epochs;
  from.loss = "mean squared error of the residual wrench";
  from.sample_period_s = sample_period_s(split.train);
  from.lag_removed_s = lag_removed_s;
  from.signs_unproven = true;
  const std::array<std::string, 3> files = {options.out + "/" + wrench_files[0], options.out + "/" + wrench_files[1],
                                            options.out + "/" + wrench_files[2]};
  AtomicFile report(files[2]);
  report.stream() << nlohmann::json({{"airframe", airframe.name},
                                     {"training_rows", split.train.size()},
                                     {"test_rows", split.test.size()},
                                     {"seed", best_seed},
                                     {"epochs", how.epochs},
                                     {"test_r_squared", by_component(judged.r_squared)},
                                     {"test_deviation", by_component(judged.deviation)},
                                     {"validation_r_squared", by_component(validated.r_squared)}})
                         .dump(1, ' ', false, nlohmann::json::error_handler_t::replace)
                  << '\n';
  export_model(Exported::Files{files[0], files[1], ""}, options.model_name, best, split, from);
  report.commit();
  for (const std::string& file : files) std::printf("  %s\n", printable(file).c_str());
  return 0;
}

}  // namespace

programs::Command wrench_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand(
      "wrench",
      "Trains the residual wrench of a vehicle, what its motion has beyond rotors and gravity, on rows no further "
      "apart than the rotors lag");
  struct Asked {
    TrainOptions options;
    std::string lag = "auto";
  };
  const auto asked = std::make_shared<Asked>();
  TrainOptions& options = asked->options;
  options.airframe = PaperQuadrotor::name;
  options.model_name = "TrainedWrench";
  add_sources(*line, options.flights, options.mapping);
  line->add_option("--hold-out", options.hold_out, "flights or trajectories kept for testing, all together")
      ->delimiter(',')
      ->type_name("NAME,...");
  line->add_option("--airframe", options.airframe, "what flew: a file FILE.toml, or one of: " + airframe_names())
      ->capture_default_str();
  line->add_option("--lag", asked->lag, "from command to motion, removed from the commands of flights")
      ->type_name("auto|SECONDS")
      ->capture_default_str();
  add_path(*line, "--out", options.out, "DIR", "folder for wrench.block, wrench.hpp and wrench.json")->required();
  line->add_option("--name", options.model_name, "name of the exported struct")->capture_default_str();
  add_number(*line, "--seeds", options.seeds, 1, static_cast<int>(most_pairs), "trainings, of which the best is kept");
  add_number(*line, "--epochs", options.epochs, 0, 100000, "training epochs; 0: the usual number");
  add_number(*line, "--seed", options.seed, std::uint64_t{0}, most_seed, "first seed")->type_name("N");
  line->add_flag("--allow-poor", options.allow_poor, "export it even if it is worse than the mean of the wrench");
  line->footer(
      "Examples:\n"
      "  pinnquad-study wrench hard10.csv --airframe light_quadrotor --out w\n"
      "Exit codes: 0; 1 nothing exported: it is worse than the mean; 2 bad input; 130 interrupted.");
  return {line, [asked] {
            asked->options.lag_s = lag_of(asked->lag);
            take_source(asked->options);
            return train_wrench(asked->options);
          }};
}

}  // namespace study
