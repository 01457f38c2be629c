// SPDX-License-Identifier: MIT
// Losses and optimisers of the recipes that train as the study does (training/best_recipe.hpp), for a network of any
// size.
#pragma once

#include "training/best_recipe.hpp"
#include "training/network_kinds.hpp"
#include "training/recipe.hpp"

namespace programs::best {

template <class NetworkType>
struct Parts {
  using Network = NetworkType;

  static Optimizer vanilla_optimizer() { return optimizer(vanilla_decay); }
  static Optimizer informed_optimizer() { return optimizer(informed_decay); }
  static auto annealed() { return physics_loss(annealed_weight()); }
  static auto constant() { return physics_loss(constant_weight()); }
  static auto pearson() { return with_schedule(PearsonLoss{}, annealed_weight()); }
};

/// The facts, for report.json.
inline nlohmann::json settings(const char* network) {
  return {{"network", network},
          {"batch", batch_size},
          {"optimizer", optimizer_name},
          {"learning_rate", learning_rate},
          {"learning_rate_schedule", learning_rate_schedule_name},
          {"weight_decay", {{"vanilla", vanilla_decay}, {"physics_informed", informed_decay}}},
          {"lambda_max", lambda_max},
          {"cycles", annealing_cycles},
          {"hold", annealing_hold},
          {"step_gain", step_gain}};
}

}  // namespace programs::best
