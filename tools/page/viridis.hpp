// SPDX-License-Identifier: MIT
// Colours of a quantity: viridis (Smith, van der Walt and Firing, matplotlib, CC0), lightness rising evenly from end to
// end, so that it also reads in grey and with any colour vision. The page to watch a flight has the same anchors
// (watch/src/ramp.js).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>

namespace programs {

/// Red, green and blue at ten even steps from least to most, straight lines between them.
inline constexpr std::array<std::array<int, 3>, 10> viridis = {{{68, 1, 84},
                                                                {72, 40, 120},
                                                                {62, 74, 137},
                                                                {49, 104, 142},
                                                                {38, 130, 142},
                                                                {31, 158, 137},
                                                                {53, 183, 121},
                                                                {109, 205, 89},
                                                                {180, 222, 44},
                                                                {253, 231, 37}}};

/// "#rrggbb" at a share of the range, 0 to 1.
inline std::string viridis_colour(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * (viridis.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), viridis.size() - 2);
  std::array<unsigned, 3> colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double low = viridis[i][c], high = viridis[i + 1][c];
    colour[c] = static_cast<unsigned>(std::lround(low + (place - static_cast<double>(i)) * (high - low)));
  }
  char text[16];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", colour[0], colour[1], colour[2]);
  return text;
}

/// The colour of one of `steps` equal parts of the range: the ends of viridis are the first and the last.
inline std::string viridis_step(int step, int steps) { return viridis_colour(steps > 1 ? step / (steps - 1.0) : 0); }

}  // namespace programs
