// SPDX-License-Identifier: MIT
// Trains the linearized model's rivals on recorded flights, judges all on rows that none was trained on (the last part of one
// flight, or the last of several flights), exports the best physics-informed network as a header. Flights of real vehicles
// (--dataset, --log) are judged by held-out flights instead: training/train_logs.hpp.
//   pinnquad train --flight flight.csv --airframe paper_quadrotor --seeds 5 --epochs 300 --out DIR
#include "training/train_command.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "airframe/choice.hpp"
#include "command_line/console.hpp"
#include "command_line/file_roles.hpp"
#include "command_line/folder_lock.hpp"
#include "command_line/listed.hpp"
#include "command_line/options.hpp"
#include "logs/training_flights.hpp"
#include "pinnquad/data/csv.hpp"
#include "pinnquad/data/sample_period.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/evaluation/model_errors.hpp"
#include "training/judge_all.hpp"
#include "training/judgement.hpp"
#include "training/log_options.hpp"
#include "training/model_figures.hpp"
#include "training/model_predictions.hpp"
#include "training/plots.hpp"
#include "training/recipe.hpp"
#include "training/train_logs.hpp"
#include "training/training_report.hpp"

namespace {

using namespace pinnquad;

/// Fewer rows than this can't train 6,379 weights to anything worth flying: 20 batches of 64 in the 60 % that train.
constexpr std::size_t minimum_rows = 2200;

struct Options {
  std::vector<std::string> flights;
  std::string airframe = PaperQuadrotor::name;
  std::string out = "demo_out";
  std::string model_name = "TrainedQuadModel";
  std::string block;  ///< where to write the weights as a block too; empty: nowhere
  std::string recipe = "paper";
  std::vector<std::string> losses = {programs::vanilla.key, programs::physics_informed.key};
  int seeds = 5;
  int epochs = 300;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  bool allow_poor = false;            ///< export what is worse than the mean, marked as such
  programs::LogTrainingOptions logs;  ///< what --dataset and --log ask for besides
};

/// Warns of features that stand still in the training rows: they are exported, and flown only where they stood.
template <class Features>
void warn_of_still_features(const RowSet& training, programs::TrainingReport& report) {
  const std::string names = programs::listed(still_features<Features>(training));
  if (names.empty()) return;
  report.warn(names +
              ": nothing changes in the training rows; the model will not know what it does, and answers only near the "
              "value flown");
}

/// The pictures of the networks `shown` (indices of results), the best of each kind.
void draw(const ContextAirframe<GivenAirframe>& airframe, const std::string& folder, const RowSet& test,
          const std::vector<programs::Result>& results, const std::vector<programs::Predictions>& predictions,
          const std::vector<std::size_t>& shown, const std::vector<std::string>& kinds) {
  std::vector<std::string> shown_names;
  std::vector<std::array<programs::AxisSeries, 3>> series;
  std::vector<programs::Judgement> judged;
  std::vector<double> time_s, target;
  std::vector<std::vector<double>> command(shown.size());
  // of one flight: a curve over its clock
  const std::size_t excerpt = std::min<std::size_t>(test.pieces().front().rows.size(), 200);
  for (std::size_t row = 0; row < excerpt; ++row) {
    time_s.push_back(test[row].time_s);
    target.push_back(test[row].commands[0]);
  }
  for (std::size_t s = 0; s < shown.size(); ++s) {
    shown_names.push_back(results[shown[s]].model);
    series.push_back(programs::axis_series(airframe, test, predictions[shown[s]]));
    judged.push_back(results[shown[s]].test);
    for (std::size_t i = 0; i < excerpt; ++i) command[s].push_back(predictions[shown[s]][i][0]);
  }
  const bool drawn = programs::plot_ellipses(folder + "ellipses.svg", shown_names, series, judged) &&
                     programs::plot_errors(folder + "errors.svg", results, kinds) &&
                     programs::plot_prediction(folder + "prediction.svg", time_s, target, shown_names, command);
  if (drawn) std::printf("  pictures: %sellipses.svg, errors.svg, prediction.svg\n", folder.c_str());
}

/// "; of an earlier training: ..." with the files an export would have replaced; nothing where there are none.
std::string earlier_export(const Options& options) {
  std::vector<std::string> there;
  for (const std::string& path : {options.out + "/model.hpp", options.out + "/replay.txt", options.block}) {
    std::error_code ignored;
    if (!path.empty() && std::filesystem::exists(path, ignored)) there.push_back(path);
  }
  return there.empty() ? "" : "; of an earlier training: " + programs::listed(there);
}

std::string four_digits(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.4f", value);
  return text;
}

/// Says how the best network stands beside the mean and linear regression. Why it must not be exported; empty if it may.
std::string reason_against_export(const Options& options, const Verdict& verdict, programs::TrainingReport& report) {
  std::printf(
      "  best network on the test rows: R^2 %.4f, worst motor %.4f; linear regression on the same features: R^2 %.4f\n",
      verdict.test_r_squared, verdict.worst_motor_r_squared, verdict.linear_regression_r_squared);
  std::fflush(stdout);
  if (verdict.worse_than_mean()) {
    if (!options.allow_poor) {
      return "on the test rows the best network is worse than the mean of the commands (R^2 " +
             four_digits(verdict.test_r_squared) + ", worst motor " + four_digits(verdict.worst_motor_r_squared) + ")";
    }
    report.warn("NOT FOR FLIGHT: the best network is worse than the mean of the commands");
  } else if (!verdict.beats_linear_regression()) {
    report.warn("the best network does not beat linear regression on the same features (R^2 " +
                four_digits(verdict.test_r_squared) + " against " + four_digits(verdict.linear_regression_r_squared) +
                "): a linear map would fly as well");
  }
  if (verdict.has_poor_motor()) {
    report.warn("one motor's commands are predicted worse than by their mean (R^2 " +
                four_digits(verdict.worst_motor_r_squared) + " on the test rows)");
  }
  return {};
}

void export_network(const Options& options, const programs::Training& training, const RowSplit& split,
                    const Provenance& provenance) {
  const programs::TrainedNetwork& network = *training.network;
  network.write_header(options.out + "/model.hpp", options.model_name, split.train, provenance);
  network.write_replay(options.out + "/replay.txt", split.test);
  std::printf("  %s/model.hpp: struct %s, %s of seed %llu (least error on the validation rows)%s\n",
              options.out.c_str(), options.model_name.c_str(), training.loss.title,
              static_cast<unsigned long long>(provenance.seed),
              provenance.verdict->worse_than_mean() ? "; NOT FOR FLIGHT, and its header says so" : "");
  if (options.block.empty()) return;
  const std::vector<unsigned char> block = network.block(split.train, provenance);
  write_weight_file(options.block, block);
  std::printf("  %s: the same weights as a block of %zu bytes\n", options.block.c_str(), block.size());
}

int train_judge_export(const Options& options, const programs::Recipe& recipe,
                       const std::vector<programs::LossName>& losses, const programs::NamedAirframe& given,
                       const Dataset& dataset) {
  const RowSplit split = dataset.size() == 1 ? split_each_flight(dataset) : split_by_flight(dataset);
  programs::require_varied_commands(options.flights, dataset, split.train, "training");
  programs::require_varied_commands(options.flights, dataset, split.validation, "validation");
  programs::require_varied_commands(options.flights, dataset, split.test, "test");
  programs::TrainingPlan plan{
      {given.name, given.value},
      !programs::is_airframe_file(options.airframe),
      split,
      losses,
      options.epochs,
      options.seed,
      options.seeds,
      options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency())};
  programs::TrainingReport report(options.out + "/report.json", recipe, plan, dataset);
  warn_of_still_features<PaperFeatures>(split.train, report);
  programs::print_split(dataset, split);
  std::printf("      network %s; %s, batch %d, %d epochs, %d seeds\n", recipe.network.c_str(), recipe.optimizer.c_str(),
              recipe.settings.at("batch").get<int>(), options.epochs, options.seeds);
  std::fflush(stdout);

