// SPDX-License-Identifier: MIT
// From an airframe's name to its type. Inside the library composition is by type.
#pragma once

#include <string>
#include <type_traits>

#include "pinnquad/dynamics/airframes/crazyflie.hpp"
#include "pinnquad/dynamics/airframes/light_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/px4_sih.hpp"
#include "pinnquad/dynamics/airframes/racer_5_inch.hpp"
#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"

namespace pinnquad::logs {

/// Stands for an airframe type in an argument list:
/// `[](auto tag) { using Vehicle = typename decltype(tag)::type; ... }`
template <class Vehicle>
struct AirframeTag {
  using type = Vehicle;
};

template <class... Vehicles>
struct AirframeList {};

/// The airframes that are known by name; a new one is added here.
using Airframes = AirframeList<PaperQuadrotor, ReferenceQuadrotor10, ReferenceQuadrotor15, Crazyflie, Racer5Inch,
                               Px4Sih, LightQuadrotor>;

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

/// "paper_quadrotor, reference_1.0kg, ...": for messages and help.
inline std::string airframe_names() {
  std::string names;
  each_airframe([&names](auto tag) {
    if (!names.empty()) names += ", ";
    names += decltype(tag)::type::name;
  });
  return names;
}

}  // namespace pinnquad::logs
