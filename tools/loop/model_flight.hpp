// SPDX-License-Identifier: MIT
// A model flown as feed-forward, and what is said of it: `loop MODEL`.
#pragma once

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "airframe/choice.hpp"
#include "command_line/held_columns.hpp"
#include "command_line/interrupt.hpp"
#include "flight/battery_choice.hpp"
#include "flight/block_loop.hpp"
#include "model/model_evidence.hpp"

namespace programs {

/// The vehicle that flies a model in a loop, and what the model sees of it beside the motion.
struct LoopVehicle {
  std::vector<double> columns{};  ///< in the model's order
  std::optional<pinnquad::Battery> battery{};
  NamedAirframe airframe{};
};

/// `columns`: NAME=VALUE; `airframe`: none: the model's. Throws std::invalid_argument, one line, for what can't fly.
inline LoopVehicle loop_vehicle(const pinnquad::BlockModel& model, const std::vector<std::string>& columns,
                                const BatteryOptions& battery, const std::optional<NamedAirframe>& airframe) {
  if (model.features().window().latest_s > 0) {
    throw std::invalid_argument(model.path() + ": its window looks ahead of the present, which no loop can");
  }
  LoopVehicle result{held_columns(range_of(model).columns(), columns), battery_of(battery),
                     airframe.value_or(NamedAirframe{model.airframe_name(), model.airframe()})};
  const std::string held = std::string(pinnquad::BatteryVoltage::name) + "=";
  const bool is_held = std::any_of(columns.begin(), columns.end(),
                                   [&held](const std::string& column) { return column.rfind(held, 0) == 0; });
  if (is_held && result.battery)
    throw std::invalid_argument("--column " + held + ": the vehicle's --battery has a voltage");
  if (!is_held && !result.battery && voltage_among(model, result.columns) != nullptr) {
    throw std::invalid_argument(model.path() +
                                ": asks for battery_voltage, which the vehicle does not have: give it one " +
                                "(--battery 3x2200), or hold the column (--column battery_voltage=11.5)");
  }
  if (airframe && motor_torque_signs(airframe->value) != motor_torque_signs(model.airframe())) {
    throw std::invalid_argument("--airframe: the motors of " + pinnquad::printable(airframe->name) +
                                " stand or turn otherwise than those of " + model.airframe_name() +
                                ", which the model commands");
  }
  return result;
}

/// Ticks that the model did not answer, by the reason.
inline nlohmann::json declined(const pinnquad::FallbackCount& count) {
  nlohmann::json by_status = nlohmann::json::object();
  for (int i = 0; i < pinnquad::status_count; ++i) {
    const auto status = static_cast<pinnquad::Status>(i);
    if (count.of(status) == 0 || has_output(status)) continue;
    by_status[to_string(status)] = count.of(status);
  }
  return by_status;
}

struct ModelFlight {
  LoopFlights flights;
  FlightVerdict verdict;
  nlohmann::json report{};  ///< the answer of `loop --json`
};

/// `guard`: envelope or none. Throws as fly_loop(), and Interrupted.
inline ModelFlight fly_model(const pinnquad::BlockModel& model, const LoopVehicle& vehicle,
                             const std::string& trajectory, const std::string& guard) {
  const LoopFlights flights =
      fly_loop(model, {trajectory, vehicle.airframe.value, guard == "envelope", vehicle.columns, vehicle.battery});
  stop_if_interrupted();
  ModelEvidence evidence = evidence_of(model, false);
  evidence.flown = flight_evidence(flights, trajectory);
  ModelFlight result{flights, model_verdict(evidence)};
  nlohmann::json& report = result.report = {{"path", model.path()},
                                            {"verdict", verdict_json(result.verdict)},
                                            {"answer", model.answer()},
                                            {"airframe", vehicle.airframe.name},
                                            {"guard", guard},
                                            {"columns", nlohmann::json::object()},
                                            {"trajectory", trajectory},
                                            {"half_length_m", flights.half_length_m},
                                            {"period_s", flights.period_s},
                                            {"altitude_m", {flights.lowest_m, flights.highest_m}},
                                            {"model", loop_figures(flights.model)},
                                            {"analytic_inverse", loop_figures(flights.analytic_inverse)},
                                            {"without_jerk", loop_figures(flights.without_jerk)}};
  for (std::size_t i = 0; i < vehicle.columns.size(); ++i) {
    report["columns"][model.columns()[i].name] = vehicle.columns[i];
  }
  if (flights.last_voltage_V > 0) report["columns"][pinnquad::BatteryVoltage::name] = flights.last_voltage_V;
  report["model"]["asked"] = flights.model.fallback.asked;
  report["model"]["answered_share"] = answered_share(flights.model.fallback);
  report["model"]["declined"] = declined(flights.model.fallback);
  return result;
}

}  // namespace programs
