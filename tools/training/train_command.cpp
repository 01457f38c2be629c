// SPDX-License-Identifier: MIT
// Trains the linearized model's rivals on recorded flights, judges all on rows that none was trained on (the last part
// of one flight, or the last of several flights), exports the best of the kind that the recipe exports as a header.
// Flights of real vehicles (--dataset, --log) are judged by held-out flights instead: training/train_logs.hpp.
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
#include "command_line/interrupt.hpp"
#include "command_line/listed.hpp"
#include "command_line/options.hpp"
#include "pinnquad/data/csv.hpp"
#include "pinnquad/deploy/export_model.hpp"
#include "pinnquad/evaluation/judgement.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "training/certificate_words.hpp"
#include "training/export_choice.hpp"
#include "training/judge_all.hpp"
#include "training/judgement.hpp"
#include "training/log_options.hpp"
#include "training/model_figures.hpp"
#include "training/model_predictions.hpp"
#include "training/pictures.hpp"
#include "training/recipe.hpp"
#include "training/train_logs.hpp"
#include "training/training_flights.hpp"
#include "training/training_report.hpp"

namespace {

using namespace pinnquad;

/// Fewer rows than this can't train 6,379 weights to anything worth flying: 20 batches of 64 in the 60 % that train.
constexpr std::size_t minimum_rows = 2200;

struct TrainOptions {
  std::vector<std::string> flights;
  std::string airframe = PaperQuadrotor::name;
  std::string out = "demo_out";
  std::string model_name = "TrainedQuadModel";
  std::string recipe = programs::recipes.front()().name;
  std::vector<std::string> losses = {programs::vanilla.key, programs::physics_informed.key};
  std::string altitude = "auto";
  std::string slopes = "learned";
  int seeds = 5;
  int epochs = 300;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  bool allow_poor = false;            ///< export what is worse than the mean, marked as such
  programs::LogTrainingOptions logs;  ///< what --dataset and --log ask for besides
};

/// Warns of features that stand still in the training rows: they are exported, and flown only where they stood.
void warn_of_still_features(const std::vector<std::string>& still, programs::TrainingReport& report) {
  const std::string names = programs::listed(still);
  if (names.empty()) return;
  report.warn(names +
              ": nothing changes in the training rows; the model will not know what it does, and answers only near the "
              "value flown");
}

/// The pictures of the networks `shown` (indices of results), the best of each kind.
void draw(const GivenAirframe& airframe, const std::string& folder, const RowSet& test,
          const std::vector<programs::Result>& results, const std::vector<programs::Predictions>& predictions,
          const std::vector<std::size_t>& shown, const std::vector<std::string>& kinds) {
  std::vector<std::string> shown_names;
  std::vector<programs::EllipsesOf> ellipses;
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
    ellipses.push_back({shown_names.back(), programs::axis_series(airframe, test, predictions[shown[s]])});
    for (std::size_t i = 0; i < excerpt; ++i) command[s].push_back(predictions[shown[s]][i][0]);
  }
  programs::write_svg(folder + "ellipses.svg", programs::ellipses_chart(ellipses));
  programs::write_svg(folder + "errors.svg", programs::errors_chart(results, kinds));
  programs::write_svg(folder + "prediction.svg", programs::prediction_chart(time_s, target, shown_names, command));
  std::printf("  pictures: %sellipses.svg, errors.svg, prediction.svg\n", folder.c_str());
}

/// "; of an earlier training: ..." with the files an export would have replaced; nothing where there are none.
std::string earlier_export(const TrainOptions& options) {
  std::vector<std::string> there;
  for (const std::string& path : {options.out + "/model.hpp", options.out + "/trust.hpp", options.out + "/replay.txt",
                                  options.out + "/model.block"}) {
    std::error_code ignored;
    if (!path.empty() && std::filesystem::exists(path, ignored)) there.push_back(path);
  }
  return there.empty() ? "" : "; of an earlier training: " + programs::listed(there);
}

