// SPDX-License-Identifier: MIT
// Order and window of a Savitzky-Golay filter from the series itself: its spectrum says what is signal and what noise, and the
// window whose derivative would have the least squared error is taken.
#pragma once

#include <cstddef>
#include <vector>

#include "pinnquad/data/split.hpp"
#include "pinnquad/identification/savitzky_golay.hpp"

namespace pinnquad {

struct SavitzkyGolayChoice {
  SavitzkyGolay filter;
  double noise = 0;           ///< standard deviation of the noise of a row, in the series' unit
  double bandwidth_Hz = 0;    ///< where the signal sinks into the noise
  double expected_error = 0;  ///< root of the mean square of the derivative's error, in its unit
};

SavitzkyGolayChoice choose_savitzky_golay(const std::vector<double>& series, const std::vector<IndexRange>& segments,
                                          double period_s, int derivative);

}  // namespace pinnquad