  programs::catch_interrupt();
  const std::vector<programs::Training> trainings = recipe.train(plan);

  std::printf("[3/5] judge\n");
  std::fflush(stdout);
  std::vector<programs::Predictions> predictions;
  const std::vector<programs::Result> results = programs::judge_all(plan, trainings, predictions);
  const double regression_r_squared = linear_regression_errors<PaperFeatures>(split.train, split.test).mean.r_squared;

  const programs::LossName& exported_loss = programs::exported_loss(plan.losses);
  const std::optional<std::size_t> best = programs::best_of(results, exported_loss.title);
  const std::string folder = options.out + "/";
  report.judged(results, trainings.size());
  Verdict verdict;
  if (best) {
    verdict = verdict_on(results[*best].test.errors, regression_r_squared);
    report.best(results[*best], verdict, !verdict.worse_than_mean() || options.allow_poor);
  }
  programs::write_results(folder + "results.csv", results);

  std::vector<std::string> kinds = {programs::linear_name};
  for (const programs::LossName& loss : plan.losses) kinds.push_back(loss.title);
  programs::print_table(results, kinds);
  programs::print_signs(results, kinds);
  for (const programs::LossName& loss : plan.losses) {
    if (plan.losses.front().key != programs::vanilla.key || loss.key == programs::vanilla.key) continue;
    programs::print_paired(results, loss.title, programs::vanilla.title);
  }
  double seconds = 0;
  for (const programs::Result& result : results) seconds += result.training_s;
  if (!trainings.empty()) {
    std::printf("  training took %.2f s per network and core\n", seconds / static_cast<double>(trainings.size()));
  }
  if (!best) {
    const bool none = programs::over_seeds(results, exported_loss.title, programs::figures().front()).empty();
    const std::string reason = std::string("no ") + exported_loss.title + " network " +
                               (none ? "was finished" : "predicts finite commands on the validation rows");
    report.write_not_exported(reason);
    programs::complain("train", reason + "; nothing to export" + earlier_export(options));
    return programs::interrupted() ? programs::exit_interrupted : programs::exit_failed;
  }
  const std::string reason = reason_against_export(options, verdict, report);
  // before the export: a disk that is full then costs the export alone
  report.write_not_exported(reason.empty() ? "the export was not finished" : reason);
  if (reason.empty()) {
    std::printf("[4/5] export\n");
    Provenance from{programs::flight_names(dataset),
                    content_hash(dataset),
                    split.train.size(),
                    results[*best].seed,
                    options.epochs,
                    exported_loss.words,
                    verdict};
    from.sample_period_s = sample_period_s(split.train);
    export_network(options, trainings[*best - 1], split, from);  // results[0] is the linearized model
    report.write_exported(folder + "model.hpp", options.block);
  } else {
    programs::complain("train", "not exported: " + reason + "; more epochs or a better flight, or --allow-poor" +
                                    earlier_export(options));
  }
  // last: a picture that cannot be drawn costs nothing else
  std::vector<std::size_t> shown;
  for (const programs::LossName& loss : plan.losses) {
    const std::optional<std::size_t> best_of_loss = programs::best_of(results, loss.title);
    if (best_of_loss) shown.push_back(*best_of_loss);
  }
  draw(plan.airframe, folder, split.test, results, predictions, shown, kinds);
  if (programs::interrupted()) {
    std::fprintf(stderr, "train: interrupted; %zu of %zu trainings were finished and kept\n", trainings.size(),
                 plan.losses.size() * static_cast<std::size_t>(options.seeds));
    return programs::exit_interrupted;
  }
  return reason.empty() ? 0 : programs::exit_failed;
}

