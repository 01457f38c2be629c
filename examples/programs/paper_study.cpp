// SPDX-License-Identifier: MIT
// The paper's campaign: the 14 models of Table 2 on three flights, 20 seeds each, as rows for Table 3.
//   paper_study --seeds 20 --out DIR
//   paper_study merge DIR... --out DIR
//   paper_study report DIR
//   paper_study ablation --out DIR
#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "pinnquad/evaluation/paired_test.hpp"
#include "study_ablation.hpp"
#include "study_campaign.hpp"
#include "study_merge.hpp"
#include "study_pictures.hpp"
#include "study_report.hpp"
#include "study_summary.hpp"
#include "study_table.hpp"

namespace {

constexpr int exit_bad_input = 2;

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
  app.add_option("--seeds", options.seeds, "trainings of each model, from seeds 1, 2, ...")
      ->capture_default_str()
      ->check(CLI::Range(1, static_cast<int>(pinnquad::most_pairs)));
  app.add_option("--epochs", options.epochs, "epochs of each training")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  app.add_option("--flight-seed", options.flight_seed,
                 "seed of the flights d1, d2, d3; further flights count on from it")
      ->capture_default_str();
  app.add_option("--weights", options.weights,
                 "final: judge the weights after the last epoch; best: those of the least validation error")
      ->capture_default_str()
      ->check(CLI::IsMember({"final", "best"}));
  app.add_option("--patience", options.patience,
                 "end a training after this many epochs without a lesser validation error; 0: never")
      ->capture_default_str()
      ->check(CLI::Range(0, 100000));
  app.add_option("--threads", options.threads, "trainings at once (default: all cores)")->check(CLI::Range(1u, 1024u));
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
    study::draw_flights(options.out, options.flight_seed);
    write_report(options.out);
  }
  return code;
}

}  // namespace

int main(int argument_count, char** arguments) {
  Options options;
  CLI::App app{
      "Trains and judges the 14 models of the paper's Table 2; each finished training is a row of DIR/rows.csv.\n"
      "  paper_study --seeds 20 --out study\n"
      "  paper_study --models 2,4,5-8 --epochs 100 --out part\n"
      "  paper_study --shard 2/8 --out study/2        part 2 of 8, for a job array\n"
      "  paper_study merge study/* --out study/all    joins such parts\n"
      "The same command goes on where it was stopped or killed. Exit codes: 0; 1 a merge of parts that are not all "
      "there;\n"
      "2 bad input or a file that can't be read or written; 130 interrupted.",
      "paper_study"};
  app.add_option("--out", options.out, "folder of rows.csv, study.json and series/")->type_name("DIR");
  app.add_option("--models", options.models, "models of Table 2, such as 2,4,5-8 (default: all 14)");
  app.add_option("--flights", options.flights,
                 "flights d1 of the main comparison (models 2, 3, 4), the seeds from --flight-seed on")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  add_campaign_options(app, options);
  CLI::App* merge = app.add_subcommand("merge", "Joins the folders of a study's shards into one");
  merge->add_option("parts", options.parts, "folders to join")->type_name("DIR...")->required();
  merge->add_option("--out", options.out, "folder to write")->type_name("DIR")->required();
  CLI::App* report = app.add_subcommand("report", "Writes DIR/report.html, table3.csv, comparisons.csv and claims.csv");
  report->add_option("dir", options.out, "folder of a study")->type_name("DIR")->required();
  CLI::App* ablation = app.add_subcommand(
      "ablation",
      "What decides: gain, lambda, batch order, learning rate, loss forms, and the same budget for vanilla");
  ablation->add_option("--out", options.out, "folder of rows.csv, study.json and series/")
      ->type_name("DIR")
      ->required();
  int ablation_flights = 1;
  ablation->add_option("--flights", ablation_flights, "flights d1, the seeds from --flight-seed on")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  ablation->add_option("--variants", options.variants, "some of the variants, by the names in rows.csv (default: all)")
      ->delimiter(',');
  add_campaign_options(*ablation, options);
  try {
    app.parse(argument_count, arguments);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    std::fprintf(stderr, "paper_study: %s\n", error.what());
    return exit_bad_input;
  }
  try {
    if (options.out.empty()) throw std::invalid_argument("--out DIR is needed (see --help)");
    if (merge->parsed()) return study::merge(options.parts, options.out);
    if (report->parsed()) {
      write_report(options.out);
      return 0;
    }
    if (!ablation->parsed()) return run_campaign(options, "table 2", study::chosen_models(options.models));
    options.flights = ablation_flights;
    return run_campaign(options, "ablation", study::chosen_variants(options.variants));
  } catch (const std::exception& error) {  // InputError, OutputError, contradictions: one line
    std::fprintf(stderr, "paper_study: %s\n", error.what());
    return exit_bad_input;
  }
}
