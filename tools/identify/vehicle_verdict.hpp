// SPDX-License-Identifier: MIT
// May models of these flights fly, as far as the flights identify their vehicle (command_line/flight_verdict.hpp).
#pragma once

#include <string>

#include "command_line/flight_verdict.hpp"
#include "identify/told_vehicle.hpp"
#include "pinnquad/io/file_error.hpp"

namespace programs {

inline FlightVerdict vehicle_verdict(const ToldVehicle& vehicle, const std::string& out) {
  FlightVerdict verdict("the flights determine thrust, roll, pitch, yaw and rotor lag");
  for (const IdentifiedNumber& number : vehicle.numbers) {
    for (const char* key : {"thrust_m_s2", "roll_effectiveness_rad_s2", "pitch_effectiveness_rad_s2",
                            "yaw_effectiveness_rad_s2", "rotor_lag_s"}) {
      if (number.key != key || is_told(number)) continue;
      verdict.care("the flights do not determine " + number.words, "record: " + number.flight);
    }
  }
  if (!vehicle.airframe) {
    const std::string next = verdict.next();
    verdict.refuse("the flights do not identify the vehicle", next.empty() ? livelier_flight : next);
  }
  verdict.then(out.empty() ? "pinnquad identify FLIGHTS --mass KG --arm M --out vehicle.toml"
                           : "pinnquad train FLIGHTS --airframe " + pinnquad::printable(out) + " --out my_model");
  return verdict;
}

}  // namespace programs
