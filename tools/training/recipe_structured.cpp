// SPDX-License-Identifier: MIT
// Facts that a training tells of the kind structured, the model of fit_structured().
#include <algorithm>
#include <string>
#include <vector>

#include "pinnquad/training/structured/fit_structured.hpp"
#include "training/network_kinds.hpp"
#include "training/recipe.hpp"

namespace programs {

nlohmann::json structured_settings(bool pinned_slopes) {
  using Features = pinnquad::InverseFeatures;
  return {{"words",
           "affine map of " + std::to_string(Features::size) + " features, " +
               std::to_string(pinnquad::MonotoneBase<Features>::parameter_count) + " numbers, and on what it leaves " +
               network_in_words<pinnquad::StructuredResidual<pinnquad::residual_inputs<Features>>>("2 x 32 ReLU") +
               ", kept where the validation rows gain"},
          {"base", "ridge, own angular acceleration"},
          {"residual", "2 x 32 ReLU, no angular acceleration"},
          {"learning_rate", pinnquad::ResidualTraining{}.learning_rate},
          {"weight_decay", pinnquad::ResidualTraining{}.weight_decay},
          {"least_gain", pinnquad::ResidualTraining{}.least_gain},
          {"least_altitude_gain", pinnquad::StructuredSettings{}.least_altitude_gain},
          {"slopes", pinned_slopes ? "pinned" : "learned"}};
}

std::vector<std::string> still_features(const FitTask& task, bool networks, bool structured) {
  std::vector<std::string> all;
  const auto add = [&all](const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
    }
  };
  if (networks) add(pinnquad::still_features<pinnquad::PaperFeatures>(task.training));
  if (structured) {
    add(task.settings.altitude.value_or(false)
            ? pinnquad::still_features<pinnquad::InverseFeaturesWithAltitude>(task.training)
            : pinnquad::still_features<pinnquad::InverseFeatures>(task.training));
  }
  return all;
}

}  // namespace programs
