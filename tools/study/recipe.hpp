// SPDX-License-Identifier: MIT
// How the study trains, as study.json says it: the recipe `best` (training/best_recipe.hpp) from seeds of its own.
#pragma once

#include <cstdint>

#include <nlohmann/json.hpp>

#include "training/best_recipe.hpp"

namespace study {

using namespace programs::best;

inline constexpr std::uint64_t first_seed = 1;
inline constexpr std::uint64_t first_flight_seed = 101;  ///< flights that nothing was chosen on

inline nlohmann::json recipe_description() {
  const pinnquad::Adam used = adam(vanilla_decay);
  return {{"batch", batch_size},
          {"batch_order", "shuffled"},
          {"optimizer", optimizer_name},
          {"learning_rate", used.learning_rate},
          {"learning_rate_schedule", learning_rate_schedule_name},
          {"beta_1", used.beta_1},
          {"beta_2", used.beta_2},
          {"weight_decay", {{"vanilla", vanilla_decay}, {"physics-informed", informed_decay}}},
          {"lambda_max", lambda_max},
          {"cycles", annealing_cycles},
          {"hold", annealing_hold},
          {"step", "tanh"},
          {"step_gain", step_gain},
          {"series", "standardised by their spread in the training rows"},
          {"inputs_and_outputs", "z-scored by the training rows"},
          {"initialisation", "Xavier uniform"}};
}

}  // namespace study
