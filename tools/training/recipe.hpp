// SPDX-License-Identifier: MIT
// A recipe: kinds of models that are trained and compared together, by a name. All stand in `recipes`; each is a
// translation unit of its own, recipe_<name>.cpp, in a few lines of types (training/network_kinds.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/listed.hpp"
#include "training/model_kind.hpp"

namespace programs {

struct Recipe {
  const char* name;
  std::string network;             ///< "16 -> 10 x 25 ReLU -> 4, 6379 parameters"
  std::string optimizer;           ///< "Adam"
  nlohmann::json settings;         ///< the facts, for report.json
  std::vector<ModelKind> kinds;    ///< one per loss, then what is fitted whatever loss is asked for
  std::string besides_in_words{};  ///< of the latter, "structured: ..."; empty where there is nothing
  /// Features of its models that do nothing in the training rows.
  std::vector<std::string> (*still_features)(const FitTask&) = nullptr;

  const ModelKind& kind(const std::string& key) const {
    for (const ModelKind& of : kinds) {
      if (key == of.key) return of;
    }
    throw std::invalid_argument("the recipe " + std::string(name) + " has no kind '" + key + "'");
  }
  /// The one that is exported where nobody says another: the structured model, whose signs are proven; where there is
  /// none the physics-informed network or, where that was not asked for, the first loss.
  static std::string exported_of(const std::vector<ModelKind>& chosen) {
    for (const char* key : {"structured", "physics_informed"}) {
      for (const ModelKind& of : chosen) {
        if (std::string(key) == of.key) return key;
      }
    }
    const auto first = std::find_if(chosen.begin(), chosen.end(), [](const ModelKind& of) { return of.exportable; });
    return first == chosen.end() ? "" : first->key;
  }
};

Recipe paper_recipe();
Recipe best_recipe();
Recipe small_recipe();
Recipe structured_recipe();

/// Eq. (3) of the airframe inverted, in the air of the paper's site at each row's altitude; to compare with.
ModelKind linearized_kind();

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
