// SPDX-License-Identifier: MIT
// Vehicles that nobody knows, flown by what is guessed of them, by what is learnt on board, and by the truth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace programs {

/// By the analytic inverse of a guessed airframe, by what learns slopes, lag and drag in flight, by the analytic
/// inverse of the true vehicle; each with a bias that is learnt in flight.
inline std::vector<std::string> vehicle_controllers() { return {"start", "onboard", "true_inverse"}; }

/// Things that happen to a vehicle while it is learnt (docs/onboard.md); in `calm` nothing does.
inline std::vector<std::string> vehicle_conditions() {
  return {"calm", "gusts", "noise_3", "payload_late", "ground_minute", "nan", "saturated"};
}

struct VehiclesOptions {
  std::vector<std::string> controllers, conditions;
  std::size_t vehicles = 0;
  std::size_t drawn = 0;  ///< the vehicle whose slopes over time are drawn, as `onboard` learns them
  std::uint64_t seed = 1;
  std::string start = "forty", out;
  double frozen_s = 20;
  bool json = false;
};

/// Flies what the folder's journal lacks, writes `out`/loop.json, slopes_CONDITION_VEHICLE.svg of what is learnt on
/// board, and prints a table. Its exit code.
int fly_vehicles(const VehiclesOptions& options);

}  // namespace programs
