// SPDX-License-Identifier: MIT
// A quantile of figures, as tables of flights state them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace programs {

/// The value below which a share of all lie, linear between two; NaN of none.
inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace programs
