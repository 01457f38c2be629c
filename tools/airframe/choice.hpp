// SPDX-License-Identifier: MIT
// An airframe as a command is given it: by the name of one that the program knows, or by its file.
#pragma once

#include <cstdio>

#include "airframe/names.hpp"
#include "command_line/in_columns.hpp"
#include "logs/airframe_file.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"

namespace programs {

using pinnquad::logs::chosen_airframe;
using pinnquad::logs::is_airframe_file;
using pinnquad::logs::NamedAirframe;
using pinnquad::logs::no_airframe;
using pinnquad::logs::read_airframe_file;

/// The airframes that the program knows, on standard output.
inline void list_airframes() {
  each_airframe([](auto tag) {
    using Vehicle = typename decltype(tag)::type;
    constexpr pinnquad::Airframe<double> airframe = pinnquad::airframe_value<Vehicle, double>();
    std::printf("%-16s %6.3f kg, rotors up to %5.0f rpm, thrust-to-weight %.3f\n", Vehicle::name, airframe.mass_kg,
                60 * airframe.max_rotor_speed_rev_s, airframe.thrust_to_weight());
    print_line(airframe_source(tag), 18);
  });
}

}  // namespace programs
