// SPDX-License-Identifier: MIT
// Are the commands in the order of the airframe's motors? Asked of the motion: each order is fitted to roll, pitch and
// yaw acceleration with the signs that the airframe's allocation gives it, and the one that explains them says which it
// is.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/dynamics/airframe.hpp"

namespace pinnquad::logs {

struct MotorOrderCheck {
  std::optional<std::string> finding;  ///< none where the order as it stands fits, and where nothing can be said
  /// The airframe's motor i is the log's command `permutation[i]`; 0, 1, 2, 3 where nothing is proposed.
  std::array<std::size_t, rotor_count> permutation = {0, 1, 2, 3};
  std::string convention;         ///< that has the log's order: "betaflight"; empty for none known
  bool ambiguous = false;         ///< nothing is excited enough to tell, or two orders explain the motion alike
  bool yaw_reversed = false;      ///< roll and pitch fit, yaw has the wrong sign: propellers turn the other way
  std::array<bool, 3> turns_against{};  ///< roll, pitch, yaw turn against the commands as they stand
  double explained = 0;           ///< R^2 of roll and pitch acceleration, mean, as the commands stand
  double explained_permuted = 0;  ///< by the best order
};

/// Of all 24 orders the one whose signed sums explain roll and pitch acceleration best, gains positive; yaw, which is
/// weak, only tells whether the propellers turn as the airframe says. As they are, or below 8 Hz: gyro noise that comes
/// back as commands hides the order in calm flights. A finding where that order is not the one that stands, which
/// explains less than three quarters of it (R^2, mean of both axes), or where a '+' frame explains the motion and no X
/// three quarters as well. A crash, a knock or a catch by hand weighs no more than the liveliest of the other blocks of
/// time. Segments on one uniform clock, lag-aligned (remove_lag()). Limits: body axes that are x forward, y left, z up
/// look like motors exchanged front for rear, for the commands cannot tell the two apart: find_turning_mistake() can,
/// and is to be asked first.
MotorOrderCheck check_motor_order(const std::vector<Flight>& lag_aligned, const Airframe<double>& airframe);

}  // namespace pinnquad::logs