/// Says how the chosen model stands beside the mean and linear regression. Why it must not be exported; empty if it
/// may.
std::string reason_against_export(const TrainOptions& options, const programs::Chosen& chosen,
                                  programs::TrainingReport& report) {
  const Verdict& verdict = chosen.verdict;
  std::printf(
      "  %s on the test rows: R^2 %.4f, worst motor %.4f; linear regression on the paper's features: R^2 %.4f\n",
      chosen.name().c_str(), verdict.test_r_squared, verdict.worst_motor_r_squared,
      verdict.linear_regression_r_squared);
  std::fflush(stdout);
  if (verdict.worse_than_mean()) {
    if (!options.allow_poor) return chosen.poor();
    report.warn("NOT FOR FLIGHT: the " + chosen.name() + " is worse than the mean of the commands");
  } else if (!verdict.beats_linear_regression()) {
    report.warn("the " + chosen.name() + " does not beat linear regression on the paper's features (R^2 " +
                programs::four_digits(verdict.test_r_squared) + " against " +
                programs::four_digits(verdict.linear_regression_r_squared) +
                "): a linear map of them would fly as well");
  }
  if (verdict.has_poor_motor()) {
    report.warn("one motor's commands are predicted worse than by their mean (R^2 " +
                programs::four_digits(verdict.worst_motor_r_squared) + " on the test rows)");
  }
  return {};
}

/// Advice where the best model is worse than the mean.
std::string instead_of_poor(const TrainOptions& options, const programs::LossName& loss) {
  if (!programs::is_structured(loss)) return "more epochs or a better flight, or --allow-poor";
  const std::string learned = options.slopes == "pinned" ? "--slopes learned, " : "";
  return learned + "a better flight, --allow-poor, or --recipe paper, of whose networks nothing is proven";
}

/// A model that is proven may err more than the network that is not.
void warn_of_better_network(const std::vector<programs::LossName>& losses, const std::vector<programs::Result>& results,
                            const programs::Chosen& chosen, programs::TrainingReport& report) {
  const programs::LossName network = programs::exported_network(losses);
  const std::optional<std::size_t> other = programs::best_of(results, network.title);
  const double error = results[*chosen.best].validation_error;
  if (!programs::is_structured(chosen.loss) || !other || !(results[*other].validation_error < error)) return;
  report.warn("the best " + programs::with_kind(network) + " errs less on the validation rows (" +
              programs::four_digits(results[*other].validation_error) + " against " + programs::four_digits(error) +
              "), but nothing is proven of its signs; --recipe paper exports it");
}

/// Proof of an export's signs, as `certify` finds it in the header.
void say_certificate(const TrainOptions& options, const programs::TrainedNetwork& network,
                     const GivenAirframe& airframe, programs::TrainingReport& report) {
  const std::optional<Certificate> certificate = network.certificate();
  if (!certificate || !certificate->proven()) {
    std::printf("  nothing is proven of its signs: `pinnquad certify %s/model.hpp` looks for a counterexample\n",
                options.out.c_str());
    return;
  }
  const AxisSlopes slopes = programs::held_slopes(*certificate), own = hover_slopes(airframe.airframe<double>());
  const double own_thrust = hover_thrust_slope(airframe.airframe<double>());
  report.certified(*certificate, own, own_thrust);
  std::printf(
      "  proven: each signed sum of the commands rises with the angular acceleration about its axis, for every "
      "input;\n"
      "    slopes roll %.6f, pitch %.6f, yaw %.6f s^2/rad: %.2f, %.2f, %.2f of the airframe's own in hover;\n"
      "    thrust slope %.6f s^2/m: %.2f of the airframe's own in hover;\n"
      "    %s\n",
      slopes[0], slopes[1], slopes[2], slopes[0] / own[0], slopes[1] / own[1], slopes[2] / own[2],
      certificate->held_thrust_slope, certificate->held_thrust_slope / own_thrust,
      programs::bound_in_words(*certificate).c_str());
  std::fflush(stdout);
  for (const std::string& doubt : programs::slope_doubts(slopes, own)) report.warn(doubt);
  if (const auto doubt = programs::thrust_doubt(*certificate, own_thrust)) report.warn(*doubt);
}

