// SPDX-License-Identifier: MIT
// The battery of a simulated vehicle, as its texts say it, and the loop in which a model reads its voltage.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_line/parse_decimal.hpp"
#include "pinnquad/aero/battery.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/features/extra_columns.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/simulation/tracking.hpp"

namespace programs {

struct BatteryOptions {
  std::string pack;  ///< empty: none
  double charge_percent = 100;
};

/// None where none is asked for. Throws std::invalid_argument, one line.
inline std::optional<pinnquad::Battery> battery_of(const BatteryOptions& options) {
  if (options.pack.empty()) return {};
  const std::size_t times = options.pack.find('x');
  double capacity_mAh = 0;
  int cells = 0;
  if (times == std::string::npos || !parse_decimal(options.pack.substr(0, times), 1, 14, cells) ||
      !parse_decimal(options.pack.substr(times + 1), 10.0, 1e6, capacity_mAh)) {
    throw std::invalid_argument("--battery: expected CELLSxMAH, as 3x2200, of 1 to 14 cells, found '" +
                                pinnquad::printable(options.pack) + "'");
  }
  pinnquad::Battery battery;
  battery.cells = cells;
  battery.capacity_Ah = capacity_mAh / 1000;
  battery.start_charge = options.charge_percent / 100;
  return battery;
}

/// The place among a model's columns that the battery's voltage takes; null where the model does not ask for it.
inline double* voltage_among(const pinnquad::BlockModel& model, std::vector<double>& columns) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (model.columns()[i].name == pinnquad::BatteryVoltage::name) return &columns[i];
  }
  return nullptr;
}

/// A vehicle that flies as it is modelled. Each time that it is seen, its voltage goes where the model reads it.
template <class Vehicle>
struct BatteryWorld : pinnquad::ExactWorld<Vehicle> {
  double* voltage_V = nullptr;  ///< may be null

  const pinnquad::State<double>& sense(const pinnquad::VehicleState<double>& state) const noexcept {
    if (voltage_V != nullptr) *voltage_V = this->vehicle.surroundings(state).battery.voltage_V;
    return state.body;
  }
};

}  // namespace programs
