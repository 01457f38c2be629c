// SPDX-License-Identifier: MIT
// May a model fly, by how it flew in the simulator (command_line/flight_verdict.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/flight_verdict.hpp"
#include "command_line/in_words.hpp"
#include "flight/loop_figures.hpp"
#include "pinnquad/io/file_error.hpp"
#include "training/closed_loop.hpp"

namespace programs {

/// The verdict of `loop --json`, from flights of the model, the analytic inverse, and that one without jerk.
inline FlightVerdict loop_verdict(const nlohmann::json& report) {
  const nlohmann::json& model = report["model"];
  const auto centimetres = [](const nlohmann::json& who) { return 100 * who["rmse_m"].get<double>(); };
  const double own = centimetres(model), formula = centimetres(report["analytic_inverse"]),
               without_jerk = centimetres(report["without_jerk"]), answered = model["answered_share"];
  const std::string path = pinnquad::printable(report["path"].get<std::string>());
  const std::string compared = in_words(
      "%.1f cm off the path (analytic inverse %.1f cm, without the path's jerk %.1f cm)", own, formula, without_jerk);
  FlightVerdict verdict(compared);
  if (lost_vehicle(report)) {
    verdict.refuse(in_words("loses the vehicle (%.1f m off)", model["largest_error_m"].get<double>()), livelier_flight);
  }
  if (!(answered > 0)) {
    verdict.refuse("answers nothing on this trajectory", "train on flights as fast as this trajectory");
  }
  constexpr double least_cm = 1;  // a path that hardly bends needs no model: what is nearer refuses none
  if (own > least_cm && own > without_jerk && own > slack_of_loops * formula) verdict.refuse(compared, livelier_flight);
  if (answered < 0.99) {
    verdict.care(in_words("the model answered %.0f %% of the path, the analytic inverse flew the rest", 100 * answered),
                 "train on flights as fast as this trajectory");
  }
  verdict.then("pinnquad loop " + path + " --controllers adaptive,indi --conditions calm,payload");
  return verdict;
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

/// The verdict of controllers side by side: by those that fly the model.
inline FlightVerdict controllers_verdict(const std::vector<LoopSpread>& spreads, std::size_t conditions) {
  FlightVerdict verdict(spreads[best_first(spreads, conditions).front()].controller + " has the least error");
  for (const LoopSpread& each : spreads) {
    const bool by_model = each.controller.find("structured") == 0 || each.controller == "adaptive";
    if (!by_model || each.lost == 0) continue;
    const std::string times = each.flights() == 1 ? "" : in_words(" in %zu of %zu flights", each.lost, each.flights());
    verdict.refuse(each.controller + " loses the vehicle under " + each.condition + times, livelier_flight);
  }
  verdict.then("the bench, propellers off (docs/in_flight.md)");
  return verdict;
}

}  // namespace programs
