// SPDX-License-Identifier: MIT
// An input of one's own: a column that the logs have by this name and unit. Flight code includes this file before the
// exported header, which names it.
#pragma once

struct PackTemperature {
  static constexpr const char* name = "pack_temperature";
  static constexpr const char* unit = "degC";
};
