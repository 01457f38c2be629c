// SPDX-License-Identifier: MIT
// An airframe as a command is given it: by the name of one that the program knows, or by its file.
#pragma once

#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>

#include "airframe/file.hpp"
#include "airframe/names.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"

namespace programs {

/// The refusal of a name that is none.
inline std::invalid_argument no_airframe(const std::string& name) {
  return std::invalid_argument("no airframe named '" + name + "'; known: " + airframe_names() +
                               ", or a file whose name ends in .toml");
}

/// The airframe of that name or file. Throws InputError (the file) and std::invalid_argument (no such name), one line.
inline NamedAirframe chosen_airframe(const std::string& name_or_file) {
  if (is_airframe_file(name_or_file)) return read_airframe_file(name_or_file);
  std::optional<NamedAirframe> airframe;
  with_airframe(name_or_file, [&airframe](auto tag) {
    using Vehicle = typename decltype(tag)::type;
    airframe = NamedAirframe{Vehicle::name, pinnquad::airframe_value<Vehicle, double>()};
  });
  if (!airframe) throw no_airframe(name_or_file);
  return *airframe;
}

/// The airframes that the program knows, on standard output.
inline void list_airframes() {
  each_airframe([](auto tag) {
    using Vehicle = typename decltype(tag)::type;
    constexpr pinnquad::Airframe<double> airframe = pinnquad::airframe_value<Vehicle, double>();
    std::printf("%-16s %6.3f kg, rotors up to %5.0f rpm, thrust-to-weight %.3f\n%18s%s\n", Vehicle::name,
                airframe.mass_kg, 60 * airframe.max_rotor_speed_rev_s, airframe.thrust_to_weight(), "",
                airframe_source(tag));
  });
}

}  // namespace programs
