// SPDX-License-Identifier: MIT
// Input of a training: the kinds of models and the dataset that were asked for, sound enough to fit and to judge.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "command_line/listed.hpp"
#include "command_line/progress_line.hpp"
#include "logs/nearest_names.hpp"
#include "pinnquad/data/plausibility.hpp"
#include "pinnquad/features/extra_columns.hpp"
#include "pinnquad/logs/dataset_folder.hpp"
#include "training/export_choice.hpp"
#include "training/flight_lag.hpp"
#include "training/hold_out.hpp"
#include "training/model_kind.hpp"
#include "training/network_kinds.hpp"
#include "training/recipe.hpp"
#include "training/train_run.hpp"

namespace programs {

/// Fewer rows than this fill no batches worth the name.
inline constexpr std::size_t fewest_training_rows = 256, fewest_judging_rows = 64;

/// Kinds to compare, by the name of their selection, and the facts of it.
struct Selection {
  std::string name;  ///< a recipe's, or "logs"
  std::vector<ModelKind> kinds;
  std::optional<Recipe> recipe;
};

/// Of `all` those with these keys, in their order; all for no keys. Throws std::invalid_argument, one line.
inline std::vector<ModelKind> kinds_of(const std::vector<ModelKind>& all, const std::vector<std::string>& keys) {
  std::vector<ModelKind> kinds;
  std::vector<std::string> known;
  for (const ModelKind& kind : all) {
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

/// The recipe's kinds for the losses asked for, and what it fits besides; or those that logs are compared by.
inline Selection selection_of(const TrainOptions& options) {
  if (options.recipe.empty()) return {"logs", kinds_of(log_model_kinds(), options.models), {}};
  Selection chosen{options.recipe, {linearized_kind()}, chosen_recipe(options.recipe)};
  const Recipe& recipe = *chosen.recipe;
  if (recipe.besides_in_words.empty() && (options.altitude || options.pinned_slopes)) {
    throw std::invalid_argument("--altitude and --slopes go with --recipe structured, not with " + options.recipe);
  }
  const auto is_in = [](const auto& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const std::string& name : options.losses) {
    if (is_in(loss_names, name)) continue;
    throw std::invalid_argument("--loss: no loss named '" + name + "'; known: " + listed(loss_names));
  }
  for (const ModelKind& kind : recipe.kinds) {
    if (is_in(options.losses, kind.key) || !is_in(loss_names, kind.key)) chosen.kinds.push_back(kind);
  }
  return chosen;
}

/// Throws std::invalid_argument for what --export can't mean.
inline void require_known_export(const std::string& choice, const std::vector<ModelKind>& kinds) {
  std::vector<std::string> known = {export_causal, export_centred};
  for (const ModelKind& kind : kinds) {
    if (kind.exportable) known.emplace_back(kind.key);
  }
  if (std::find(known.begin(), known.end(), choice) != known.end()) return;
  throw std::invalid_argument("--export " + choice + ": no such model is compared; " +
                              pinnquad::logs::nearest_names(choice, known));
}

/// Fewer rows than this can't train 6,379 weights to anything worth flying: 20 batches of 64 in the 60 % that train.
inline constexpr std::size_t fewest_flight_rows = 2200;

/// The dataset of the options, read or imported. `airframe`: of the flights.
inline pinnquad::logs::ImportedDataset dataset_of(const TrainOptions& options,
                                                  const pinnquad::Airframe<double>& airframe) {
  JobLine progress;
  const auto on_progress = [&progress](const std::string& job, double share) { progress.update(job, share); };
  if (!options.flights.empty()) {
    pinnquad::logs::ImportedDataset dataset;
    dataset.flights = pinnquad::logs::read_flights(options.flights, fewest_flight_rows, {}, on_progress);
    dataset.sources = options.flights;
    dataset.sample_period_s = pinnquad::sample_period_s(pinnquad::all_rows(dataset.flights.flights()));
    remove_latency(dataset, airframe, options.lag_s);
    return dataset;
  }
  if (options.logs.empty()) return pinnquad::logs::read_dataset_folder(options.dataset, on_progress);
  pinnquad::logs::LogSettings settings;
  settings.mapping = options.mapping;
  settings.airframe = options.airframe;
  settings.lag_s = options.lag_s;
  settings.on_progress = on_progress;
  return pinnquad::logs::read_dataset(options.logs, settings);
}

/// The rows that a row's bias may be of. Rows of logs have derivatives that an import's filter made, which look ahead.
inline pinnquad::PastRows past_rows_of(const pinnquad::logs::ImportedDataset& dataset,
                                       const pinnquad::Airframe<double>& airframe, bool of_logs) {
  constexpr double filter_s = 0.05;
  return {pinnquad::flown_motion_age_s + (of_logs ? filter_s : 0),
          pinnquad::least_bias_time_constant_s(std::max(airframe.rotor_time_constant_s, dataset.lag_removed_s))};
}

/// The file of each flight: that which was given, or in the folder of the dataset.
inline std::vector<std::string> places_of(const TrainOptions& options, const pinnquad::logs::ImportedDataset& dataset) {
  if (!options.flights.empty()) return options.flights;
  std::vector<std::string> places;
  for (const std::string& file : pinnquad::logs::flight_files(dataset)) {
    places.push_back(options.dataset_folder() + "/" + file);
  }
  return places;
}

/// Throws InputError and std::invalid_argument for flights that no model should be fitted to, or judged on.
inline void require_sound(const TrainOptions& options, const pinnquad::logs::ImportedDataset& dataset,
                          const std::vector<Fold>& folds) {
  if (!(std::abs(dataset.lag_removed_s) <= pinnquad::longest_lag_s)) {
    throw pinnquad::InputError(options.dataset_folder() + "/" + pinnquad::logs::dataset_file_name, 0, 0,
                               "a lag removed of at most " + pinnquad::number_text(pinnquad::longest_lag_s) + " s",
                               pinnquad::number_text(dataset.lag_removed_s) + " s");
  }
  const std::vector<std::string> places = places_of(options, dataset);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const pinnquad::Flight& flight = dataset.flights[i];
    pinnquad::require_plausible(places[i], flight);
    if (!folds.front().by_time) pinnquad::require_varied_commands(places[i], flight, {0, flight.size()}, "flight's");
  }
  const pinnquad::RowSplit& blocks = folds.front().split;
  for (const auto& [rows, name] :
       {std::pair{&blocks.train, "training"}, {&blocks.validation, "validation"}, {&blocks.test, "test"}}) {
    for (const pinnquad::FlightRows& piece : rows->pieces()) {
      if (folds.front().by_time) pinnquad::require_varied_commands(places[0], *piece.flight, piece.rows, name);
    }
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

/// Columns beside the motion that all flights have, and no kind of model takes.
inline std::vector<pinnquad::ColumnName> unused_columns(const pinnquad::Dataset& flights) {
  std::vector<pinnquad::ColumnName> unused;
  for (const pinnquad::ExtraColumn& column : flights[0].columns()) {
    bool everywhere = column.name != pinnquad::BatteryVoltage::name;
    for (const pinnquad::Flight& flight : flights.flights()) {
      const pinnquad::ExtraColumn* other = flight.column(column.name);
      everywhere = everywhere && other != nullptr && other->unit == column.unit;
    }
    if (everywhere) unused.push_back({column.name, column.unit});
  }
  return unused;
}

/// The partings that the options ask for. Flights of which none is named are held out in their order; logs are not.
inline std::vector<Fold> folds_asked_for(const TrainOptions& options, const pinnquad::Dataset& flights) {
  HoldOutChoice choice;
  choice.names = options.hold_out;
  if (!options.hold_out_each.empty()) {
    choice.each = options.hold_out_each == "flight" ? HoldOutEach::flight : HoldOutEach::trajectory;
  }
  if (choice.each || !choice.names.empty()) return folds_of(flights, choice);
  if (!options.flights.empty()) return {fold_in_order(flights)};
  throw std::invalid_argument(
      "say what judges: --hold-out NAME[,NAME...] or --hold-out-each flight|trajectory; the flights are " +
      listed(flights.flights(), [](const auto& flight) { return pinnquad::printable(flight.name); }));
}

}  // namespace programs
