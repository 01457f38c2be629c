// SPDX-License-Identifier: MIT
// The airframes that the program knows by name, and where their values are from.
#pragma once

#include "logs/airframe_names.hpp"

namespace programs {

using pinnquad::logs::airframe_names;
using pinnquad::logs::AirframeTag;
using pinnquad::logs::each_airframe;
using pinnquad::logs::with_airframe;

/// Where an airframe's values are from, in one line; its header has the source of each value.
constexpr const char* airframe_source(AirframeTag<pinnquad::PaperQuadrotor> /*tag*/) {
  return "Table 1 of the paper; rotor speed limit ours (hovers at u = 0.50); lag and drag of its simulator";
}
constexpr const char* airframe_source(AirframeTag<pinnquad::ReferenceQuadrotor10> /*tag*/) {
  return "the paper's simulator at 1 kg, as its running program prints them";
}
constexpr const char* airframe_source(AirframeTag<pinnquad::ReferenceQuadrotor15> /*tag*/) {
  return "the paper's simulator at 1.5 kg, as its running program prints them";
}
constexpr const char* airframe_source(AirframeTag<pinnquad::Crazyflie> /*tag*/) {
  return "Bitcraze's data sheet; Landry 2015, Luis and Le Ny 2016, Foerster 2015, Panerati et al. 2021";
}
constexpr const char* airframe_source(AirframeTag<pinnquad::Racer5Inch> /*tag*/) {
  return "Song et al. 2020 (Flightmare), Foehn et al. 2022 (Agilicious)";
}
constexpr const char* airframe_source(AirframeTag<pinnquad::Px4Sih> /*tag*/) {
  return "the quadrotor of PX4's simulation in hardware, default parameters; its damping is linear";
}
constexpr const char* airframe_source(AirframeTag<pinnquad::LightQuadrotor> /*tag*/) {
  return "the paper's rotors and drag, the reference simulator's inertia at 1 kg, rotor lag 20 ms; flies harder";
}

}  // namespace programs
