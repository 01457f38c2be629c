// SPDX-License-Identifier: MIT
// The losses that a training can be asked for by name.
#pragma once

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_line/listed.hpp"
#include "pinnquad/training/structured/fit_structured.hpp"

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
inline constexpr LossName structured = {"structured", "structured", pinnquad::structured_in_words};

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

inline bool is_structured(const LossName& loss) { return loss.key == std::string(structured.key); }

/// "vanilla network", "structured model".
inline std::string with_kind(const LossName& loss) {
  return std::string(loss.title) + (is_structured(loss) ? " model" : " network");
}

/// The kind to compare with, seed by seed, among those asked for: a network with the vanilla ones, a structured
/// model with the physics-informed networks before those; null for the baseline itself.
inline const LossName* compared_with(const std::vector<LossName>& losses, const LossName& loss) {
  const LossName* baseline = nullptr;
  for (const LossName& asked : losses) {
    if (asked.key == std::string(loss.key)) continue;
    if (asked.key == std::string(vanilla.key)) baseline = &vanilla;
    if (is_structured(loss) && asked.key == std::string(physics_informed.key)) baseline = &physics_informed;
  }
  return baseline;
}

/// Of the networks those whose best may be exported: the physics-informed ones or, where those were not asked for, the
/// first. The structured ones where there are no networks.
inline LossName exported_network(const std::vector<LossName>& losses) {
  const auto informed = std::find_if(
      losses.begin(), losses.end(), [](const LossName& loss) { return loss.key == std::string(physics_informed.key); });
  return informed == losses.end() ? losses.front() : *informed;
}

/// The kind to export: the structured ones, whose signs are proven; a network only where there are none.
inline LossName exported_kind(const std::vector<LossName>& losses) {
  return std::any_of(losses.begin(), losses.end(), is_structured) ? structured : exported_network(losses);
}

}  // namespace programs
