// SPDX-License-Identifier: MIT
// Vehicles that nobody knows, flown by what is guessed of them, by what is learnt on board, and by the truth.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace programs {

struct NamedChoice {
  const char* name;
  const char* summary;
};

inline constexpr std::array<NamedChoice, 3> vehicle_controllers = {{
    {"start", "the analytic inverse of a guessed airframe, with a bias learnt in flight"},
    {"onboard", "what learns slopes, lag and drag in flight, each with a proof before it flies"},
    {"true_inverse", "the same of the true vehicle and its drag"},
}};

/// Things that happen to a vehicle while it is learnt. The first is nothing.
inline constexpr std::array<NamedChoice, 7> vehicle_conditions = {{
    {"calm", "sensors' noise alone"},
    {"gusts", "wind of 4 m/s and gusts"},
    {"noise_3", "three times the noise"},
    {"payload_late", "30 % heavier after 30 s"},
    {"ground_minute", "a minute on the ground before, taken for flight"},
    {"nan", "no numbers from sensors, 15 s to 15.3 s"},
    {"saturated", "sines that take commands to their ends, the first 10 s"},
}};

struct VehiclesOptions {
  std::vector<std::string> controllers, conditions;
  std::size_t vehicles = 0;
  std::uint64_t seed = 1;
  std::string start = "forty", out;
  double frozen_s = 20;
  bool json = false;
};

/// Flies all, writes `out`/loop.json and prints a table. Its exit code.
int fly_vehicles(const VehiclesOptions& options);

}  // namespace programs
