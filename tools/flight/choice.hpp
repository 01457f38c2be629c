// SPDX-License-Identifier: MIT
// A program's edge: from the names of flights and ground effects on the command line to types and values.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>

#include "command_line/listed.hpp"
#include "pinnquad/simulation/flights.hpp"

namespace programs {

/// Stands for a flight type in an argument list: `[](auto tag) { using PaperFlight = typename decltype(tag)::type; }`
template <class PaperFlight>
struct FlightTag {
  using type = PaperFlight;
};

/// Calls `function(FlightTag<PaperFlight>{})` for each flight.
template <class Function>
void each_flight(const Function& function) {
  function(FlightTag<pinnquad::AgileFlight>{});
  function(FlightTag<pinnquad::NearGroundFlight>{});
  function(FlightTag<pinnquad::WindyFlight>{});
  function(FlightTag<pinnquad::HarderFlight>{});
}

/// Calls `function(FlightTag<PaperFlight>{})` for the flight of that name. False if there is none.
template <class Function>
bool with_flight(const std::string& name, const Function& function) {
  bool found = false;
  each_flight([&](auto tag) {
    if (name != decltype(tag)::type::name) return;
    found = true;
    function(tag);
  });
  return found;
}

/// "d1, d2, d3"
inline std::string flight_names() {
  std::string names;
  each_flight([&names](auto tag) { add_to_list(names, decltype(tag)::type::name); });
  return names;
}

inline constexpr std::array<std::pair<const char*, pinnquad::GroundEffectModel>, 3> ground_effects = {{
    {"none", pinnquad::GroundEffectModel::none},
    {"cheeseman-bennett", pinnquad::GroundEffectModel::cheeseman_bennett},
    {"conyers", pinnquad::GroundEffectModel::conyers},
}};

/// The model of that name. False if there is none.
inline bool ground_effect_of(const std::string& name, pinnquad::GroundEffectModel& model) {
  for (const auto& [known, value] : ground_effects) {
    if (name != known) continue;
    model = value;
    return true;
  }
  return false;
}

inline const char* name_of(pinnquad::GroundEffectModel model) {
  for (const auto& [name, value] : ground_effects) {
    if (value == model) return name;
  }
  return "?";
}

/// Any pilot behind one type: a program then compiles one simulator per vehicle, not one per pilot.
using AnyPilot = std::function<pinnquad::SetPoint<double>(const pinnquad::State<double>&, double)>;
static_assert(pinnquad::is_pilot<AnyPilot>);

}  // namespace programs
