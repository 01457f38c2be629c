// SPDX-License-Identifier: MIT
// A program's edge: from an airframe's name on the command line to its type. Inside the library composition is by type.
#pragma once

#include <string>
#include <type_traits>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
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
using Airframes =
    AirframeList<pinnquad::PaperQuadrotor, pinnquad::ReferenceQuadrotor10, pinnquad::ReferenceQuadrotor15>;

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

namespace detail {
template <class Vehicle, class = void>
struct SaysSource : std::false_type {};
template <class Vehicle>
struct SaysSource<Vehicle, std::void_t<decltype(Vehicle::source)>> : std::true_type {};
}  // namespace detail

/// Where an airframe's values are from, in one line.
template <class Vehicle>
constexpr const char* airframe_source() {
  if constexpr (detail::SaysSource<Vehicle>::value) {
    return Vehicle::source;
  } else if constexpr (std::is_same_v<Vehicle, pinnquad::PaperQuadrotor>) {
    return "Table 1 of the paper; rotor speed limit ours (8,500 rpm hovers at u = 0.50); lag, drag: its simulator";
  } else {
    return "the paper's simulator, as its running program prints them";
  }
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
