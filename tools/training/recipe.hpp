// SPDX-License-Identifier: MIT
// How `train` trains: a network, an optimiser and what each loss is made of, compiled. All recipes stand in
// `recipes`; each is a translation unit of its own, recipe_<name>.cpp, in a few lines of types
// (training/campaign.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/listed.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/features/features.hpp"
#include "pinnquad/loss/context.hpp"
#include "pinnquad/training/structured/fit_structured.hpp"
#include "pinnquad/training/training_data.hpp"
#include "training/losses.hpp"
#include "training/trained_network.hpp"

namespace programs {

using AltitudeRule = pinnquad::StructuredSettings::Altitude;

/// The training to do: models and data.
struct TrainingPlan {
  pinnquad::GivenAirframe airframe;
  bool library_airframe = false;  ///< see NetworkOfModel
  const pinnquad::RowSplit& split;
  std::vector<LossName> losses;
  int epochs = 0;
  std::uint64_t first_seed = 1;
  int seeds = 1;
  unsigned threads = 1;
  bool silent = false;                                  ///< no progress line: whoever asked for it has one
  AltitudeRule altitude = AltitudeRule::by_validation;  ///< of the recipe structured, as what follows
  bool pinned_slopes = false;                           ///< to the airframe's in hover; false: learnt
};

/// A finished training.
struct Training {
  LossName loss{};
  std::uint64_t seed = 0;
  double training_s = 0;
  std::shared_ptr<const TrainedNetwork> network;
  nlohmann::json altitude = nullptr;  ///< how it was chosen whether it is shown the altitude, for report.json
};

struct Recipe {
  const char* name;
  const char* summary;      ///< for --help
  std::string network;      ///< "16 -> 10 x 25 ReLU -> 4, 6379 parameters"
  std::string optimizer;    ///< "Adam"
  nlohmann::json settings;  ///< the facts, for report.json
  /// All trainings that were finished, in the order of loss and seed; Ctrl-C keeps what is finished.
  std::vector<Training> (*train)(const TrainingPlan&);
  std::vector<LossName> besides{};    ///< what it trains beside the losses that are asked for
  std::string besides_in_words = {};  ///< "structured: ..."; empty where there is nothing
  /// Features of its models that do nothing in the training rows.
  std::vector<std::string> (*still_features)(const TrainingPlan&) = [](const TrainingPlan& plan) {
    return pinnquad::still_features<pinnquad::PaperFeatures>(plan.split.train);
  };
};

Recipe paper_recipe();
Recipe best_recipe();
Recipe small_recipe();
Recipe structured_recipe();

/// The first is the default.
inline constexpr std::array<Recipe (*)(), 4> recipes = {structured_recipe, paper_recipe, best_recipe, small_recipe};

/// Throws std::invalid_argument, one line, for a name that is none.
inline Recipe chosen_recipe(const std::string& name) {
  for (const auto& make : recipes) {
    Recipe recipe = make();
    if (name == recipe.name) return recipe;
  }
  const std::string known = listed(recipes, [](const auto& make) { return make().name; });
  throw std::invalid_argument("no recipe named '" + name + "'; known: " + known);
}

}  // namespace programs