/// Limits of trust are those of the structured model; of an earlier training none stay.
void export_network(const TrainOptions& options, const programs::Training& training, const RowSplit& split,
                    const Provenance& provenance) {
  const programs::TrainedNetwork& network = *training.network;
  const std::string header = options.out + "/model.hpp", trust = options.out + "/trust.hpp";
  const bool trusted = programs::is_structured(training.loss);
  const Exported exported = network.export_to({header, options.out + "/model.block", trusted ? trust : ""},
                                              options.model_name, split, provenance);
  std::error_code ignored;
  if (!trusted) std::filesystem::remove(trust, ignored);
  network.write_replay(options.out + "/replay.txt", split.test);
  std::printf("  %s: struct %s, %s of seed %llu (least error on the validation rows)%s\n", header.c_str(),
              options.model_name.c_str(), training.loss.title, static_cast<unsigned long long>(provenance.seed),
              provenance.verdict->worse_than_mean() ? "; NOT FOR FLIGHT, and its header says so" : "");
  if (!exported.no_trust_because.empty()) {
    std::printf("  no limits of distance and command residual (trust.hpp): %s\n", exported.no_trust_because.c_str());
  } else if (trusted) {
    std::printf("  %s: struct %sTrust, when it is not to be trusted: limits of distance and command residual\n",
                trust.c_str(), options.model_name.c_str());
  }
  std::printf("  %s: the same weights as a block of %zu bytes\n", (options.out + "/model.block").c_str(),
              exported.block_bytes);
}

/// Per kind, on one core.
void print_training_time(const std::vector<programs::LossName>& losses, const std::vector<programs::Result>& results) {
  std::string kinds;
  for (const programs::LossName& loss : losses) {
    double seconds = 0, count = 0;
    for (const programs::Result& result : results) {
      if (result.model != loss.title) continue;
      seconds += result.training_s;
      ++count;
    }
    char text[96];
    std::snprintf(text, sizeof text, "%s %.2f s", loss.title, seconds / count);
    if (count > 0) programs::add_to_list(kinds, text);
  }
  if (!kinds.empty()) std::printf("  training took, per model and core: %s\n", kinds.c_str());
}

