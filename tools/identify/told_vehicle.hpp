// SPDX-License-Identifier: MIT
// All that flights tell of their vehicle, as `pinnquad identify` and Python's identify() give it: numbers, airframe,
// what was assumed, and the text of the airframe's file.
#pragma once

#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "airframe/toml_writer.hpp"
#include "command_line/interrupt.hpp"
#include "identify/identified_numbers.hpp"
#include "identify/identified_vehicle.hpp"
#include "logs/vehicle_check.hpp"

namespace programs {

/// The caller's word on the vehicle, beside its flights.
struct SaidOfVehicle {
  std::optional<NamedAirframe> airframe;  ///< mass, arms, motor order and propeller; none: those of the mapping
  std::optional<double> mass_kg, arm_m;   ///< in place of the airframe's; of each rotor along x and y
  std::optional<double> thrust_curve;     ///< in place of the airframe's
  bool fit_thrust_curve = false;
  std::string mass_option, arm_option;  ///< how the caller calls them
};

struct ToldVehicle {
  pinnquad::Identification found;
  std::vector<IdentifiedNumber> numbers;
  std::optional<pinnquad::Airframe<double>> airframe;
  std::vector<std::string> assumed;  ///< in the airframe, and not of the flights
  std::string why_not;               ///< without an airframe: one line, with the file
};

namespace detail {

inline NamedAirframe like_of(const SaidOfVehicle& said, const pinnquad::logs::ImportedDataset& dataset) {
  NamedAirframe like = said.airframe ? *said.airframe : airframe_of(dataset);
  if (said.mass_kg) like.value.mass_kg = *said.mass_kg;
  if (said.arm_m) {
    for (pinnquad::RotorMount<double>& rotor : like.value.rotors) {
      rotor.x_m = std::copysign(*said.arm_m, rotor.x_m);
      rotor.y_m = std::copysign(*said.arm_m, rotor.y_m);
    }
  }
  return like;
}

}  // namespace detail

/// Adds to the dataset's warnings unless it is `checked`, as logs are where they are read. Throws InputError and
/// std::invalid_argument, one line, for flights that no vehicle can be identified from.
inline ToldVehicle told_vehicle(pinnquad::logs::ImportedDataset& dataset, const SaidOfVehicle& said, bool checked) {
  const NamedAirframe like = detail::like_of(said, dataset);
  pinnquad::IdentificationSettings settings;
  settings.thrust_curve = said.thrust_curve.value_or(like.value.rotors[0].thrust_curve);
  settings.fit_thrust_curve = said.fit_thrust_curve;
  const IdentifiedVehicle vehicle = identified_vehicle(dataset, like.value, settings);
  stop_if_interrupted();
  if (!checked) pinnquad::logs::check_vehicle(dataset, like.value, false);
  pinnquad::logs::require_one_vehicle(dataset);
  const std::string unlike = unlike_axes_in_words(vehicle.found);
  if (!unlike.empty()) dataset.warnings.push_back(unlike);
  ToldVehicle told;
  told.found = vehicle.found;
  told.numbers = identified_numbers(vehicle.found);
  if (!vehicle.airframe) {
    told.why_not = dataset.sources.front() + ": " + vehicle.why_not;
    for (const std::string& warning : dataset.warnings) {
      if (warning.find(": columns u1 to u4: ") != std::string::npos) told.why_not += "; " + warning;
    }
    return told;
  }
  told.airframe = vehicle.airframe->value;
  told.assumed =
      assumptions(like, *vehicle.airframe, said.mass_kg ? said.mass_option : "", said.arm_m ? said.arm_option : "");
  return told;
}

/// The airframe file of a vehicle that has an airframe, its numbers and what was assumed as comments.
inline std::string vehicle_toml(const ToldVehicle& vehicle, const std::string& name) {
  std::ostringstream text;
  for (const std::string& one : vehicle.assumed) text << "# not of the flights: " << one << "\n";
  for (const IdentifiedNumber& number : vehicle.numbers) {
    text << "# " << number.words << " " << pinnquad::number_text(number.estimate.value) << " " << number.unit
         << ", 95 % " << interval_text(number.estimate) << "\n";
  }
  text << airframe_toml({name, *vehicle.airframe});
  return text.str();
}

}  // namespace programs