/// The files of --out.
constexpr std::array<const char*, 7> output_names = {"results.csv",    "report.json", "ellipses.svg", "errors.svg",
                                                     "prediction.svg", "model.hpp",   "replay.txt"};

/// No output takes the place of a flight or of another output.
void require_separate_files(const Options& options) {
  programs::FileRoles roles;
  for (const std::string& path : options.flights) roles.reads("--flight", path);
  if (programs::is_airframe_file(options.airframe)) roles.reads("--airframe", options.airframe);
  roles.writes("--out", options.out);
  for (const char* name : output_names) roles.writes("--out", options.out + "/" + name);
  roles.writes("--block", options.block);
}

/// What logs and flights have in common, as training on logs takes it; `given(name)`: the option is in the command line.
template <class Given>
programs::LogTrainingOptions log_options(const Options& options, const Given& given) {
  programs::LogTrainingOptions logs = options.logs;
  logs.airframe = given("--airframe") ? options.airframe : "";
  logs.out = options.out;
  logs.model_name = options.model_name;
  logs.block = options.block;
  logs.seeds = options.seeds;
  logs.epochs = given("--epochs") ? options.epochs : 0;
  logs.seed = options.seed;
  logs.threads = options.threads;
  logs.allow_poor = options.allow_poor;
  return logs;
}

