// SPDX-License-Identifier: MIT
// The paper's campaign: the 14 models of Table 2 on three flights, 20 seeds each, as rows for Table 3.
//   paper_study --seeds 20 --out DIR
//   paper_study merge DIR... --out DIR
//   paper_study report DIR
//   paper_study ablation --out DIR
#include <cstdint>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "command_line/console.hpp"
#include "command_line/options.hpp"
#include "pinnquad/evaluation/paired_test.hpp"
#include "report/report.hpp"
#include "study/ablation.hpp"
#include "study/campaign.hpp"
#include "study/merge.hpp"
#include "study/pictures.hpp"
#include "study/summary.hpp"
#include "study/table.hpp"

namespace {

struct Options {
  std::string out;
  std::string models;
  std::string shard = "1/1";
  std::string weights = "final";
  std::vector<std::string> parts;
  std::vector<std::string> variants;
  int seeds = 20;
  int epochs = 300;
  int flights = 4;
  std::uint64_t flight_seed = study::first_flight_seed;
  int patience = 0;
  unsigned threads = 0;
};

void add_campaign_options(CLI::App& app, Options& options) {
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
  app.add_option("--shard", options.shard, "run part i of n only, for job arrays (docs/study.md)")
      ->type_name("i/n")
      ->capture_default_str();
}

void write_report(const std::string& folder) {
  programs::write_study_report(folder);
  std::printf("report      %s/report.html\n", folder.c_str());
}

int run_campaign(const Options& options, const char* kind, std::vector<study::Contender> contenders) {
  study::Plan plan;
  plan.kind = kind;
  plan.contenders = std::move(contenders);
  plan.seeds = options.seeds;
  plan.epochs = options.epochs;
  plan.flights = options.flights;
  plan.best_weights = options.weights == "best";
  plan.patience = options.patience;
  plan.flight_seed = options.flight_seed;
  plan.shard = study::parse_shard(options.shard);
  programs::catch_interrupt();
  study::Campaign campaign(plan, options.out,
                           options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency()));
  const int code = campaign.run();
  if (code == 0) study::print_summary(plan, campaign.rows());
  // a shard's rows are for merge; an ablation is no Table 3
  if (code == 0 && plan.kind == "table 2" && options.shard == "1/1") {
    if (!study::draw_flights(options.out, options.flight_seed) && programs::interrupted()) {
      programs::complain("paper_study", "interrupted; all trainings are in " + options.out +
                                            "/rows.csv, the report is missing; the same command goes on");
      return programs::exit_interrupted;
    }
    write_report(options.out);
  }
  return code;
}

/// A command takes its options behind its name; one before it would decide nothing.
void require_nothing_before(const CLI::App& app, const CLI::App& command) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() == 0) continue;
    throw std::invalid_argument(option->get_name() + " stands before " + command.get_name() +
                                ", which takes its options behind it (see --help)");
  }
}

int run(int argument_count, char** arguments) {
  using programs::add_number;
  using programs::add_path;
  Options options;
  CLI::App app{
      "Trains and judges the 14 models of the paper's Table 2; each finished training is a row of DIR/rows.csv.\n"
      "  paper_study --seeds 20 --out study\n"
      "  paper_study --models 2,4,5-8 --epochs 100 --out part\n"
      "  paper_study --shard 2/8 --out study/2        part 2 of 8, for a job array\n"
      "  paper_study merge study/* --out study/all    joins such parts\n"
      "The same command goes on where it was stopped or killed.",
      "paper_study"};
  app.footer(
      "Exit codes: 0; 1 a merge of parts that are not all there; 2 bad input or a file that can't be read or written; "
      "130 interrupted.\nWithout gnuplot the pictures are left out, with a line.");
  add_path(app, "--out", options.out, "DIR", "folder of rows.csv, study.json and series/");
  app.add_option("--models", options.models, "models of Table 2, such as 2,4,5-8 (default: all 14)");
  add_number(app, "--flights", options.flights, 1, 1000,
             "flights d1 of the main comparison (models 2, 3, 4), the seeds from --flight-seed on");
  add_campaign_options(app, options);
  CLI::App* merge = app.add_subcommand("merge", "Joins the folders of a study's shards into one");
  merge->add_option("parts", options.parts, "folders to join")->type_name("DIR...")->required();
  add_path(*merge, "--out", options.out, "DIR", "folder to write")->required();
  CLI::App* report = app.add_subcommand("report", "Writes DIR/report.html, table3.csv, comparisons.csv and claims.csv");
  add_path(*report, "dir", options.out, "DIR", "folder of a study")->required();
  CLI::App* ablation = app.add_subcommand(
      "ablation",
      "What decides: gain, lambda, batch order, learning rate, loss forms, and the same budget for vanilla");
  add_path(*ablation, "--out", options.out, "DIR", "folder of rows.csv, study.json and series/")->required();
  int ablation_flights = 1;
  add_number(*ablation, "--flights", ablation_flights, 1, 1000, "flights d1, the seeds from --flight-seed on");
  ablation->add_option("--variants", options.variants, "some of the variants, by the names in rows.csv (default: all)")
      ->delimiter(',');
  add_campaign_options(*ablation, options);
  if (const std::optional<int> code = programs::parse_command_line(app, argument_count, arguments)) return *code;
  for (const CLI::App* command : app.get_subcommands()) require_nothing_before(app, *command);
  if (options.out.empty()) throw std::invalid_argument("--out DIR is needed (see --help)");
  if (merge->parsed()) return study::merge(options.parts, options.out);
  if (report->parsed()) {
    write_report(options.out);
    return 0;
  }
  if (!ablation->parsed()) return run_campaign(options, "table 2", study::chosen_models(options.models));
  options.flights = ablation_flights;
  return run_campaign(options, "ablation", study::chosen_variants(options.variants));
}

}  // namespace

int main(int argument_count, char** arguments) {
  return programs::run_program("paper_study", [&] { return run(argument_count, arguments); });
}
