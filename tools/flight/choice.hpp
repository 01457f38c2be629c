// SPDX-License-Identifier: MIT
// A program's edge: from the names of flights and ground effects on the command line to values.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include "command_line/listed.hpp"
#include "pinnquad/simulation/flights.hpp"

namespace programs {

/// Any pilot behind one type: a program then compiles one simulator, not one per pilot.
using AnyPilot = std::function<pinnquad::SetPoint<double>(const pinnquad::State<double>&, double)>;
static_assert(pinnquad::is_pilot<AnyPilot>);

/// A flight of the library as a value: one vehicle and one simulator fly them all.
struct NamedFlight {
  const char* name;
  const char* summary;
  pinnquad::GroundEffectModel ground_effect;  ///< the paper's
  pinnquad::FlightPlan plan;
  /// The flight's own for an airframe.
  pinnquad::GroundEffectModel (*ground_effect_of)(const pinnquad::Airframe<double>& airframe);
  pinnquad::SwitchedQuadrotor (*vehicle)(const pinnquad::Airframe<double>& airframe,
                                         pinnquad::GroundEffectModel ground_effect,
                                         const std::optional<pinnquad::Battery>& battery);
  AnyPilot (*pilot)(const pinnquad::SwitchedQuadrotor& vehicle, std::uint64_t seed,
                    std::optional<double> max_speed_m_s);
};

namespace detail {
template <class PaperFlight>
NamedFlight named_flight() {
  using namespace pinnquad;
  return {PaperFlight::name,
          PaperFlight::summary,
          PaperFlight::ground_effect,
          PaperFlight::plan(),
          [](const Airframe<double>& airframe) {
            if constexpr (PaperFlight::ground_effect == GroundEffectModel::conyers) {
              return PaperFlight::ground_effect_of(airframe);
            }
            return PaperFlight::ground_effect;
          },
          flight_vehicle<PaperFlight>,
          [](const SwitchedQuadrotor& vehicle, std::uint64_t seed, std::optional<double> max_speed_m_s) -> AnyPilot {
            const std::mt19937_64 engine(seed);
            if (max_speed_m_s) return PaperFlight::pilot(vehicle, engine, *max_speed_m_s);
            return PaperFlight::pilot(vehicle, engine);
          }};
}
}  // namespace detail

/// All of them: the paper's three, and the harder one.
inline const std::array<NamedFlight, 4>& flights() {
  static const std::array<NamedFlight, 4> all = {
      detail::named_flight<pinnquad::AgileFlight>(), detail::named_flight<pinnquad::NearGroundFlight>(),
      detail::named_flight<pinnquad::WindyFlight>(), detail::named_flight<pinnquad::HarderFlight>()};
  return all;
}

/// Throws std::invalid_argument, one line, for a name that none has.
inline const NamedFlight& flight_named(const std::string& name) {
  std::string known;
  for (const NamedFlight& flight : flights()) {
    if (name == flight.name) return flight;
    add_to_list(known, flight.name);
  }
  throw std::invalid_argument("no flight named '" + name + "'; known: " + known);
}

inline constexpr std::array<std::pair<const char*, pinnquad::GroundEffectModel>, 3> ground_effects = {{
    {"none", pinnquad::GroundEffectModel::none},
    {"cheeseman-bennett", pinnquad::GroundEffectModel::cheeseman_bennett},
    {"conyers", pinnquad::GroundEffectModel::conyers},
}};

/// Throws std::invalid_argument, one line, for a name that none has.
inline pinnquad::GroundEffectModel ground_effect_named(const std::string& name) {
  std::string names;
  for (const auto& [known, model] : ground_effects) {
    if (name == known) return model;
    add_to_list(names, known);
  }
  throw std::invalid_argument("no ground effect named '" + name + "'; known: " + names);
}

inline const char* name_of(pinnquad::GroundEffectModel model) {
  for (const auto& [name, value] : ground_effects) {
    if (value == model) return name;
  }
  return "?";
}

}  // namespace programs
