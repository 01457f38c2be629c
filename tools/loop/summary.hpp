// SPDX-License-Identifier: MIT
// What a campaign's rows come to: errors by controller and condition, with intervals.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "pinnquad/core/random.hpp"

namespace programs {

/// Geometric mean of errors, and the 95 % interval of it by bootstrap over the flights.
struct LoopMean {
  double rmse_cm = 0, lower_cm = 0, upper_cm = 0;
  int flights = 0, crashed = 0;
};

/// Of the rows of one controller, condition and gains; a crashed flight counts as crashed, and is not in the mean.
inline LoopMean loop_mean(const nlohmann::json& rows, const std::string& controller, const std::string& condition,
                          const std::string& gains) {
  LoopMean mean;
  std::vector<double> logs;
  for (const nlohmann::json& row : rows) {
    if (row["controller"] != controller || row["gains"] != gains || row["condition"] != condition) continue;
    ++mean.flights;
    if (row["crashed"].get<bool>()) {
      ++mean.crashed;
    } else {
      logs.push_back(std::log(std::max(1e-9, row["rmse_cm"].get<double>())));
    }
  }
  if (logs.empty()) return mean;
  double sum = 0;
  for (const double each : logs) sum += each;
  const double count = static_cast<double>(logs.size());
  mean.rmse_cm = std::exp(sum / count);
  constexpr int draws = 1000;
  std::mt19937_64 engine(1);
  std::vector<double> means;
  for (int draw = 0; draw < draws; ++draw) {
    double drawn = 0;
    for (std::size_t i = 0; i < logs.size(); ++i) drawn += logs[pinnquad::uniform_index(engine, logs.size())];
    means.push_back(std::exp(drawn / count));
  }
  std::sort(means.begin(), means.end());
  mean.lower_cm = means[draws / 40];
  mean.upper_cm = means[draws - 1 - draws / 40];
  return mean;
}

/// A table of each set of gains on the terminal: a line per controller, a column per condition.
inline void print_loop_tables(const nlohmann::json& result, const std::vector<std::string>& controllers,
                              const std::vector<std::string>& conditions, const std::vector<std::string>& gains) {
  for (const std::string& set : gains) {
    std::printf("%s gains: RMSE of the position in cm, geometric mean over trajectories and seeds\n  %-18s",
                set == "equal" ? "Equal" : "Tuned", "");
    for (const std::string& condition : conditions) std::printf(" %15s", condition.c_str());
    std::printf("\n");
    for (const std::string& controller : controllers) {
      std::printf("  %-18s", controller.c_str());
      for (const std::string& condition : conditions) {
        const LoopMean mean = loop_mean(result["rows"], controller, condition, set);
        char text[48];
        if (mean.crashed == mean.flights) {
          std::snprintf(text, sizeof text, "lost");
        } else if (mean.crashed > 0) {
          std::snprintf(text, sizeof text, "%.2f (%d lost)", mean.rmse_cm, mean.crashed);
        } else {
          std::snprintf(text, sizeof text, "%.2f", mean.rmse_cm);
        }
        std::printf(" %15s", text);
      }
      std::printf("\n");
    }
  }
}

}  // namespace programs
