// SPDX-License-Identifier: MIT
// Trains the linearized model's rivals on recorded flights, judges all on rows that none was trained on (the last part of one
// flight, or the last of several flights), exports the best physics-informed network as a header.
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
#include "command_line/options.hpp"
#include "logs/training_flights.hpp"
#include "pinnquad/data/csv.hpp"
#include "pinnquad/data/sample_period.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "training/campaign.hpp"
#include "training/judgement.hpp"
#include "training/model_predictions.hpp"
#include "training/plots.hpp"

namespace {

using namespace pinnquad;

constexpr const char* linear_name = "linearized";
constexpr std::size_t golden_count = 8;
/// Fewer rows than this can't train 6,379 weights to anything worth flying: 20 batches of 64 in the 60 % that train.
constexpr std::size_t minimum_rows = 2200;

struct Options {
  std::vector<std::string> flights;
  std::string airframe = PaperQuadrotor::name;
  std::string out = "demo_out";
  std::string model_name = "TrainedQuadModel";
  std::string block;  ///< where to write the weights as a block too; empty: nowhere
  int seeds = 5;
  int epochs = 300;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  bool allow_poor = false;  ///< export what is worse than the mean, marked as such
};

/// The test rows as the flight side is asked it, and what the trainer predicts: a line of counts, then a row of numbers per
/// sample: v_dot (3), omega_dot (3), v (3), omega (3), attitude (w, x, y, z), predicted u (4), flown u (4).
template <class Model>
void write_replay(const std::string& path, const Model& model, const RowSet& rows) {
  using Inputs = MotionInputs<typename Model::Scalar>;
  AtomicFile file(path);
  file.stream() << "pinnquad-replay 1 " << rows.size() << " 24\n";
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const Sample& sample = rows[row];
    const Inputs in = SampleInputs<Inputs>::from(sample);
    const auto predicted = model.predict(sample);
    std::string line;
    const auto add = [&line](double value) { line += (line.empty() ? "" : " ") + number_text(value); };
    for (const auto* vector :
         {&in.linear_acceleration_m_s2, &in.angular_acceleration_rad_s2, &in.velocity_m_s, &in.body_rates_rad_s}) {
      for (int i = 0; i < 3; ++i) add(static_cast<double>((*vector)[i]));
    }
    for (const auto v : {in.attitude.w, in.attitude.x, in.attitude.y, in.attitude.z}) add(static_cast<double>(v));
    for (const auto u : predicted) add(static_cast<double>(u));
    for (const double u : sample.commands) add(u);
    file.stream() << line << '\n';
  }
  file.commit();
}

/// Evenly spaced training rows: inside the envelope by construction.
template <class Model>
std::vector<typename Model::FeatureVector> golden_features(const RowSet& rows) {
  std::vector<typename Model::FeatureVector> golden;
  for (std::size_t i = 0; i < golden_count; ++i) {
    const std::size_t row = i * (rows.size() - 1) / (golden_count - 1);
    golden.push_back(sample_features<typename Model::Features, typename Model::Scalar>(rows[row]));
  }
  return golden;
}

/// Warns of features that stand still in the training rows: they are exported, and flown only where they stood.
template <class Features>
void warn_of_still_features(const RowSet& training) {
  std::string names;
  for (const std::string& name : still_features<Features>(training)) names += (names.empty() ? "" : ", ") + name;
  if (names.empty()) return;
  std::fprintf(stderr,
               "train: warning: %s: nothing changes in the training rows; the model will not know what it does, and "
               "answers only near the value flown\n",
               names.c_str());
}

