// SPDX-License-Identifier: MIT
// The losses that a training can be asked for by name.
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_line/listed.hpp"

namespace programs {

struct LossName {
  const char* key;    ///< on the command line and in report.json
  const char* title;  ///< in tables and results.csv
  const char* words;  ///< in an exported header
};

/// Every recipe has all of them (training/campaign.hpp).
inline constexpr std::array<LossName, 4> loss_names = {
    {{"vanilla", "vanilla", "MSE"},
     {"physics_informed", "physics-informed", "MSE + local monotonicity (roll, pitch, yaw), cyclical annealing"},
     {"constant_weight", "constant weight", "MSE + local monotonicity (roll, pitch, yaw), constant weight"},
     {"pearson", "pearson", "MSE + Pearson's correlation (roll, pitch, yaw), cyclical annealing"}}};
inline constexpr const LossName& vanilla = loss_names[0];
inline constexpr const LossName& physics_informed = loss_names[1];

/// No loss of a network but a model of another kind, in the same tables: the recipe `structured`.
inline constexpr LossName structured = {
    "structured", "structured",
    "least squares, slopes above 0; MSE of the residual, which sees no angular acceleration"};

/// The losses of that name, each once, in the order of the list above. Throws std::invalid_argument, one line, for a
/// name that is none.
inline std::vector<LossName> chosen_losses(const std::vector<std::string>& names) {
  std::vector<LossName> chosen;
  const std::string known = listed(loss_names, [](const LossName& loss) { return loss.key; });
  for (const std::string& name : names) {
    bool found = false;
    for (const LossName& loss : loss_names) found = found || name == loss.key;
    if (!found) throw std::invalid_argument("--loss: no loss named '" + name + "'; known: " + known);
  }
  for (const LossName& loss : loss_names) {
    for (const std::string& name : names) {
      if (name != loss.key) continue;
      chosen.push_back(loss);
      break;
    }
  }
  return chosen;
}

/// Whose best network is exported: the structured ones', else the physics-informed ones', else the first.
inline const LossName& exported_loss(const std::vector<LossName>& losses) {
  for (const LossName* wanted : {&structured, &physics_informed}) {
    for (const LossName& loss : losses) {
      if (loss.key == std::string(wanted->key)) return loss;
    }
  }
  return losses.front();
}

}  // namespace programs
