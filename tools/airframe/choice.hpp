// SPDX-License-Identifier: MIT
// An airframe as a command is given it: by the name of one that the program knows, or by its file.
#pragma once

#include <cstdio>
#include <map>
#include <string>

#include "command_line/in_columns.hpp"
#include "logs/airframe_file.hpp"
#include "logs/airframe_names.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"

namespace programs {

using pinnquad::logs::airframe_names;
using pinnquad::logs::chosen_airframe;
using pinnquad::logs::each_airframe;
using pinnquad::logs::is_airframe_file;
using pinnquad::logs::NamedAirframe;
using pinnquad::logs::no_airframe;
using pinnquad::logs::read_airframe_file;
using pinnquad::logs::with_airframe;

/// The airframes that the program knows, and where their values are from, on standard output; a header has the source
/// of each value.
inline void list_airframes() {
  const std::map<std::string, const char*> sources = {
      {pinnquad::PaperQuadrotor::name,
       "Table 1 of the paper; rotor speed limit ours (hovers at u = 0.50); lag and drag of its simulator"},
      {pinnquad::ReferenceQuadrotor10::name, "the paper's simulator at 1 kg, as its running program prints them"},
      {pinnquad::ReferenceQuadrotor15::name, "the paper's simulator at 1.5 kg, as its running program prints them"},
      {pinnquad::Crazyflie::name,
       "Bitcraze's data sheet; Landry 2015, Luis and Le Ny 2016, Foerster 2015, Panerati et al. 2021"},
      {pinnquad::Racer5Inch::name, "Song et al. 2020 (Flightmare), Foehn et al. 2022 (Agilicious)"},
      {pinnquad::Px4Sih::name,
       "the quadrotor of PX4's simulation in hardware, default parameters; its damping is linear"},
      {pinnquad::LightQuadrotor::name,
       "the paper's rotors and drag, the reference simulator's inertia at 1 kg, rotor lag 20 ms; flies harder"},
  };
  each_airframe([&sources](auto tag) {
    using Vehicle = typename decltype(tag)::type;
    constexpr pinnquad::Airframe<double> airframe = pinnquad::airframe_value<Vehicle, double>();
    std::printf("%-16s %6.3f kg, rotors up to %5.0f rpm, thrust-to-weight %.3f\n", Vehicle::name, airframe.mass_kg,
                60 * airframe.max_rotor_speed_rev_s, airframe.thrust_to_weight());
    print_line(sources.at(Vehicle::name), 18);
  });
}

}  // namespace programs