/// The linearized model and every network on the test rows; predictions in the order of the results.
template <class Vehicle, class Model>
std::vector<programs::Result> judge_all(const ContextAirframe<Vehicle>& airframe, const RowSplit& split,
                                        const std::vector<programs::Training>& trainings,
                                        const std::vector<Model>& models,
                                        std::vector<programs::Predictions>& predictions) {
  const auto judged = [&](const std::string& name, std::uint64_t seed, double training_s, const auto& predict) {
    predictions.push_back(predict(split.test));
    programs::Result result{name, seed, {}, 0, training_s};
    result.test = programs::judge(airframe, split.test, predictions.back());
    result.validation_error =
        programs::judge(airframe, split.validation, predict(split.validation)).errors.mean.mean_absolute;
    return result;
  };
  std::vector<programs::Result> results;
  results.push_back(judged(linear_name, 0, 0, [&](const RowSet& rows) {
    return programs::linear_predictions(airframe.template airframe<double>(), rows);
  }));
  for (std::size_t i = 0; i < trainings.size(); ++i) {
    const programs::Training& training = trainings[i];
    results.push_back(judged(programs::kind_name(training.kind), training.seed, training.training_s,
                             [&](const RowSet& rows) { return programs::network_predictions(models[i], rows); }));
  }
  return results;
}

/// The pictures of the networks `shown` (indices of results), the best of each kind.
template <class Vehicle>
void draw(const ContextAirframe<Vehicle>& airframe, const std::string& folder, const RowSet& test,
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
  std::string names;
  for (const std::string& path : {options.out + "/model.hpp", options.out + "/replay.txt", options.block}) {
    std::error_code ignored;
    if (!path.empty() && std::filesystem::exists(path, ignored)) names += (names.empty() ? "" : ", ") + path;
  }
  return names.empty() ? names : "; of an earlier training: " + names;
}

/// Says how the best network stands beside the mean and linear regression. False if it must not be exported.
bool fit_for_export(const Options& options, const Verdict& verdict) {
  std::printf(
      "  best network on the test rows: R^2 %.4f, worst motor %.4f; linear regression on the same features: R^2 %.4f\n",
      verdict.test_r_squared, verdict.worst_motor_r_squared, verdict.linear_regression_r_squared);
  std::fflush(stdout);
  if (verdict.worse_than_mean()) {
    if (!options.allow_poor) {
      char r_squared[64];
      std::snprintf(r_squared, sizeof r_squared, "%.4f, worst motor %.4f", verdict.test_r_squared,
                    verdict.worst_motor_r_squared);
      programs::complain("train",
                         "not exported: on the test rows the best network is worse than the mean of the commands "
                         "(R^2 " +
                             std::string(r_squared) + "); more epochs or a better flight, or --allow-poor" +
                             earlier_export(options));
      return false;
    }
    std::fprintf(stderr, "train: warning: NOT FOR FLIGHT: the best network is worse than the mean of the commands\n");
  } else if (!verdict.beats_linear_regression()) {
    std::fprintf(stderr,
                 "train: warning: the best network does not beat linear regression on the same features (R^2 %.4f "
                 "against %.4f): a linear map would fly as well\n",
                 verdict.test_r_squared, verdict.linear_regression_r_squared);
  }
  if (verdict.has_poor_motor()) {
    std::fprintf(stderr,
                 "train: warning: one motor's commands are predicted worse than by their mean (R^2 %.4f on the test "
                 "rows)\n",
                 verdict.worst_motor_r_squared);
  }
  return true;
}

template <class Model>
void export_model(const Options& options, const Model& model, const RowSplit& split, const Provenance& provenance) {
  const auto golden = golden_features<Model>(split.train);
  write_model_header(options.out + "/model.hpp", options.model_name, model, golden, provenance);
  write_replay(options.out + "/replay.txt", model, split.test);
  std::printf("  %s/model.hpp: struct %s, %s of seed %llu (least error on the validation rows)%s\n",
              options.out.c_str(), options.model_name.c_str(), programs::kind_name(programs::Kind::physics_informed),
              static_cast<unsigned long long>(provenance.seed),
              provenance.verdict->worse_than_mean() ? "; NOT FOR FLIGHT, and its header says so" : "");
  if (options.block.empty()) return;
  const std::vector<unsigned char> block = model_block(model, golden, provenance);
  write_weight_file(options.block, block);
  std::printf("  %s: the same weights as a block of %zu bytes\n", options.block.c_str(), block.size());
}

