// SPDX-License-Identifier: MIT
// A recipe: how a network is trained, by a name that begins those of its kinds (paper_vanilla). All stand in `recipes`;
// each is a translation unit of its own, recipe_<name>.cpp, in a few lines of types (training/network_kinds.hpp).
#pragma once

#include <array>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "training/model_kind.hpp"

namespace programs {

struct Recipe {
  const char* name;
  std::string network;           ///< "16 -> 10 x 25 ReLU -> 4, 6379 parameters"
  nlohmann::json settings;       ///< the facts, for report.json
  std::vector<ModelKind> kinds;  ///< one per loss
};

Recipe paper_recipe();
Recipe best_recipe();
Recipe small_recipe();
inline constexpr std::array<Recipe (*)(), 3> recipes = {paper_recipe, best_recipe, small_recipe};

/// Facts of the kind structured, for report.json.
nlohmann::json structured_settings(bool pinned_slopes);

/// Features of the networks and of the kind structured, each once, that do nothing in the training rows. An altitude
/// that stands still is none of the latter's, unless it is asked for: no validation row gains by it.
std::vector<std::string> still_features(const FitTask& task, bool networks, bool structured);

/// Eq. (3) of the airframe inverted, in the air of the paper's site at each row's altitude; to compare with.
ModelKind formula_kind();

}  // namespace programs
