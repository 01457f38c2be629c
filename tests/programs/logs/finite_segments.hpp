// SPDX-License-Identifier: MIT
// The stretches of series that a derivative can be taken of.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "pinnquad/data/split.hpp"

namespace pinnquad::test {

/// Runs of at least `minimum_rows` rows without NaN or infinity in any of the series, which are of one length.
inline std::vector<IndexRange> finite_segments(const std::vector<const std::vector<double>*>& series,
                                               std::size_t minimum_rows = 1) {
  std::vector<IndexRange> segments;
  const std::size_t rows = series.empty() ? 0 : series.front()->size();
  IndexRange open;
  for (std::size_t row = 0; row <= rows; ++row) {
    const bool whole = row < rows && std::all_of(series.begin(), series.end(), [row](const std::vector<double>* one) {
                         return std::isfinite((*one)[row]);
                       });
    if (whole) {
      open.end = row + 1;
      continue;
    }
    if (open.end > open.begin && open.size() >= minimum_rows) segments.push_back(open);
    open = {row + 1, row + 1};
  }
  return segments;
}

}  // namespace pinnquad::test
