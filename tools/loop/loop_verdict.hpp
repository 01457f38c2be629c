// SPDX-License-Identifier: MIT
// May a model fly, by how it flew in the simulator (command_line/flight_verdict.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
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

/// The first row of each controller, the one with the least errors first; rows are by controller, then by condition.
inline std::vector<std::size_t> best_first(const std::vector<nlohmann::json>& rows, std::size_t conditions) {
  const auto error = [&](std::size_t begin) {
    double sum = 0;
    for (std::size_t i = begin; i < begin + conditions; ++i) {
      if (rows[i]["crashed"].get<bool>()) return std::numeric_limits<double>::infinity();
      sum += std::log(rows[i]["rmse_cm"].get<double>());
    }
    return sum;
  };
  std::vector<std::size_t> order;
  for (std::size_t begin = 0; begin < rows.size(); begin += conditions) order.push_back(begin);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return error(a) < error(b); });
  return order;
}

/// The same of controllers side by side: those that fly the model.
inline FlightVerdict controllers_verdict(const std::vector<nlohmann::json>& rows, std::size_t conditions) {
  const std::vector<std::size_t> order = best_first(rows, conditions);
  FlightVerdict verdict(rows[order.front()]["controller"].get<std::string>() + " has the least error");
  for (const nlohmann::json& row : rows) {
    const std::string controller = row["controller"];
    const bool by_model = controller.find("structured") == 0 || controller == "adaptive";
    if (!by_model || !row["crashed"].get<bool>()) continue;
    verdict.refuse(controller + " loses the vehicle under " + row["condition"].get<std::string>(), livelier_flight);
  }
  verdict.then("the bench, propellers off (docs/in_flight.md)");
  return verdict;
}

}  // namespace programs