template <class Vehicle>
int train_judge_export(const Options& options, const ContextAirframe<Vehicle>& airframe, const Dataset& dataset) {
  using Context = Context<PaperFeatures, Vehicle>;
  using Model = TrainedModel<programs::PaperNetwork, Context>;
  const RowSplit split = dataset.size() == 1 ? split_each_flight(dataset) : split_by_flight(dataset);
  programs::require_varied_commands(options.flights, dataset, split.train, "training");
  programs::require_varied_commands(options.flights, dataset, split.validation, "validation");
  programs::require_varied_commands(options.flights, dataset, split.test, "test");
  warn_of_still_features<PaperFeatures>(split.train);
  const Context context = make_context<Context>(split.train, airframe);
  const auto data = standardised<float>(context, split.train);
  programs::print_split(dataset, split);
  std::printf("      network %d -> 10 x 25 ReLU -> %d, %d parameters; Adam, batch 64, %d epochs, %d seeds\n",
              programs::PaperNetwork::inputs, programs::PaperNetwork::outputs, programs::PaperNetwork::parameter_count,
              options.epochs, options.seeds);
  std::fflush(stdout);

  programs::catch_interrupt();
  const unsigned threads = options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  const std::vector<programs::Training> trainings =
      programs::train_all(context, data, options.epochs, options.seed, options.seeds, threads);

  std::printf("[3/5] judge\n");
  std::vector<Model> models;
  for (const programs::Training& training : trainings) {
    models.push_back(make_trained_model(training.network, context, split.train));
  }
  std::vector<programs::Predictions> predictions;
  const auto results = judge_all(airframe, split, trainings, models, predictions);
  const auto regression = programs::regression_predictions<PaperFeatures>(split.train, split.test);
  const double regression_r_squared = programs::judge(airframe, split.test, regression).errors.mean.r_squared;

  const std::string vanilla = programs::kind_name(programs::Kind::vanilla);
  const std::string informed = programs::kind_name(programs::Kind::physics_informed);
  const std::optional<std::size_t> best_vanilla = programs::best_of(results, vanilla),
                                   best = programs::best_of(results, informed);
  Verdict verdict;
  nlohmann::json verdict_row;
  if (best) {
    verdict = verdict_on(results[*best].test.errors, regression_r_squared);
    verdict_row = {{"model", informed},
                   {"seed", results[*best].seed},
                   {"r2", verdict.test_r_squared},
                   {"worst_motor_r2", verdict.worst_motor_r_squared},
                   {"linear_regression_r2", verdict.linear_regression_r_squared},
                   {"worse_than_mean", verdict.worse_than_mean()},
                   {"beats_linear_regression", verdict.beats_linear_regression()},
                   {"exported", !verdict.worse_than_mean() || options.allow_poor}};
  }
  const std::string folder = options.out + "/";
  programs::write_results(folder + "results.csv", results);
  nlohmann::json settings = {{"version", PINNQUAD_VERSION},
                             {"airframe", airframe.airframe_name()},
                             {"epochs", options.epochs},
                             {"first_seed", options.seed},
                             {"seeds", options.seeds},
                             {"batch", 64},
                             {"learning_rate", Adam{}.learning_rate},
                             {"weight_decay", Adam{}.weight_decay},
                             {"lambda_max", CyclicalAnnealing{}.maximum},
                             {"cycles", CyclicalAnnealing{}.cycles},
                             {"hold", CyclicalAnnealing{}.hold},
                             {"step_gain", TanhStep{}.gain},
                             {"finished", trainings.size()}};
  settings.update(programs::described(dataset, split));
  programs::write_report(folder + "report.json", std::move(settings), results, verdict_row);

  programs::print_table(results, {linear_name, vanilla, informed});
  programs::print_paired(results, informed, vanilla);
  double seconds = 0;
  for (const programs::Result& result : results) seconds += result.training_s;
  if (!trainings.empty()) {
    std::printf("  training took %.2f s per network and core\n", seconds / static_cast<double>(trainings.size()));
  }
  if (!best) {
    const bool none = programs::over_seeds(results, informed, programs::figures().front()).empty();
    programs::complain("train", std::string(none ? "no physics-informed network was finished"
                                                 : "no physics-informed network predicts finite commands on the "
                                                   "validation rows") +
                                    "; nothing to export" + earlier_export(options));
    return programs::interrupted() ? programs::exit_interrupted : programs::exit_failed;
  }
  const bool exported = fit_for_export(options, verdict);
  if (exported) {
    std::printf("[4/5] export\n");
    Provenance from{programs::flight_names(dataset),
                    content_hash(dataset),
                    split.train.size(),
                    results[*best].seed,
                    options.epochs,
                    "MSE + local monotonicity (roll, pitch, yaw), cyclical annealing",
                    verdict};
    from.sample_period_s = sample_period_s(split.train);
    export_model(options, models[*best - 1], split, from);  // results[0] is the linearized model
  }
  // last: a picture that cannot be drawn costs nothing else
  std::vector<std::size_t> shown;
  if (best_vanilla) shown.push_back(*best_vanilla);
  shown.push_back(*best);
  draw(airframe, folder, split.test, results, predictions, shown, {linear_name, vanilla, informed});
  if (programs::interrupted()) {
    std::fprintf(stderr, "train: interrupted; %zu of %d trainings were finished and kept\n", trainings.size(),
                 2 * options.seeds);
    return programs::exit_interrupted;
  }
  return exported ? 0 : programs::exit_failed;
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

/// Trains on the flights of the options: the exit code.
int train_chosen(const Options& options) {
  if (!is_identifier(options.model_name)) {
    throw std::invalid_argument("--name " + options.model_name +
                                ": a C++ identifier was expected, no keyword and no name that C++ reserves");
  }
  std::optional<programs::NamedAirframe> given;
  if (programs::is_airframe_file(options.airframe)) {
    given = programs::read_airframe_file(options.airframe);
  } else if (!programs::with_airframe(options.airframe, [](auto) {})) {
    throw programs::no_airframe(options.airframe);
  }
  require_separate_files(options);
  const Dataset dataset = programs::read_flights(options.flights, minimum_rows);
  const programs::FolderLock folder(options.out);
  // what cannot be written is found before the training
  for (const char* name : output_names) AtomicFile probe(options.out + "/" + name);
  if (!options.block.empty()) AtomicFile probe(options.block);
  if (given) {
    return train_judge_export(options, ContextAirframe<GivenAirframe>(given->name, given->value), dataset);
  }
  int code = programs::exit_bad_input;
  programs::with_airframe(options.airframe, [&](auto tag) {
    code = train_judge_export(options, ContextAirframe<typename decltype(tag)::type>{}, dataset);
  });
  return code;
}

void add_options(CLI::App& app, Options& options) {
  using programs::add_number;
  using programs::add_path;
  app.footer(
      "Exit codes: 0; 1 nothing exported: no network was finished, or the best is worse than the mean of the "
      "commands;\n"
      "2 bad input or a file that can't be read or written; 130 interrupted, what is finished is kept.\n"
      "Without gnuplot the pictures are left out, with a line.");
  programs::add_paths(
      app, "--flight", options.flights, "FILE.csv",
      "recorded flight, CSV as `pinnquad fly` writes it: its first part trains, its last tests. Of three or more, "
      "whole flights, in this order: the first train, the last test")
      ->required();
  app.add_option("--airframe", options.airframe,
                 "what flew: a file FILE.toml (examples/airframes), or one of: " + programs::airframe_names())
      ->capture_default_str();
  add_path(app, "--out", options.out, "DIR", "folder for results, pictures and the exported header")
      ->default_str(options.out);
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
      "train", "Trains vanilla and physics-informed networks on flights, judges them, exports the best as a header");
  const auto options = std::make_shared<Options>();
  add_options(*line, *options);
  return {line, [options] { return train_chosen(*options); }};
}
