// SPDX-License-Identifier: MIT
// Controllers compared in the loop: each on every trajectory, under every condition, with every seed, twice: with equal
// moderate gains, and with its own, which a search finds on other trajectories and seeds.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "loop/conditions.hpp"
#include "pinnquad/deploy/block_model.hpp"

namespace programs {

inline constexpr std::array<const char*, 4> campaign_trajectories = {"eight", "circle", "random", "step"};
/// The vehicle that flies: with the drag that the controllers know of; with the effects of
/// simulation/harder_quadrotor.hpp, of which they know the drag alone.
inline constexpr std::array<const char*, 2> campaign_vehicles = {"nominal", "harder"};
inline constexpr std::array<const char*, 2> campaign_gains = {"equal", "tuned"};

struct LoopCampaign {
  const pinnquad::BlockModel& model;
  std::vector<double> columns;            ///< of the model, in their order
  pinnquad::Airframe<double> airframe{};  ///< that the controllers are told
  std::string airframe_name{};
  std::vector<std::string> controllers{}, conditions{}, trajectories{}, gains{};
  std::string vehicle = "nominal";
  const pinnquad::BlockModel* wrench = nullptr;  ///< a residual wrench of this airframe (loop/wrench_block.hpp)
  int seeds = 5;
  int budget = 40;  ///< evaluations of the search, for each controller
  double duration_s = 40;
  LoopSensors sensors{};
  std::size_t threads = 1;
  std::string out{};  ///< a folder
};

/// Flies what is missing in the folder's journal, and writes `loop.json`. The same plan goes on where it was stopped.
/// Returns what is in loop.json. Throws std::invalid_argument, one line, of an airframe or an envelope that holds no
/// flight; Interrupted; OutputError.
nlohmann::json run_campaign(const LoopCampaign& plan);

}  // namespace programs