/// Trains on the flights of the options: the exit code.
int train_chosen(const Options& options) {
  if (!is_identifier(options.model_name)) {
    throw std::invalid_argument("--name " + options.model_name +
                                ": a C++ identifier was expected, no keyword and no name that C++ reserves");
  }
  const programs::Recipe recipe = programs::chosen_recipe(options.recipe);
  std::vector<programs::LossName> losses = programs::chosen_losses(options.losses);
  losses.insert(losses.end(), recipe.besides.begin(), recipe.besides.end());
  const programs::NamedAirframe airframe = programs::chosen_airframe(options.airframe);
  require_separate_files(options);
  programs::end_at_interrupt();  // while nothing is worth keeping
  const Dataset dataset = programs::read_flights(options.flights, minimum_rows);
  const programs::FolderLock folder(options.out);
  // what cannot be written is found before the training
  for (const char* name : output_names) AtomicFile probe(options.out + "/" + name);
  if (!options.block.empty()) AtomicFile probe(options.block);
  return train_judge_export(options, recipe, losses, airframe, dataset);
}

void add_options(CLI::App& app, Options& options) {
  using programs::add_number;
  using programs::add_path;
  app.footer(
      "Examples:\n"
      "  pinnquad train --flight d1.csv --out my_model\n"
      "  pinnquad train --flight a.csv --flight b.csv --flight c.csv --airframe mine.toml --recipe best\n"
      "  pinnquad train --flight d1.csv --recipe small --block weights.block\n"
      "  pinnquad train --log logs --mapping px4 --hold-out flight7 --out my_model\n"
      "  pinnquad train --dataset my_logs --hold-out-each trajectory --out my_model\n"
      "Exit codes: 0; 1 nothing exported: no network was finished, or the best is worse than the mean of the "
      "commands;\n"
      "2 bad input or a file that can't be read or written; 130 interrupted, what is finished is kept.\n"
      "Without gnuplot the pictures are left out, with a line.");
  programs::add_paths(
      app, "--flight", options.flights, "FILE.csv",
      "recorded flight, CSV as `pinnquad fly` writes it: its first part trains, its last tests. Of three or more, "
      "whole flights, in this order: the first train, the last test");
  app.add_option("--airframe", options.airframe,
                 "what flew: a file FILE.toml (examples/airframes), or one of: " + programs::airframe_names())
      ->capture_default_str();
  add_path(app, "--out", options.out, "DIR", "folder for results, pictures and the exported header")
      ->default_str(options.out);
  std::string recipes;
  for (const auto& make : programs::recipes) {
    const programs::Recipe recipe = make();
    recipes += std::string(recipes.empty() ? "" : "; ") + recipe.name + ": " + recipe.summary;
  }
  const std::string losses =
      programs::listed(programs::loss_names, [](const programs::LossName& loss) { return loss.key; });
  app.add_option("--recipe", options.recipe, "network and optimiser. " + recipes)->capture_default_str();
  app.add_option("--loss", options.losses, "what to train under, any of: " + losses)
      ->delimiter(',')
      ->type_name("NAME,...")
      ->default_str("vanilla,physics_informed");
  app.add_option("--name", options.model_name, "name of the exported struct")->capture_default_str();
  add_path(app, "--block", options.block, "FILE", "also write the exported weights as a model block");
  add_number(app, "--seeds", options.seeds, 1, static_cast<int>(most_pairs), "networks per kind");
  add_number(app, "--epochs", options.epochs, 1, 100000, "training epochs");
  add_number(app, "--seed", options.seed, std::uint64_t{0}, programs::most_seed,
             "first seed (initialisation and batch order)")
      ->type_name("N");
  add_number(app, "--threads", options.threads, 1u, 1024u, "trainings at once (default: all cores)")->default_str("");
  app.add_flag("--allow-poor", options.allow_poor,
               "export the best network even if it is worse than the mean of the commands; its header says so");
}

}  // namespace

programs::Command programs::train_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand(
      "train", "Trains models on flights, judges them on rows that none was trained on, exports the best as a header");
  const auto options = std::make_shared<Options>();
  add_options(*line, *options);
  add_log_options(*line, options->logs);
  return {line, [options, line] {
            require_one_source(*line);
            if (!options->flights.empty()) return train_chosen(*options);
            return train_on_logs(log_options(*options, [line](const char* name) { return line->count(name) > 0; }));
          }};
}