int train_judge_export(const TrainOptions& options, const programs::Recipe& recipe,
                       const std::vector<programs::LossName>& losses, const programs::NamedAirframe& given,
                       const Dataset& dataset, const RowSplit& split) {
  programs::TrainingPlan plan{
      {given.name, given.value},
      !programs::is_airframe_file(options.airframe),
      split,
      losses,
      options.epochs,
      options.seed,
      options.seeds,
      options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency())};
  plan.altitude = options.altitude == "yes"  ? programs::AltitudeRule::yes
                  : options.altitude == "no" ? programs::AltitudeRule::no
                                             : programs::AltitudeRule::by_validation;
  plan.pinned_slopes = options.slopes == "pinned";
  programs::TrainingReport report(options.out + "/report.json", recipe, plan, dataset);
  warn_of_still_features(recipe.still_features(plan), report);
  programs::print_split(dataset, split);
  std::printf("      network %s; %s, batch %d, %d epochs, %d seeds\n", recipe.network.c_str(), recipe.optimizer.c_str(),
              recipe.settings.at("batch").get<int>(), options.epochs, options.seeds);
  if (!recipe.besides_in_words.empty()) std::printf("      %s\n", recipe.besides_in_words.c_str());
  std::fflush(stdout);

  const std::vector<programs::Training> trainings = recipe.train(plan);
  const std::string kept = std::to_string(trainings.size()) + " of " +
                           std::to_string(plan.losses.size() * static_cast<std::size_t>(options.seeds)) +
                           " trainings were finished and kept";

  std::printf("[3/5] judge\n");
  std::fflush(stdout);
  std::vector<programs::Predictions> predictions;
  const std::vector<programs::Result> results = programs::judge_all(plan, trainings, predictions);
  const double regression_r_squared = linear_regression_errors<PaperFeatures>(split.train, split.test).mean.r_squared;

  const std::string folder = options.out + "/";
  report.judged(results, trainings.size());
  for (const programs::Training& training : trainings) {
    if (!training.altitude.is_null()) report.altitude(training.altitude);  // the same of all
  }
  programs::write_results(folder + "results.csv", results);

  std::vector<std::string> kinds = {programs::linear_name};
  for (const programs::LossName& loss : plan.losses) kinds.push_back(loss.title);
  programs::print_table(results, kinds);
  programs::print_signs(results, kinds);
  for (const programs::LossName& loss : plan.losses) {
    const programs::LossName* baseline = programs::compared_with(plan.losses, loss);
    if (baseline != nullptr) programs::print_paired(results, loss.title, baseline->title);
  }
  print_training_time(plan.losses, results);
  const programs::Chosen chosen = programs::chosen_export(plan.losses, results, regression_r_squared);
  const std::optional<std::size_t> best = chosen.best;
  if (best) report.best(results[*best], chosen.verdict, !chosen.verdict.worse_than_mean() || options.allow_poor);
  if (!best) {
    const std::string reason = programs::reason_of_none(chosen.loss, results);
    report.write_not_exported(reason);
    if (programs::interrupted()) throw programs::Interrupted{kept};
    programs::complain("train", reason + "; nothing to export" + earlier_export(options));
    return programs::exit_failed;
  }
  const std::string reason = reason_against_export(options, chosen, report);
  // before the export: a disk that is full then costs the export alone
  report.write_not_exported(reason.empty() ? "the export was not finished" : reason);
  if (reason.empty()) {
    std::printf("[4/5] export\n");
    warn_of_better_network(plan.losses, results, chosen, report);
    const Provenance from =
        provenance_of(dataset, split, results[*best].seed, options.epochs, chosen.loss.words, chosen.verdict);
    const programs::Training& exported = trainings[*best - 1];  // results[0] is the linearized model
    export_network(options, exported, split, from);
    say_certificate(options, *exported.network, plan.airframe, report);
    report.write_exported(folder + "model.hpp", folder + "model.block");
  } else {
    programs::complain(
        "train", "not exported: " + reason + "; " + instead_of_poor(options, chosen.loss) + earlier_export(options));
  }
  // last: a picture that cannot be drawn costs nothing else
  std::vector<std::size_t> shown;
  for (const programs::LossName& loss : plan.losses) {
    const std::optional<std::size_t> best_of_loss = programs::best_of(results, loss.title);
    if (best_of_loss) shown.push_back(*best_of_loss);
  }
  programs::keeping(kept, [&] {
    draw(plan.airframe, folder, split.test, results, predictions, shown, kinds);
    programs::stop_if_interrupted();
  });
  return reason.empty() ? 0 : programs::exit_failed;
}

/// The files of --out.
constexpr std::array<const char*, 9> output_names = {"results.csv", "report.json",    "ellipses.svg",
                                                     "errors.svg",  "prediction.svg", "model.hpp",
                                                     "model.block", "trust.hpp",      "replay.txt"};

/// No output takes the place of a flight or of another output.
void require_separate_files(const TrainOptions& options) {
  programs::FileRoles roles;
  for (const std::string& path : options.flights) roles.reads("--flight", path);
  if (programs::is_airframe_file(options.airframe)) roles.reads("--airframe", options.airframe);
  roles.writes("--out", options.out);
  for (const char* name : output_names) roles.writes("--out", options.out + "/" + name);
}

/// Options common to logs and flights; `given(name)`: the option is in the command line.
template <class Given>
programs::LogTrainingOptions log_options(const TrainOptions& options, const Given& given) {
  programs::LogTrainingOptions logs = options.logs;
  logs.airframe = given("--airframe") ? options.airframe : "";
  logs.out = options.out;
  logs.model_name = options.model_name;
  logs.seeds = options.seeds;
  logs.epochs = given("--epochs") ? options.epochs : 0;
  logs.seed = options.seed;
  logs.threads = options.threads;
  logs.allow_poor = options.allow_poor;
  return logs;
}

