// SPDX-License-Identifier: MIT
// A model of recorded flights in a closed loop on the airframe that was given, as `pinnquad loop` flies it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "flight/battery_choice.hpp"
#include "flight/block_loop.hpp"
#include "pinnquad/aero/battery.hpp"
#include "pinnquad/data/plausibility.hpp"
#include "pinnquad/data/row_set.hpp"
#include "training/model_verdict.hpp"

namespace programs {

/// The median of each column that the model asks for, in the first training flight: what the loop holds it at.
inline std::vector<double> usual_columns(const pinnquad::BlockModel& model, const pinnquad::RowSet& training) {
  std::vector<double> held;
  for (const pinnquad::ColumnName& column : model.columns()) {
    const pinnquad::Flight& flight = *training.pieces().front().flight;
    held.push_back(pinnquad::detail::median_of(flight.column(column.name)->values));
  }
  return held;
}

/// A battery as the flights tell it, for a model that asks for its voltage: so many cells that their median voltage is
/// 3.8 V each, of ten minutes of hover, so charged that it hovers at that voltage. The airframe's thrust is as it says
/// at the voltage at which the flights' thrust was that.
inline std::optional<pinnquad::Battery> battery_of_flights(const pinnquad::BlockModel& model,
                                                           const pinnquad::RowSet& training,
                                                           const pinnquad::Airframe<double>& airframe) {
  using namespace pinnquad;
  std::vector<double> columns = usual_columns(model, training);
  const double* const voltage_V = voltage_among(model, columns);
  if (voltage_V == nullptr) return {};
  const Rotors<double> rotors(airframe);
  std::vector<double> rated_V;  // of a row, by the share of the thrust that it has at its voltage
  for (const FlightRows& piece : training.pieces()) {
    const std::vector<double>& volts = piece.flight->column(BatteryVoltage::name)->values;
    for (std::size_t row = piece.rows.begin; row < piece.rows.end; ++row) {
      const Sample& sample = (*piece.flight)[row];
      const Vector3<double> force = SpecificForce::of(sample_inputs<MotionInputs<double>>(sample));
      const double commanded_N = -rotors.wrench(sample.commands, 1).force_N[2];
      const double share = -airframe.mass_kg * force[2] / commanded_N;
      if (share > 0.5 && share < 2) rated_V.push_back(volts[row] / std::sqrt(share));
    }
  }
  Battery battery;
  battery.cells = std::max(1.0, std::round(*voltage_V / 3.8));
  if (!rated_V.empty()) battery.rated_V = pinnquad::detail::median_of(std::move(rated_V));
  const double hover_A = battery.bound(airframe).full_current_A * std::pow(airframe.thrust_to_weight(), -1.5);
  battery.capacity_Ah = std::max(hover_A / 6, 0.01);
  const double rest_V = *voltage_V / battery.cells + hover_A * battery.cell_resistance_ohm_Ah / battery.capacity_Ah;
  double least = 0, most = 1;
  for (int i = 0; i < 30; ++i) {
    battery.start_charge = (least + most) / 2;
    (Battery::cell_at_rest_V(battery.start_charge) < rest_V ? least : most) = battery.start_charge;
  }
  return battery;
}

/// Whether there is nothing to compare with: the analytic inverse loses the vehicle, or flies worse than without jerk.
inline bool analytic_inverse_fails(const nlohmann::json& flown) {
  return lost_vehicle(flown, "formula") ||
         flown["formula"]["rmse_m"] > slack_of_loops * flown["without_jerk"]["rmse_m"].get<double>();
}

/// The flight, for report.json, and its traces for the page; `why_not` alone where there was none.
inline nlohmann::json fly_given(const pinnquad::BlockModel& model, const pinnquad::RowSet& training,
                                const pinnquad::Airframe<double>& airframe, FlownTraces& traces) {
  try {
    LoopFlights flown = fly_loop(model, {loop_trajectories.front(), airframe, true, usual_columns(model, training),
                                         battery_of_flights(model, training, airframe)});
    nlohmann::json result = flight_evidence(flown, loop_trajectories.front());
    if (analytic_inverse_fails(result)) {
      return {{"why_not", "the airframe's own analytic inverse does not fly it"}};
    }
    traces = std::move(flown.traces);
    return result;
  } catch (const std::invalid_argument& refused) {
    return {{"why_not", refused.what()}};
  }
}

}  // namespace programs
