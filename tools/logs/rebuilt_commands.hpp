// SPDX-License-Identifier: MIT
// Motor commands of what a controller asked for: torque and thrust, as shares or in N m and N.
#pragma once

#include <optional>
#include <vector>

#include "logs/airframe_file.hpp"
#include "logs/mapping.hpp"

namespace pinnquad::logs {

/// The columns of `torque_and_thrust` as commands, front right, rear left, front left, rear right. NaN where one would
/// be beyond 0..1. Throws std::invalid_argument: an airframe that cannot make every torque and thrust.
void rebuild_commands(const Source& source, const std::optional<NamedAirframe>& airframe,
                      std::vector<std::vector<double>>& values);

/// Torques that never reach 0.15 % beside a thrust: PX4 asks for 0.2 % in a calm hover. Or a thrust that is above
/// 1 in half of the rows.
bool are_no_shares(const std::vector<std::vector<double>>& values);

/// The size of the largest number; 0 where there is none.
double largest(const std::vector<double>& values);
double largest_torque(const std::vector<std::vector<double>>& values);

}  // namespace pinnquad::logs
