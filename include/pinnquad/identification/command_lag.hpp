// SPDX-License-Identifier: MIT
// How long after a command the vehicle moves, by how well the delayed commands explain the motion; and commands moved by it.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "pinnquad/data/dataset.hpp"

namespace pinnquad {

struct LagSearch {
  double shortest_s = 0;
  double longest_s = 0.2;
};

/// Of one motion: angular acceleration about x, y, z, or specific force along z.
struct MotionLag {
  double lag_s = 0;
  double explained = 0;  ///< R^2 at the lag
  double sharpness = 0;  ///< how much of it is lost half a search range away, 0..1
  bool found = false;    ///< a maximum inside the range, sharp enough
};

struct CommandLag {
  std::array<MotionLag, 4> motions;  ///< roll, pitch, yaw, collective
  double lag_s = 0;                  ///< of those found, weighted by what they explain
  double spread_s = 0;               ///< largest difference of one of them to it
  double confidence = 0;             ///< 0..1
  bool found = false;                ///< otherwise lag_s is 0 and nothing should be removed
  std::string warning;               ///< why it is not found or not to be trusted; empty for none
  std::size_t rows = 0;
};

/// First-order motor lag behind a pure delay.
struct MotorLag {
  double time_constant_s = 0;
  double delay_s = 0;
  double explained = 0;                ///< R^2 of the motions together
  double explained_by_pure_delay = 0;  ///< with CommandLag's lag in place of both
  double equivalent_delay_s = 0;       ///< time_constant_s + delay_s: what slow commands see
  bool found = false;
  std::string warning;
};

/// Segments of one log, each on a uniform clock of `period_s`, commands as they were logged.
CommandLag estimate_command_lag(const std::vector<Flight>& segments, double period_s, const LagSearch& search = {});
MotorLag fit_motor_lag(const std::vector<Flight>& segments, double period_s, const LagSearch& search = {});

/// A series on a uniform clock, each row with the value of `lag_s` earlier, by lines between rows; NaN where there is none.
std::vector<double> remove_lag(const std::vector<double>& series, double period_s, double lag_s);
/// The commands of each row replaced by those of `lag_s` earlier; rows that have none are gone.
Flight remove_lag(const Flight& segment, double period_s, double lag_s);

}  // namespace pinnquad
