// SPDX-License-Identifier: MIT
// The recipe `structured`: the paper's networks, and beside them the model of fit_structured(), monotone by
// construction.
#include <algorithm>
#include <string>
#include <vector>

#include "pinnquad/training/structured/fit_structured.hpp"
#include "training/log_kinds.hpp"
#include "training/network_kinds.hpp"
#include "training/recipe.hpp"

namespace programs {

namespace {

/// Of the paper's features and of the model's own, each once. An altitude that stands still is none of those, unless it
/// is asked for: no validation row gains by it.
std::vector<std::string> still_features_of_both(const FitTask& task) {
  std::vector<std::string> all = still_paper_features(task);
  for (const std::string& name : task.settings.altitude.value_or(false)
                                     ? pinnquad::still_features<pinnquad::InverseFeaturesWithAltitude>(task.training)
                                     : pinnquad::still_features<pinnquad::InverseFeatures>(task.training)) {
    if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
  }
  return all;
}

}  // namespace

Recipe structured_recipe() {
  Recipe recipe = paper_recipe();
  recipe.name = "structured";
  recipe.settings["structured"] = {{"base", "ridge, own angular acceleration"},
                                   {"residual", "2 x 32 ReLU, no angular acceleration"},
                                   {"learning_rate", pinnquad::ResidualTraining{}.learning_rate},
                                   {"weight_decay", pinnquad::ResidualTraining{}.weight_decay},
                                   {"least_gain", pinnquad::ResidualTraining{}.least_gain},
                                   {"least_altitude_gain", pinnquad::StructuredSettings{}.least_altitude_gain}};
  recipe.kinds.push_back(log_structured());
  recipe.besides_in_words =
      "structured: affine map of " + std::to_string(pinnquad::InverseFeatures::size) + " features, " +
      std::to_string(pinnquad::MonotoneBase<pinnquad::InverseFeatures>::parameter_count) +
      " numbers, and on what it leaves " +
      network_in_words<pinnquad::StructuredResidual<pinnquad::residual_inputs<pinnquad::InverseFeatures>>>(
          "2 x 32 ReLU") +
      ", kept where the validation rows gain";
  recipe.still_features = still_features_of_both;
  return recipe;
}

}  // namespace programs
