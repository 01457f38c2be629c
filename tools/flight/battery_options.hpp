// SPDX-License-Identifier: MIT
// Options of the battery of a simulated vehicle.
#pragma once

#include "command_line/options.hpp"
#include "flight/battery_choice.hpp"

namespace programs {

inline void add_battery(CLI::App& line, BatteryOptions& options) {
  CLI::Option* const pack =
      line.add_option("--battery", options.pack, "of the vehicle, as 3x2200: three LiPo cells of 2200 mAh")
          ->type_name("CELLSxMAH");
  add_number(line, "--battery-charge", options.charge_percent, 5.0, 100.0, "charge of the battery at the start, %")
      ->needs(pack);
}

}  // namespace programs
