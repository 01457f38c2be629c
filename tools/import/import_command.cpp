// SPDX-License-Identifier: MIT
// Makes one dataset of flight logs, and says what each step cost.
//   pinnquad import flight.ulg --airframe mine.toml --out dataset
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_line/command.hpp"
#include "command_line/in_columns.hpp"
#include "command_line/in_words.hpp"
#include "command_line/like_warnings.hpp"
#include "command_line/options.hpp"
#include "command_line/progress_line.hpp"
#include "pinnquad/logs/dataset_folder.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace {

namespace logs = pinnquad::logs;

struct ImportOptions {
  std::vector<std::string> logs;
  logs::LogSettings settings;
  std::string out;
  std::string lag = "auto";
  bool json = false;
  bool list = false;
};

void list_mappings() {
  for (const logs::ReadyMapping& ready : logs::ready_mappings()) {
    std::printf("%-14s %s\n", ready.name.c_str(), ready.about.c_str());
  }
}

/// As much of `text` as fits on one line of at most `width` letters.
std::string shortened(const std::string& text, std::size_t width) {
  return text.size() <= width ? text : text.substr(0, width - 3) + "...";
}

void print_steps(const logs::ImportedDataset& dataset) {
  std::printf("%-34s %10s %10s %8s\n", "step", "rows", "left", "cost");
  for (const logs::ImportStep& step : dataset.steps) {
    const double cost =
        step.rows_before > step.rows_after && step.rows_before > 0
            ? 100.0 * static_cast<double>(step.rows_before - step.rows_after) / static_cast<double>(step.rows_before)
            : 0.0;
    const std::string line = programs::in_words("%-34s %10zu %10zu %7.2f%%", shortened(step.name, 34).c_str(),
                                                step.rows_before, step.rows_after, cost);
    programs::print_message(line + (step.told.empty() ? "" : "  " + step.told));
  }
}

void print_text(const logs::ImportedDataset& dataset, const std::string& out) {
  for (const std::string& taken : dataset.taken) programs::print_message(taken);
  print_steps(dataset);
  for (const std::string& note : dataset.notes) programs::print_message(note);
  if (!dataset.curve.told.empty()) programs::print_message(dataset.curve.told);
  for (const pinnquad::Flight& flight : dataset.flights.flights()) {
    std::printf("%-34s %10zu rows, %.1f s, trajectory %s\n", flight.name.c_str(), flight.size(),
                flight.back().time_s - flight.front().time_s, flight.trajectory.c_str());
  }
  for (const std::string& missing : dataset.absent)
    std::printf("absent: %s (the logs lack it; filled with 0)\n", missing.c_str());
  for (const std::string& warning : programs::collapsed(dataset.warnings, "--json prints all")) {
    programs::print_message("warning: " + warning);
  }
  programs::print_message(
      programs::in_words("%zu rows of %zu flights, every %g s, lag of %g s removed: ", dataset.flights.rows(),
                         dataset.flights.size(), dataset.sample_period_s, dataset.lag_removed_s) +
      out);
}

int run(const ImportOptions& options) {
  if (options.list) {
    list_mappings();
    return 0;
  }
  if (options.logs.empty())
    throw std::invalid_argument(
        "expected a log, a .ulg, .bbl or .bin file, a .csv table, a folder of them: pinnquad import flight.ulg --out "
        "dataset");
  if (options.out.empty())
    throw std::invalid_argument("expected --out DATASET, the folder to write: pinnquad import ... --out dataset");
  programs::require_time_range(options.settings, true);
#ifdef __GLIBC__
  constexpr const char* callers = "MALLOC_MMAP_THRESHOLD_";
  constexpr int always = 1 << 28;  // columns come and go: their memory is kept, not given back and asked for anew
  if (std::getenv(callers) == nullptr) {
    mallopt(M_MMAP_THRESHOLD, always);
    mallopt(M_TRIM_THRESHOLD, always);
  }
#endif
  logs::LogSettings settings = options.settings;
  settings.lag_s = programs::lag_of(options.lag);
  logs::require_dataset_place(options.out);
  programs::JobLine progress;
  settings.on_progress = [&progress](const std::string& job, double share) { progress.update(job, share); };
  const logs::ImportedDataset dataset = logs::read_dataset(options.logs, settings);
  logs::write_dataset_folder(options.out, dataset, [&](double share) { progress.update("writing", share); });
  progress.clear();
  if (options.json) {
    std::printf("%s\n", logs::dataset_json(dataset).c_str());
  } else {
    print_text(dataset, options.out);
  }
  return 0;
}

}  // namespace

namespace programs {

Command import_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand("import", "Makes a dataset of flight logs: ULog, blackbox, DataFlash, CSV");
  const auto options = std::make_shared<ImportOptions>();
  pinnquad::logs::LogSettings& settings = options->settings;
  add_paths(*line, "logs", options->logs, "LOG",
            "ULog, blackbox, DataFlash and uSD logs, CSV tables, folders of them; recognised by content");
  line->add_option(
          "--mapping", settings.mapping,
          "what the columns mean, where the content does not tell: " + pinnquad::logs::mapping_names() + ", or a file")
      ->type_name("NAME|FILE.toml");
  add_path(*line, "--airframe", settings.airframe, "NAME|FILE.toml",
           "converts logged rotor speeds or thrusts to commands; the mapping may name one");
  add_path(*line, "--out", options->out, "DATASET", "the folder to write; a dataset that is there is replaced");
  add_number(*line, "--rate", settings.rate_hz, 1.0, 2000.0,
             "rows per second; else as the slowest of commands, body rates and force, at most 100");
  line->add_option("--lag", options->lag, "from command to motion, removed from the commands: estimated, or as given")
      ->type_name("auto|SECONDS")
      ->capture_default_str();
  add_number(*line, "--thrust-curve", settings.thrust_curve, 0.0, 1.0,
             "k of thrust = (1 - k) u + k u^2; else the mapping's, or fitted")
      ->default_str("");
  add_time_range(*line, settings);
  add_number(*line, "--cut", settings.cut_s, 1.0, 1e6,
             "split flights into parts of about this many seconds, NAME_1, NAME_2 ..., so that train can hold one out");
  line->add_flag("--hold", settings.hold_commands, "hold the last command between rows instead of interpolating");
  line->add_flag("--json", options->json, "rows per step, flights and warnings as JSON, and nothing else, on stdout");
  line->add_flag("--list", options->list, "list the ready mappings");
  line->footer(
      "Examples:\n"
      "  pinnquad import flight.ulg --airframe mine.toml --out dataset\n"
      "  pinnquad import LOG00001.BFL --rate 200 --out dataset             Betaflight's blackbox, as it is\n"
      "  pinnquad import logs/ --rate 50 --out dataset                     all logs of a folder\n"
      "  pinnquad import log.csv --mapping mine.toml --lag 0.03 --out dataset --json\n"
      "Each flight becomes a CSV file of the folder; dataset.json says how they were made. The folder appears whole or "
      "not "
      "at all.\n"
      "Exit codes: 0; 2 bad input or a file that can't be read or written; 130 interrupted, nothing written.");
  return {line, [options] { return run(*options); }};
}

}  // namespace programs
