// SPDX-License-Identifier: MIT
// Quantities that a log leaves to compute: angular acceleration from body rates, specific force from accelerations or
// velocities, body velocity from that in the world or from positions, height above ground; and the rows of a flight of
// all of it.
//   specific force f = v_dot + omega x v - R^T g, whichever of the three was logged
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "logs/common_rows.hpp"
#include "pinnquad/data/dataset.hpp"

namespace pinnquad::logs {

/// A log's rows as those of a flight, gaps in time where rows were incomplete; beside them whether the vehicle was
/// landed.
struct LogRows {
  Flight flight;
  std::vector<bool> landed;  ///< by what the log says; empty if it says nothing
  bool has_velocity = false, has_altitude = false;
  bool force_of_velocity = false;  ///< no accelerometer: the specific force is that which the velocity changes by
  std::vector<std::string> told;   ///< how what was computed was computed
  std::size_t incomplete = 0;      ///< rows left out: a cell without a number, a gap in a topic
  std::size_t window_ends = 0;     ///< rows left out: where a derivative's window reached beyond the rows
};

/// Height of the ground in the log's heights: that of the rows on it before the flight, if the mapping says so.
double ground_height(const CommonRows& rows, const std::vector<double>& height, const Mapping& mapping,
                     LogRows& result);

/// Throws InputError where the log has nothing of which specific force could be made.
LogRows rows_of_log(CommonRows rows, const BoundLog& log, const Mapping& mapping, const std::string& source);

}  // namespace pinnquad::logs
