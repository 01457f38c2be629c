// SPDX-License-Identifier: MIT
// A program's edge: from an airframe's name on the command line to its type. Inside the library composition is by type.
#pragma once

#include <string>
#include <type_traits>

#include "pinnquad/dynamics/airframes/crazyflie.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/px4_sih.hpp"
#include "pinnquad/dynamics/airframes/racer_5_inch.hpp"
#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"

namespace programs {

/// Stands for an airframe type in an argument list:
/// `[](auto tag) { using Vehicle = typename decltype(tag)::type; ... }`
template <class Vehicle>
struct AirframeTag {
  using type = Vehicle;
};

template <class... Vehicles>
struct AirframeList {};

/// The airframes that programs know by name; a new one is added here.
using Airframes = AirframeList<pinnquad::PaperQuadrotor, pinnquad::ReferenceQuadrotor10, pinnquad::ReferenceQuadrotor15,
                               pinnquad::Crazyflie, pinnquad::Racer5Inch, pinnquad::Px4Sih>;

template <class Function, class... Vehicles>
void each_airframe(const Function& function, AirframeList<Vehicles...> /*list*/) {
  (function(AirframeTag<Vehicles>{}), ...);
}

/// Calls `function(AirframeTag<Vehicle>{})` for each airframe in turn.
template <class Function>
void each_airframe(const Function& function) {
  each_airframe(function, Airframes{});
}

/// Calls `function(AirframeTag<Vehicle>{})` for the airframe of that name. False if there is none.
template <class Function>
bool with_airframe(const std::string& name, const Function& function) {
  bool found = false;
  each_airframe([&](auto tag) {
    if (!found && name == decltype(tag)::type::name) {
      found = true;
      function(tag);
    }
  });
  return found;
}

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

/// "paper_quadrotor, reference_1.0kg, ...": for messages and help.
inline std::string airframe_names() {
  std::string names;
  each_airframe([&names](auto tag) {
    if (!names.empty()) names += ", ";
    names += decltype(tag)::type::name;
  });
  return names;
}

}  // namespace programs
