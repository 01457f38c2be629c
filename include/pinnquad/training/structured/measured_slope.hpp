// SPDX-License-Identifier: MIT
// How well the rows of a training know a slope: its standard error and interval (slopes_under_noise.hpp).
#pragma once

#include <array>

namespace pinnquad {

/// How much one signed sum rises with what is asked of it: the sum of the commands with the thrust, s^2/m; those about
/// the axes with the angular acceleration, s^2/rad.
struct MeasuredSlope {
  bool known = false;  ///< false: pinned, about an axis of a window, of features without it, or of too few rows
  double slope = 0;    ///< of the base; of a window the sum over all taps
  double standard_error = 0;
  double lower = 0, upper = 0;  ///< 95 %
  double window_s = 0;          ///< of the smoothing of the rows that it is of; 0: of the rows as they are
  double least_squares = 0;     ///< of the rows as they are
  bool smoothed() const { return window_s > 0; }
};

/// Sum of the commands, roll, pitch, yaw.
using SlopesOfSums = std::array<MeasuredSlope, 4>;

}  // namespace pinnquad
