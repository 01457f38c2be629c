// SPDX-License-Identifier: MIT
// Closed-loop flights of many seeds, by controller and condition.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

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

/// Rows of one controller under one condition, of all seeds: how many lost the vehicle, and the others' errors.
struct LoopSpread {
  std::string controller, condition;
  std::size_t lost = 0;
  std::vector<double> rmse_cm;

  std::size_t flights() const { return lost + rmse_cm.size(); }
};

/// Rows are by controller, then by condition, then by seed.
inline std::vector<LoopSpread> loop_spreads(const std::vector<nlohmann::json>& rows) {
  std::vector<LoopSpread> spreads;
  for (const nlohmann::json& row : rows) {
    const std::string controller = row["controller"], condition = row["condition"];
    if (spreads.empty() || spreads.back().controller != controller || spreads.back().condition != condition) {
      spreads.push_back({controller, condition, 0, {}});
    }
    if (row["crashed"].get<bool>()) {
      ++spreads.back().lost;
    } else {
      spreads.back().rmse_cm.push_back(row["rmse_cm"]);
    }
  }
  return spreads;
}

/// The first spread of each controller: the one that loses fewest vehicles first, then by the geometric mean of the
/// others' errors. Each controller has as many as there are conditions.
inline std::vector<std::size_t> best_first(const std::vector<LoopSpread>& spreads, std::size_t conditions) {
  const auto lost_and_error = [&](std::size_t begin) {
    std::size_t lost = 0, kept = 0;
    double sum = 0;
    for (std::size_t i = begin; i < begin + conditions; ++i) {
      lost += spreads[i].lost;
      kept += spreads[i].rmse_cm.size();
      for (const double error : spreads[i].rmse_cm) sum += std::log(error);
    }
    return std::pair(lost, kept > 0 ? sum / static_cast<double>(kept) : 0.0);
  };
  std::vector<std::size_t> order;
  for (std::size_t begin = 0; begin < spreads.size(); begin += conditions) order.push_back(begin);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return lost_and_error(a) < lost_and_error(b); });
  return order;
}

}  // namespace programs
