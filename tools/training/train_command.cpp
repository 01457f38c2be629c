// SPDX-License-Identifier: MIT
// The options of `train`, and which of them do not go together.
//   pinnquad train flight.csv --airframe paper_quadrotor --seeds 5 --epochs 300 --out DIR
//   pinnquad train DIR --hold-out-each trajectory --seeds 5 --out OUT
//   pinnquad train DIR --hold-out flight7 --out OUT
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "airframe/choice.hpp"
#include "command_line/command.hpp"
#include "command_line/listed.hpp"
#include "command_line/options.hpp"
#include "pinnquad/evaluation/paired_test.hpp"
#include "training/train_input.hpp"
#include "training/train_run.hpp"

namespace {

using programs::TrainOptions;

/// As they stand in the command line.
struct GivenWords {
  std::string airframe = pinnquad::PaperQuadrotor::name;
  std::string altitude = "auto", slopes = "learned", lag = "auto";
};

void add_flights(CLI::App& app, TrainOptions& options) {
  programs::add_sources(app, options.flights, options.mapping);
  app.add_option("--hold-out", options.hold_out, "flights or trajectories kept for testing, all together")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME,...");
  app.add_option("--hold-out-each", options.hold_out_each, "each in turn; then the export is fitted to all")
      ->check(CLI::IsMember({"flight", "trajectory"}))
      ->type_name("flight|trajectory");
  app.add_option("--validate", options.validate, "flights or trajectories that choose what is exported (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME,...");
}

void add_kinds(CLI::App& app, TrainOptions& options, GivenWords& words) {
  const std::vector<programs::ModelKind> for_logs = programs::log_model_kinds();
  app.add_option("--models", options.models,
                 "compare these: paper_, best_ or small_ before vanilla, physics_informed, constant_weight or pearson "
                 "are networks; formula; " +
                     programs::listed(for_logs, [](const auto& kind) { return kind.key; }) +
                     " (flights: " + programs::listed(programs::flight_models) + "; logs: the last " +
                     std::to_string(for_logs.size()) + ")")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME,...");
  app.add_option("--export", options.export_choice, "best model of measured motion, of planned motion, or a name")
      ->type_name("causal|centred|NAME");
  app.add_option("--altitude", words.altitude, "input of the structured model (auto: if the error falls by 20 %)")
      ->check(CLI::IsMember({"auto", "yes", "no"}))
      ->type_name("auto|yes|no")
      ->capture_default_str();
  app.add_option("--slopes", words.slopes, "of commands over angular acceleration: flights', or airframe's")
      ->check(CLI::IsMember({"learned", "pinned"}))
      ->type_name("learned|pinned")
      ->capture_default_str();
}

void add_options(CLI::App& app, TrainOptions& options, GivenWords& words) {
  using programs::add_number, programs::add_path;
  app.footer(
      "Examples:\n"
      "  pinnquad train logs --hold-out flight7 --out my_model\n"
      "More: docs/train.md, docs/log_training.md.\n"
      "Exit codes: 0; 1 nothing exported; 2 bad input; 130 interrupted: the same command resumes.");
  add_flights(app, options);
  app.add_option("--airframe", words.airframe, "what flew: see airframe list")
      ->type_name("NAME|FILE.toml")
      ->capture_default_str();
  app.add_option("--lag", words.lag, "from command to motion, to remove from the commands")
      ->type_name("auto|SECONDS")
      ->capture_default_str();
  programs::add_time_range(app, options);
  add_path(app, "--out", options.out, "DIR", "folder for results, report and the exported header")
      ->default_str(options.out);
  add_kinds(app, options, words);
  app.add_option("--name", options.model_name, "name of the exported struct")->capture_default_str();
  add_number(app, "--seeds", options.seeds, 1, static_cast<int>(pinnquad::most_pairs), "models per kind");
  add_number(app, "--epochs", options.epochs, 1, 100000, "training epochs (flights: 300; logs: what suits)")
      ->default_str("");
  add_number(app, "--seed", options.seed, std::uint64_t{0}, programs::most_seed,
             "first seed (initialisation and batch order)")
      ->type_name("N");
  add_number(app, "--threads", options.threads, 1u, 1024u, "trainings at once (default: all cores)")->default_str("");
  app.add_flag("--verbose", options.verbose, "statistical tests, slopes, settings and times beside the verdict");
  app.add_flag("--allow-poor", options.allow_poor,
               "export a model worse than the mean command too; its header says so");
}

/// Throws std::invalid_argument, one line, for options that do not go together.
void require_one_way(const CLI::App& line, const TrainOptions& options) {
  const auto given = [&line](const char* name) { return line.count(name) > 0; };
  const auto refuse = [](const std::string& what) { throw std::invalid_argument(what); };
  if (given("--lag") && !options.dataset.empty()) refuse("--lag: a dataset was imported with one");
  if (given("--hold-out") && given("--hold-out-each")) refuse("--hold-out and --hold-out-each can't be given together");
}

}  // namespace

namespace programs {

Command train_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand(
      "train", "Trains models on flights, judges them on rows held out, exports the best as a header");
  struct Asked {
    TrainOptions options;
    GivenWords words;
  };
  const auto asked = std::make_shared<Asked>();
  add_options(*line, asked->options, asked->words);
  return {line, [asked, line] {
            TrainOptions& options = asked->options;
            const GivenWords& words = asked->words;
            options.lag_s = programs::lag_of(words.lag);
            programs::take_source(options);
            programs::require_time_range(options, !options.logs.empty());
            require_one_way(*line, options);
            const auto given = [line](const char* name) { return line->count(name) > 0; };
            if (words.altitude != "auto") options.altitude = words.altitude == "yes";
            options.pinned_slopes = words.slopes == "pinned";
            if (given("--airframe")) options.airframe = words.airframe;
            return train(options);
          }};
}

}  // namespace programs
