// SPDX-License-Identifier: MIT
// The options of `train` for logs of a real vehicle, and which options do not go together.
#pragma once

#include <CLI/CLI.hpp>

#include <stdexcept>
#include <string>

#include "command_line/options.hpp"
#include "training/train_logs.hpp"

namespace programs {

/// Training on logs of a real vehicle.
inline void add_log_options(CLI::App& app, LogTrainingOptions& options) {
  add_path(app, "--dataset", options.dataset, "DIR",
           "imported flights of a real vehicle, a folder that `pinnquad import` wrote: whole flights are held "
           "out, all kinds of models are compared on them");
  add_paths(app, "--log", options.logs, "LOG", "flight logs, imported first: ULog, CSV, or folders of them");
  app.add_option("--mapping", options.mapping, "what the columns of --log mean: see import")
      ->type_name("NAME|FILE.toml");
  app.add_option("--hold-out", options.hold_out, "flights or trajectories that judge, held out together")
      ->delimiter(',')
      ->type_name("NAME,...");
  app.add_option("--hold-out-each", options.hold_out_each,
                 "hold out each flight or each trajectory in turn; the export is fitted to all")
      ->check(CLI::IsMember({"flight", "trajectory"}))
      ->type_name("flight|trajectory");
  app.add_option("--models", options.models, "compare these alone, by their names in report.json")
      ->delimiter(',')
      ->type_name("NAME,...");
  app.add_option("--export", options.export_choice,
                 "which model becomes the header: the best that flies on measured motion (causal), the best that looks "
                 "ahead (centred: planned trajectories only), or one by its name")
      ->capture_default_str()
      ->type_name("causal|centred|NAME");
}

/// Throws std::invalid_argument, one line, for options that do not go together.
inline void require_one_source(const CLI::App& line) {
  const auto given = [&line](const char* name) { return line.count(name) > 0; };
  const auto refuse = [](const std::string& what) { throw std::invalid_argument(what); };
  std::string sources;
  int count = 0;
  for (const char* source : {"--flight", "--dataset", "--log"}) {
    if (!given(source)) continue;
    sources += (count++ > 0 ? " and " : "") + std::string(source);
  }
  if (count == 0) refuse("--flight, --dataset or --log is required");
  if (count > 1) refuse(sources + " can't be given together: expected one of them");
  for (const char* of_flights : {"--recipe", "--loss", "--altitude", "--slopes"}) {
    if (given(of_flights) && !given("--flight"))
      refuse(std::string(of_flights) + " goes with --flight, not with " + sources);
  }
  for (const char* of_logs : {"--hold-out", "--hold-out-each", "--models", "--export"}) {
    if (given(of_logs) && given("--flight"))
      refuse(std::string(of_logs) + " goes with --dataset or --log, not with --flight");
  }
  if (given("--log") != given("--mapping")) refuse("--log and --mapping go together: what its columns mean");
  if (given("--hold-out") && given("--hold-out-each")) refuse("--hold-out and --hold-out-each can't be given together");
}

}  // namespace programs
