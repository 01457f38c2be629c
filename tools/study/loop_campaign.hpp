// SPDX-License-Identifier: MIT
// Controllers compared in the loop: each on every trajectory, under every condition, with every seed, twice: with equal
// moderate gains, and with its own, which a search finds on other trajectories and seeds.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "loop/controlled_loop.hpp"

namespace study {

inline constexpr std::array<const char*, 4> campaign_trajectories = {"eight", "circle", "random", "step"};
/// LoopSetting::harder: no, yes.
inline constexpr std::array<const char*, 2> campaign_vehicles = {"nominal", "harder"};
inline constexpr std::array<const char*, 2> campaign_gains = {"equal", "tuned"};

struct LoopCampaign {
  programs::LoopSetting setting;
  std::string airframe_name{};
  std::vector<std::string> controllers{}, conditions{}, trajectories{}, gains{};
  const pinnquad::BlockModel* wrench = nullptr;  ///< a residual wrench of this airframe (study/wrench_block.hpp)
  int seeds = 5;
  int budget = 40;  ///< evaluations of the search, for each controller
  std::size_t threads = 1;
  std::string out{};  ///< a folder
};

/// Flies what is missing in the folder's journal, and writes `loop.json`. The same plan goes on where it was stopped.
/// Returns what is in loop.json. Throws std::invalid_argument, one line, of an airframe or an envelope that holds no
/// flight; Interrupted; OutputError.
nlohmann::json run_campaign(const LoopCampaign& plan);

}  // namespace study
