// SPDX-License-Identifier: MIT
// Sums over a campaign's rows: errors by controller and condition, and their ratios to those of others, with
// intervals.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "loop/controlled_loop.hpp"
#include "pinnquad/core/random.hpp"

namespace study {

/// Controllers that the others are compared with.
inline constexpr std::array<const char*, 2> loop_baselines = {"pid", "indi"};

namespace detail {

/// Mean of logarithms as a geometric mean, with the 95 % interval by bootstrap.
inline nlohmann::json geometric_mean(const std::vector<double>& logs) {
  if (logs.empty()) return nullptr;
  const double count = static_cast<double>(logs.size());
  double sum = 0;
  for (const double each : logs) sum += each;
  constexpr std::size_t draws = 1000;
  std::mt19937_64 engine(1);
  std::vector<double> means;
  for (std::size_t draw = 0; draw < draws; ++draw) {
    double drawn = 0;
    for (std::size_t i = 0; i < logs.size(); ++i) drawn += logs[pinnquad::uniform_index(engine, logs.size())];
    means.push_back(std::exp(drawn / count));
  }
  std::sort(means.begin(), means.end());
  return {{"mean", std::exp(sum / count)}, {"lower", means[draws / 40]}, {"upper", means[draws - 1 - draws / 40]}};
}

/// "0.42", or "lost".
inline std::string loop_cell(const nlohmann::json& figures) {
  if (figures["rmse_cm"].is_null()) return "lost";
  char text[64];
  std::snprintf(text, sizeof text, "%.2f", figures["rmse_cm"]["mean"].get<double>());
  const int crashed = figures["crashed"];
  return crashed > 0 ? text + (" (" + std::to_string(crashed) + " lost)") : text;
}

}  // namespace detail

/// For each set of gains, controller and condition the error over trajectories and seeds, and its ratio to each
/// baseline's on the same flights. A crashed flight counts as one, and is in no mean.
inline nlohmann::json loop_summary(const nlohmann::json& rows) {
  std::map<std::string, double> errors;  // of flights that came back, by all that names them
  std::vector<std::array<std::string, 3>> order;
  std::map<std::array<std::string, 3>, std::vector<const nlohmann::json*>> flown;
  const auto flight = [](const nlohmann::json& row, const std::string& controller) {
    return controller + ' ' + row["gains"].get<std::string>() + ' ' + row["condition"].get<std::string>() + ' ' +
           row["trajectory"].get<std::string>() + ' ' + std::to_string(row["seed"].get<int>());
  };
  for (const nlohmann::json& row : rows) {
    if (!row["crashed"].get<bool>()) {
      errors[flight(row, row["controller"])] = std::max(1e-9, row["rmse_cm"].get<double>());
    }
    const std::array<std::string, 3> entry = {row["gains"], row["controller"], row["condition"]};
    if (flown.count(entry) == 0) order.push_back(entry);
    flown[entry].push_back(&row);
  }
  nlohmann::json summary = nlohmann::json::array();
  for (const auto& entry : order) {
    const auto& [gains, controller, condition] = entry;
    std::vector<double> logs;
    std::array<std::vector<double>, loop_baselines.size()> ratios;
    for (const nlohmann::json* row : flown[entry]) {
      const auto own = errors.find(flight(*row, controller));
      if (own == errors.end()) continue;
      logs.push_back(std::log(own->second));
      for (std::size_t i = 0; i < ratios.size(); ++i) {
        const auto base = errors.find(flight(*row, loop_baselines[i]));
        if (base != errors.end()) ratios[i].push_back(std::log(own->second / base->second));
      }
    }
    nlohmann::json figures = {{"gains", gains},
                              {"controller", controller},
                              {"condition", condition},
                              {"flights", flown[entry].size()},
                              {"crashed", flown[entry].size() - logs.size()},
                              {"rmse_cm", detail::geometric_mean(logs)}};
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      figures[std::string("over_") + loop_baselines[i]] = detail::geometric_mean(ratios[i]);
    }
    summary.push_back(figures);
  }
  return summary;
}

/// A table of each set of gains on the terminal: a line per controller, a column per condition.
inline void print_loop_tables(const nlohmann::json& result) {
  std::string gains, controller;
  std::vector<std::string> conditions;
  for (const nlohmann::json& each : result["summary"]) {
    if (std::find(conditions.begin(), conditions.end(), each["condition"]) == conditions.end()) {
      conditions.push_back(each["condition"]);
    }
  }
  std::map<std::string, std::string> lines;
  std::vector<std::string> order;
  const auto finish = [&] {
    for (const std::string& name : order) std::printf("  %-18s%s\n", name.c_str(), lines[name].c_str());
    order.clear();
    lines.clear();
  };
  for (const nlohmann::json& each : result["summary"]) {
    if (each["gains"] != gains) {
      finish();
      gains = each["gains"];
      std::printf("%s gains: RMSE of the position in cm, geometric mean over trajectories and seeds\n  %-18s",
                  gains == "equal" ? "Equal" : "Tuned", "");
      for (const std::string& condition : conditions) std::printf(" %15s", condition.c_str());
      std::printf("\n");
    }
    const std::string name = each["controller"];
    if (lines.count(name) == 0) order.push_back(name);
    char text[48];
    std::snprintf(text, sizeof text, " %15s", detail::loop_cell(each).c_str());
    lines[name] += text;
  }
  finish();
  for (const std::string& line : programs::bias_warnings(result["rows"])) std::printf("warning: %s\n", line.c_str());
}

}  // namespace study
