// SPDX-License-Identifier: MIT
// The program pinnquad-study: the paper's campaign (the 14 models of Table 2 on three flights, 20 seeds each, as rows
// for Table 3), the ablation, what goes beyond the paper, and controllers compared in the loop. report.py writes the
// report.
//   pinnquad-study paper --seeds 20 --out DIR
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "command_line/commands.hpp"
#include "command_line/console.hpp"
#include "command_line/interrupt.hpp"
#include "command_line/options.hpp"
#include "pinnquad/evaluation/paired_test.hpp"
#include "study/ablation.hpp"
#include "study/campaign.hpp"
#include "study/flights.hpp"
#include "study/summary.hpp"
#include "study/table.hpp"

namespace programs {  // <name>_command.cpp
Command beyond_command(CLI::App& program);
}
namespace study {
programs::Command loop_command(CLI::App& program);
programs::Command wrench_command(CLI::App& program);
}  // namespace study

namespace {

struct StudyOptions {
  std::string out;
  std::string models;
  std::string weights = "final";
  std::vector<std::string> variants;
  int seeds = study::paper_seeds;
  int epochs = study::paper_epochs;
  int flights = 4;
  std::uint64_t flight_seed = study::first_flight_seed;
  int patience = 0;
  unsigned threads = 0;
};

void add_campaign_options(CLI::App& app, StudyOptions& options) {
  using programs::add_number;
  add_number(app, "--seeds", options.seeds, 1, static_cast<int>(pinnquad::most_pairs),
             "trainings of each model, from seeds 1, 2, ...");
  add_number(app, "--epochs", options.epochs, 1, 100000, "epochs of each training");
  add_number(app, "--flight-seed", options.flight_seed, std::uint64_t{0}, programs::most_seed,
             "seed of the flights d1, d2, d3; further flights count on from it")
      ->type_name("N");
  app.add_option("--weights", options.weights,
                 "final: judge the weights after the last epoch; best: those of the least validation error")
      ->capture_default_str()
      ->check(CLI::IsMember({"final", "best"}));
  add_number(app, "--patience", options.patience, 0, 100000,
             "end a training after this many epochs without a lesser validation error; 0: never");
  add_number(app, "--threads", options.threads, 1u, 1024u, "trainings at once (default: all cores)")->default_str("");
}

int run_campaign(const StudyOptions& options, const char* kind, std::vector<study::Contender> contenders) {
  if (options.out.empty()) throw std::invalid_argument("--out DIR is needed");
  study::Plan plan;
  plan.kind = kind;
  plan.contenders = std::move(contenders);
  plan.seeds = options.seeds;
  plan.epochs = options.epochs;
  plan.flights = options.flights;
  plan.best_weights = options.weights == "best";
  plan.patience = options.patience;
  plan.flight_seed = options.flight_seed;
  study::Campaign campaign(plan, options.out,
                           options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency()));
  campaign.run();
  study::print_summary(plan, campaign.rows());
  if (plan.kind != "table 2") return 0;  // an ablation is no Table 3
  programs::keeping("all trainings are in " + options.out +
                        "/rows.csv, pictures of its flights are missing; the same "
                        "command goes on",
                    [&] { study::draw_flights(options.out, options.flight_seed); });
  std::printf("its report  pinnquad-study-report %s\n", options.out.c_str());
  return 0;
}

/// Options of a command that trains; `flights` is how many flights it takes.
std::shared_ptr<StudyOptions> training_options(CLI::App& line, int flights, const char* flights_are) {
  const auto options = std::make_shared<StudyOptions>();
  options->flights = flights;
  programs::add_path(line, "--out", options->out, "DIR", "folder of rows.csv, study.json and series/");
  programs::add_number(line, "--flights", options->flights, 1, 1000, flights_are);
  add_campaign_options(line, *options);
  return options;
}

programs::Command paper_command(CLI::App& program) {
  CLI::App* line =
      program.add_subcommand("paper", "The 14 models of Table 2; each finished training is a row of DIR/rows.csv");
  const auto options =
      training_options(*line, 4, "flights d1 of the main comparison (models 2, 3, 4), the seeds from --flight-seed on");
  line->add_option("--models", options->models, "models of Table 2, such as 2,4,5-8 (default: all 14)");
  line->footer(std::string("Examples:\n"
                           "  pinnquad-study paper --seeds 20 --out study\n"
                           "  pinnquad-study paper --models 2,4,5-8 --epochs 100 --out part\n"
                           "The same command goes on where it was stopped or killed.\n") +
               study::exit_codes);
  return {line, [options] { return run_campaign(*options, "table 2", study::chosen_models(options->models)); }};
}

programs::Command ablation_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand(
      "ablation",
      "What decides: gain, lambda, batch order, learning rate, loss forms, and the same budget for vanilla");
  const auto options = training_options(*line, 1, "flights d1, the seeds from --flight-seed on");
  line->add_option("--variants", options->variants, "some of the variants, by the names in rows.csv (default: all)")
      ->delimiter(',');
  line->footer(study::exit_codes);
  return {line, [options] { return run_campaign(*options, "ablation", study::chosen_variants(options->variants)); }};
}

int run(int argument_count, char** arguments, std::string& name) {
  CLI::App program("The paper's campaign: its models trained and judged, seed by seed", name);
  program.fallthrough();  // --config may stand anywhere
  const std::vector<programs::Command> commands = {paper_command(program), ablation_command(program),
                                                   programs::beyond_command(program), study::loop_command(program),
                                                   study::wrench_command(program)};
  program.footer(
      std::string("Examples:\n"
                  "  pinnquad-study paper --seeds 20 --out study       the study; then its report:\n"
                  "  pinnquad-study-report study\n"
                  "  pinnquad-study beyond --seeds 10 --out beyond     structured models beside its network\n"
                  "  pinnquad-study loop model.block --out compared    controllers beside each other\n"
                  "pinnquad-study COMMAND --help says more.\n") +
      study::exit_codes + " 70 is a fault of the program, to be reported.");
  if (const std::optional<int> code = programs::choose_command(program, argument_count, arguments, name)) return *code;
  return programs::run_chosen(commands);
}

}  // namespace

int main(int argument_count, char** arguments) {
  programs::catch_interrupt();
  std::string name = "pinnquad-study";
  return programs::run_program(name, [&] { return run(argument_count, arguments, name); });
}