/// Trains on the flights of the options: the exit code.
int train_chosen(const TrainOptions& options) {
  if (!is_identifier(options.model_name)) {
    throw std::invalid_argument("--name " + options.model_name +
                                ": a C++ identifier was expected, no keyword and no name that C++ reserves");
  }
  const programs::Recipe recipe = programs::chosen_recipe(options.recipe);
  if (recipe.besides.empty() &&
      (options.altitude != TrainOptions{}.altitude || options.slopes != TrainOptions{}.slopes)) {
    throw std::invalid_argument("--altitude and --slopes go with --recipe structured, not with " + options.recipe);
  }
  std::vector<programs::LossName> losses = programs::chosen_losses(options.losses);
  losses.insert(losses.end(), recipe.besides.begin(), recipe.besides.end());
  const programs::NamedAirframe airframe = programs::chosen_airframe(options.airframe);
  require_separate_files(options);
  const Dataset dataset = programs::read_flights(options.flights, minimum_rows);
  const RowSplit split = split_for_training(dataset);
  programs::require_varied_commands(options.flights, dataset, split.train, "training");
  programs::require_varied_commands(options.flights, dataset, split.validation, "validation");
  programs::require_varied_commands(options.flights, dataset, split.test, "test");
  const programs::FolderLock folder(options.out);
  // what cannot be written is found before the training
  for (const char* name : output_names) AtomicFile probe(options.out + "/" + name);
  return train_judge_export(options, recipe, losses, airframe, dataset, split);
}

void add_options(CLI::App& app, TrainOptions& options) {
  using programs::add_number;
  using programs::add_path;
  app.footer(
      "Examples:\n"
      "  pinnquad train --flight d1.csv --out my_model\n"
      "  pinnquad train --flight a.csv --flight b.csv --flight c.csv --airframe mine.toml --recipe best\n"
      "  pinnquad train --flight d1.csv --recipe small --out small\n"
      "  pinnquad train --log logs --mapping px4 --hold-out flight7 --out my_model\n"
      "  pinnquad train --dataset my_logs --hold-out-each trajectory --out my_model\n"
      "Exit codes: 0; 1 nothing exported: no model was finished, or the best is worse than the mean of the commands;\n"
      "2 bad input or a file that can't be read or written; 130 interrupted, what is finished is kept.");
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
  app.add_option("--loss", options.losses,
                 "what the networks are trained under, any of: " + losses +
                     ". The recipe structured trains its model too, whatever is asked for, and exports it; the others "
                     "export physics_informed or, where it is not asked for, the first of this list")
      ->delimiter(',')
      ->type_name("NAME,...")
      ->default_str("vanilla,physics_informed");
  app.add_option(
         "--altitude", options.altitude,
         "is the model of the recipe structured shown the altitude above ground? auto: if that lowers its error on "
         "the validation rows by a fifth, as it does near the ground. A model that is shown it must be given it in "
         "flight")
      ->check(CLI::IsMember({"auto", "yes", "no"}))
      ->type_name("auto|yes|no")
      ->capture_default_str();
  app.add_option(
         "--slopes", options.slopes,
         "how much the command sums of the recipe structured's model rise with the angular acceleration: learned "
         "of the flights, or pinned to the airframe's in hover, where quiet flights, rotor lag or latency hide them; "
         "the noise of an angular acceleration then goes into the commands")
      ->check(CLI::IsMember({"learned", "pinned"}))
      ->type_name("learned|pinned")
      ->capture_default_str();
  app.add_option("--name", options.model_name, "name of the exported struct")->capture_default_str();
  add_number(app, "--seeds", options.seeds, 1, static_cast<int>(most_pairs), "models per kind");
  add_number(app, "--epochs", options.epochs, 1, 100000, "training epochs");
  add_number(app, "--seed", options.seed, std::uint64_t{0}, programs::most_seed,
             "first seed (initialisation and batch order)")
      ->type_name("N");
  add_number(app, "--threads", options.threads, 1u, 1024u, "trainings at once (default: all cores)")->default_str("");
  app.add_flag("--allow-poor", options.allow_poor,
               "export the best model even if it is worse than the mean of the commands; its header says so");
}

}  // namespace

programs::Command programs::train_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand(
      "train", "Trains models on flights, judges them on rows that none was trained on, exports the best as a header");
  const auto options = std::make_shared<TrainOptions>();
  add_options(*line, *options);
  add_log_options(*line, options->logs);
  return {line, [options, line] {
            require_one_source(*line);
            if (!options->flights.empty()) return train_chosen(*options);
            return train_on_logs(log_options(*options, [line](const char* name) { return line->count(name) > 0; }));
          }};
}
