// SPDX-License-Identifier: MIT
// Input of a training: the kinds of models and the dataset that were asked for, sound enough to fit and to judge.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
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
#include "training/recipe.hpp"
#include "training/train_run.hpp"

namespace programs {

/// Fewer rows than this fill no batches worth the name.
inline constexpr std::size_t fewest_training_rows = 256, fewest_judging_rows = 64;

/// Kinds to compare.
struct Selection {
  std::vector<ModelKind> kinds;
  std::vector<Recipe> recipes;  ///< of the networks among them
  int epochs = 0;               ///< 0: what suits each kind

  bool has(const std::string& key) const {
    return std::any_of(kinds.begin(), kinds.end(), [&key](const ModelKind& kind) { return key == kind.key; });
  }
  /// The choice of an export where nobody says another: the best proven one; beside networks the kind structured. Of
  /// networks alone the first physics-informed one or, where there is none, the first.
  std::string exported() const {
    if (recipes.empty()) return export_causal;
    if (has("structured")) return "structured";
    std::string first, informed;
    for (const ModelKind& kind : kinds) {
      if (!kind.exportable) continue;
      const std::string key = kind.key;
      const auto begins = [&key](const Recipe& recipe) { return key.rfind(recipe.name + std::string("_"), 0) == 0; };
      if (std::none_of(recipes.begin(), recipes.end(), begins)) return export_causal;
      if (first.empty()) first = key;
      if (informed.empty() && key.find("_physics_informed") != std::string::npos) informed = key;
    }
    return informed.empty() ? first : informed;
  }
};

/// Of `all` those with these keys, in their order; all for no keys. Throws std::invalid_argument, one line.
inline std::vector<ModelKind> kinds_of(const std::vector<ModelKind>& all, const std::vector<std::string>& keys) {
  std::vector<ModelKind> kinds;
  std::vector<std::string> known;
  for (const ModelKind& kind : all) {
    known.emplace_back(kind.key);
    if (keys.empty() || detail::is_among(kind.key, keys)) kinds.push_back(kind);
  }
  for (const std::string& key : keys) {
    if (detail::is_among(key, known)) continue;
    throw std::invalid_argument("--models " + key + ": no model of that name; " +
                                pinnquad::logs::nearest_names(key, known));
  }
  return kinds;
}

/// Kinds that flights are compared by where no names are given.
inline const std::vector<std::string> flight_models = {"formula", "paper_vanilla", "paper_physics_informed",
                                                       "structured"};

/// Whether it is a structured kind, whatever its reach in time.
inline bool is_structured(const ModelKind& kind) { return std::string(kind.key).rfind("structured", 0) == 0; }

/// The kinds with these names, among `own`, the networks of every recipe and the formula; networks come before the
/// first structured one. No names: flight_models, or of logs their own. Throws std::invalid_argument, one line.
inline Selection selection_of(std::vector<ModelKind> own, std::vector<std::string> names, bool of_flights, int epochs) {
  Selection chosen;
  chosen.epochs = epochs;
  if (names.empty() && !of_flights) {
    chosen.kinds = std::move(own);
    return chosen;
  }
  if (names.empty()) names = flight_models;
  std::vector<ModelKind> others = {formula_kind()};
  for (const auto& make : recipes) {
    Recipe recipe = make();
    others.insert(others.end(), recipe.kinds.begin(), recipe.kinds.end());
    const auto is_named = [&names](const ModelKind& kind) { return detail::is_among(kind.key, names); };
    if (std::any_of(recipe.kinds.begin(), recipe.kinds.end(), is_named)) chosen.recipes.push_back(std::move(recipe));
  }
  own.insert(std::find_if(own.begin(), own.end(), is_structured), others.begin(), others.end());
  chosen.kinds = kinds_of(own, names);
  if (epochs == 0 && of_flights && !chosen.recipes.empty()) chosen.epochs = recipe_epochs;
  return chosen;
}

/// Throws std::invalid_argument for options of the structured kinds where none is chosen.
inline void require_structured(const TrainOptions& options, const Selection& selection) {
  if (!options.altitude && !options.pinned_slopes) return;
  if (std::any_of(selection.kinds.begin(), selection.kinds.end(), is_structured)) return;
  throw std::invalid_argument("--altitude and --slopes are of structured models: --models names none");
}

/// Throws std::invalid_argument for what --export can't mean.
inline void require_known_export(const std::string& choice, const std::vector<ModelKind>& kinds) {
  std::vector<std::string> known = {export_causal, export_centred};
  for (const ModelKind& kind : kinds) {
    if (kind.exportable) known.emplace_back(kind.key);
  }
  if (detail::is_among(choice, known)) return;
  throw std::invalid_argument("--export " + choice + ": no such model is compared; " +
                              pinnquad::logs::nearest_names(choice, known));
}

/// Fewer rows than this can't train 6,379 weights to anything worth flying: 20 batches of 64 in the 60 % that train.
inline constexpr std::size_t fewest_flight_rows = 2200;

/// Puts what was given as flights where its content belongs.
inline void take_source(TrainOptions& options) {
  using pinnquad::logs::SourceKind;
  const SourceKind kind = pinnquad::logs::kind_of_sources(options.flights, options.mapping);
  if (kind == SourceKind::flights) return;
  if (kind == SourceKind::dataset) options.dataset = options.flights.front();
  if (kind == SourceKind::logs) options.logs = options.flights;
  options.flights.clear();
}

/// The rows that a row's bias may be of. Rows of logs have derivatives that an import's filter made, which look ahead.
inline pinnquad::BiasTrial::Past past_rows_of(const pinnquad::logs::ImportedDataset& dataset,
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

/// The flights that the options hold out, and let choose.
inline HoldOutChoice hold_out_choice(const TrainOptions& options, const pinnquad::logs::ImportedDataset& dataset) {
  HoldOutChoice choice{options.hold_out, {}, options.validate, dataset.unlike};
  if (!options.hold_out_each.empty()) {
    choice.each = options.hold_out_each == "flight" ? HoldOutEach::flight : HoldOutEach::trajectory;
  }
  return choice;
}

/// The partings that the options ask for. Flights of which none is named are held out in their order; logs are not.
inline std::vector<Fold> folds_asked_for(const TrainOptions& options, const pinnquad::logs::ImportedDataset& dataset) {
  const pinnquad::Dataset& flights = dataset.flights;
  const HoldOutChoice choice = hold_out_choice(options, dataset);
  if (choice.each || !choice.names.empty()) return folds_of(flights, choice);
  if (!options.flights.empty() && !choice.validate.empty()) {
    throw std::invalid_argument("--validate: say with --hold-out what judges besides");
  }
  if (!options.flights.empty()) return {fold_in_order(flights)};
  using pinnquad::printable;
  if (flights.size() == 1) {
    throw std::invalid_argument("one flight can't train a model and judge it: cut it: pinnquad import " +
                                (options.logs.empty() ? "LOG" : printable(options.logs.front())) +
                                (options.mapping.empty() ? "" : " --mapping " + printable(options.mapping)) +
                                " --cut 60 --out dataset, then pinnquad train dataset --hold-out-each flight");
  }
  throw std::invalid_argument(
      "name the flights that judge, --hold-out NAME[,NAME...], or let each judge in turn, --hold-out-each "
      "flight|trajectory; the flights are " +
      listed(flights.flights(), [](const auto& flight) { return "'" + printable(flight.name) + "'"; }));
}

/// The dataset of the options, read or imported. `airframe`: of the flights.
inline pinnquad::logs::ImportedDataset dataset_of(const TrainOptions& options,
                                                  const pinnquad::Airframe<double>& airframe) {
  JobLine progress;
  const auto on_progress = [&progress](const std::string& job, double share) { progress.update(job, share); };
  if (!options.flights.empty()) {
    pinnquad::logs::ImportedDataset dataset;
    dataset.flights = pinnquad::logs::read_flights(options.flights, fewest_flight_rows,
                                                   pinnquad::logs::shared_columns(options.flights), on_progress);
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
  settings.from_s = options.from_s;
  settings.to_s = options.to_s;
  settings.on_progress = on_progress;
  settings.on_flights = [&options](const auto& dataset) { folds_asked_for(options, dataset); };  // refuses a name early
  pinnquad::logs::ImportedDataset dataset = pinnquad::logs::read_dataset(options.logs, settings);
  for (const std::string& taken : dataset.taken) std::printf("%s\n", taken.c_str());
  return dataset;
}

}  // namespace programs
