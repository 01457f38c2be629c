// SPDX-License-Identifier: MIT
// Input of a training on logs: the kinds of models and the dataset that were asked for, sound enough to fit and to
// judge.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_line/listed.hpp"
#include "command_line/progress_line.hpp"
#include "logs/nearest_names.hpp"
#include "pinnquad/data/plausibility.hpp"
#include "pinnquad/logs/dataset_folder.hpp"
#include "training/hold_out.hpp"
#include "training/log_export.hpp"
#include "training/log_model.hpp"
#include "training/train_logs.hpp"

namespace programs {

/// Fewer rows than this fill no batches worth the name.
inline constexpr std::size_t fewest_training_rows = 256, fewest_judging_rows = 64;

/// The kinds asked for, in the order of the table.
inline std::vector<LogModelKind> chosen_kinds(const std::vector<std::string>& keys) {
  std::vector<LogModelKind> kinds;
  std::vector<std::string> known;
  for (const LogModelKind& kind : log_model_kinds()) {
    known.emplace_back(kind.key);
    if (keys.empty() || std::find(keys.begin(), keys.end(), kind.key) != keys.end()) kinds.push_back(kind);
  }
  for (const std::string& key : keys) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    throw std::invalid_argument("--models " + key + ": no model of that name; " +
                                pinnquad::logs::nearest_names(key, known));
  }
  return kinds;
}

/// Throws std::invalid_argument for what --export can't mean.
inline void require_known_export(const std::string& choice, const std::vector<LogModelKind>& kinds) {
  std::vector<std::string> known = {export_causal, export_centred};
  for (const LogModelKind& kind : kinds) known.emplace_back(kind.key);
  if (std::find(known.begin(), known.end(), choice) != known.end()) return;
  throw std::invalid_argument("--export " + choice + ": no such model is compared; " +
                              pinnquad::logs::nearest_names(choice, known));
}

/// The dataset of the options, read or imported.
inline pinnquad::logs::ImportedDataset dataset_of(const LogTrainingOptions& options) {
  JobLine progress;
  const auto on_progress = [&progress](const std::string& job, double share) { progress.update(job, share); };
  if (options.logs.empty()) return pinnquad::logs::read_dataset_folder(options.dataset, on_progress);
  pinnquad::logs::LogSettings settings;
  settings.mapping = options.mapping;
  settings.airframe = options.airframe;
  settings.on_progress = on_progress;
  return pinnquad::logs::read_dataset(options.logs, settings);
}

/// Throws InputError and std::invalid_argument for flights that no model should be fitted to, or judged on.
inline void require_sound(const std::string& folder, const pinnquad::logs::ImportedDataset& dataset,
                          const std::vector<Fold>& folds) {
  if (!pinnquad::is_clock_time(dataset.lag_removed_s)) {
    throw pinnquad::InputError(folder + "/" + pinnquad::logs::dataset_file_name, 0, 0,
                               "a lag removed of 0 to " + pinnquad::number_text(pinnquad::longest_clock_s) +
                                   " s, as a model's header states it",
                               pinnquad::number_text(dataset.lag_removed_s) + " s");
  }
  const std::vector<std::string> files = pinnquad::logs::flight_files(dataset);
  for (std::size_t i = 0; i < files.size(); ++i) {
    const pinnquad::Flight& flight = dataset.flights[i];
    const std::string place = folder + "/" + files[i];
    pinnquad::require_plausible(place, flight);
    pinnquad::require_varied_commands(place, flight, {0, flight.size()}, "flight's");
  }
  pinnquad::logs::require_different_flights(dataset.flights);
  for (const Fold& fold : folds) {
    const auto require = [&](const pinnquad::RowSet& rows, std::size_t fewest, const char* what) {
      if (rows.size() >= fewest) return;
      throw std::invalid_argument("holding out " + pinnquad::printable(fold.name) + " leaves " +
                                  std::to_string(rows.size()) + " rows to " + what + "; expected " +
                                  std::to_string(fewest) + " or more");
    };
    require(fold.split.train, fewest_training_rows, "train");
    require(fold.split.validation, fewest_judging_rows, "validate");
    require(fold.split.test, fewest_judging_rows, "judge");
  }
}

inline HoldOutChoice hold_out_of(const LogTrainingOptions& options, const pinnquad::logs::ImportedDataset& dataset) {
  HoldOutChoice choice;
  choice.names = options.hold_out;
  if (!options.hold_out_each.empty()) {
    choice.each = options.hold_out_each == "flight" ? HoldOutEach::flight : HoldOutEach::trajectory;
  }
  if (choice.each || !choice.names.empty()) return choice;
  throw std::invalid_argument(
      "say what judges: --hold-out NAME[,NAME...] or --hold-out-each flight|trajectory; the flights are " +
      listed(dataset.flights.flights(), [](const auto& flight) { return pinnquad::printable(flight.name); }));
}

}  // namespace programs
