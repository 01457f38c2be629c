// SPDX-License-Identifier: MIT
// The vehicle that models of logs are trained for: the airframe that was given, else the one identified in the flights,
// else what of it is known, with another one's numbers for the rest, named.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/in_words.hpp"
#include "identify/identified_vehicle.hpp"
#include "logs/airframe_doubts.hpp"
#include "logs/command_curve.hpp"
#include "logs/specific_force.hpp"
#include "pinnquad/data/plausibility.hpp"
#include "pinnquad/io/file_error.hpp"
#include "training/certificate_words.hpp"
#include "training/hold_out.hpp"

namespace programs {

struct FlownVehicle {
  NamedAirframe airframe;  ///< of the header, the losses and the comparisons
  bool given = true;
  std::optional<IdentifiedVehicle> asked;  ///< what the flights say; none: they were not asked
  std::vector<std::string> flights;        ///< that were asked
  std::vector<std::string> assumed;        ///< of an identified airframe: not of the flights
  std::vector<std::string> unknown;        ///< of an airframe neither given nor identified: not the vehicle's
  std::vector<std::string> doubts;         ///< of a given one: where the flights contradict it, a line each

  bool identified() const { return asked && asked->airframe; }
  /// False: slopes can't be compared with it.
  bool is_known() const { return given || identified(); }
};

namespace detail {

/// The command that balances weight, of rotors with this specific force at command 1.
inline double hover_command(double curve, double thrust_m_s2) {
  const double fraction = pinnquad::standard_gravity_m_s2<double> / (pinnquad::rotor_count * thrust_m_s2);
  return pinnquad::command_of_fraction(curve, std::min(fraction, 1.0));
}

/// The thrust of a rotor over mass that bears the vehicle: the median of the rows, of which most are near hover.
inline double usual_thrust_m_s2(const pinnquad::Dataset& flights, double curve) {
  std::vector<double> thrusts;
  for (const pinnquad::Flight& flight : flights.flights()) {
    for (const pinnquad::Sample& sample : flight) {
      double fractions = 0;
      for (const double u : sample.commands) fractions += pinnquad::thrust_fraction(curve, u);
      if (fractions > 0) thrusts.push_back(-pinnquad::logs::specific_force_m_s2(sample)[2] / fractions);
    }
  }
  return thrusts.empty() ? 0 : pinnquad::detail::median_of(std::move(thrusts));
}

/// A vehicle that its flights do not identify, by the numbers that they do tell; the rest is that of `like`, and named.
/// Turning that is not told is that of its rotors with the thrust that the flights show, on its moments of inertia.
inline NamedAirframe assumed_airframe(const NamedAirframe& like, pinnquad::Identification found,
                                      const pinnquad::Dataset& flights, std::vector<std::string>& unknown) {
  const std::array<double, 4> own = pinnquad::logs::rotor_effects(like.value);
  const auto complete = [](pinnquad::Estimate& estimate, double instead, bool plausible = true) {
    if (plausible && pinnquad::detail::is_taken(estimate)) return true;
    estimate = {instead, 0};
    return false;
  };
  complete(found.thrust_m_s2, usual_thrust_m_s2(flights, like.value.rotors[0].thrust_curve));
  const bool of_quadrotor = !pinnquad::implausible_number(found, like.value);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double instead = own[1 + axis] * found.thrust_m_s2.value / own[0];
    if (complete(found.effectiveness_rad_s2[axis], instead, of_quadrotor)) continue;
    unknown.push_back(std::string(axis_names[axis]) + " effectiveness");
  }
  if (!complete(found.lag_s, like.value.rotor_time_constant_s, of_quadrotor)) unknown.emplace_back("rotor lag");
  if (!of_quadrotor) {  // one law, fitted together: none of its numbers stands
    found.delay_s = found.rise_s = found.fall_s = found.fall_after_rise_s = {};
    found.gyroscopic = found.imbalance = {};
  }
  const auto made = pinnquad::identified_airframe(found, like.value);
  if (!made) unknown.insert(unknown.begin(), "thrust");
  return {like.name + ", assumed", made ? made->value : like.value};
}

/// A line for the hover command and for each effectiveness of a given airframe that the flights' interval excludes by
/// more than a fifth.
inline std::vector<std::string> contradictions(const pinnquad::Identification& found, const NamedAirframe& given) {
  std::vector<std::string> lines;
  const auto compare = [&](const std::string& what, const char* unit, double own, double low, double high) {
    if (low <= most_undoubted * own && high >= least_undoubted * own) return;
    lines.push_back(what + in_words(" is %.3g to %.3g%s in the flights, %.3g of ", low, high, unit, own) + given.name);
  };
  const std::array<double, 4> own = pinnquad::logs::rotor_effects(given.value);
  const double curve = given.value.rotors[0].thrust_curve;
  const pinnquad::Estimate& thrust = found.thrust_m_s2;
  if (pinnquad::detail::is_taken(thrust)) {
    compare("the hover command", "", hover_command(curve, own[0]), hover_command(curve, thrust.high()),
            hover_command(curve, thrust.low()));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const pinnquad::Estimate& turn = found.effectiveness_rad_s2[axis];
    if (!pinnquad::detail::is_taken(turn)) continue;
    compare(std::string(axis_names[axis]) + " effectiveness", " rad/s^2", own[1 + axis], turn.low(), turn.high());
  }
  return lines;
}

/// The flights that may be asked: all but those that one parting holds out.
inline pinnquad::logs::ImportedDataset not_held_out(const pinnquad::logs::ImportedDataset& dataset,
                                                    const std::vector<std::string>& places,
                                                    const std::vector<Fold>& folds) {
  pinnquad::logs::ImportedDataset left;
  left.lag_removed_s = dataset.lag_removed_s;
  left.airframe = dataset.airframe;
  left.curve = dataset.curve;
  for (std::size_t i = 0; i < dataset.flights.size(); ++i) {
    const pinnquad::Flight& flight = dataset.flights[i];
    const std::vector<std::string>& held = folds.front().held_out;
    if (folds.size() == 1 && std::find(held.begin(), held.end(), flight.name) != held.end()) continue;
    left.flights.add(flight);
    left.sources.push_back(places[i]);
  }
  return left;
}

}  // namespace detail

/// Of logged flights. `given`: none, where no airframe was; `places`: the file of each flight. Flights that a single
/// parting holds out are not asked, so that what is judged on them has not seen them; of a rotation all are.
inline FlownVehicle flown_vehicle(const std::optional<NamedAirframe>& given,
                                  const pinnquad::logs::ImportedDataset& dataset,
                                  const std::vector<std::string>& places, const std::vector<Fold>& folds) {
  const pinnquad::logs::ImportedDataset asked = detail::not_held_out(dataset, places, folds);
  NamedAirframe like = given ? *given : airframe_of(dataset);
  FlownVehicle vehicle;
  vehicle.given = given.has_value();
  for (const pinnquad::Flight& flight : asked.flights.flights()) vehicle.flights.push_back(flight.name);
  pinnquad::IdentificationSettings settings;
  try {
    settings.thrust_curve = like.value.rotors[0].thrust_curve;
    settings.fit_thrust_curve = !given && dataset.curve.fitted;  // again: the held-out flights are in the dataset's
    vehicle.asked = identified_vehicle(asked, like.value, settings);
  } catch (const pinnquad::InputError& refused) {
    vehicle.asked = IdentifiedVehicle{};
    vehicle.asked->why_not = refused.what();
  }
  if (vehicle.identified()) vehicle.assumed = assumptions(like, *vehicle.asked->airframe);
  if (given) {
    vehicle.doubts = detail::contradictions(vehicle.asked->found, like);
    vehicle.airframe = std::move(like);
  } else if (vehicle.identified()) {
    vehicle.airframe = {"identified", vehicle.asked->airframe->value};
  } else {
    if (like.name.empty()) like = chosen_airframe(pinnquad::PaperQuadrotor::name);
    pinnquad::logs::set_thrust_curve(like.value, settings.thrust_curve);
    vehicle.airframe = detail::assumed_airframe(like, vehicle.asked->found, asked.flights, vehicle.unknown);
  }
  return vehicle;
}

/// "thrust of a rotor over mass 4.97 (4.94 to 4.99) m/s^2, ...": what a vehicle flies by.
inline std::string identified_in_words(const pinnquad::Identification& found) {
  std::string words;
  for (const IdentifiedNumber& number : identified_numbers(found)) {
    for (const char* key : {"thrust_m_s2", "thrust_curve", "roll_effectiveness_rad_s2", "pitch_effectiveness_rad_s2",
                            "yaw_effectiveness_rad_s2", "rotor_lag_s"}) {
      if (number.key != key) continue;
      words += (words.empty() ? "" : ", ") + number.words + in_words(" %.4g", number.estimate.value) + " (" +
               interval_text(number.estimate) + ") " + number.unit;
    }
  }
  return words;
}

/// For report.json; null where the flights were not asked.
inline nlohmann::json vehicle_json(const FlownVehicle& vehicle) {
  if (!vehicle.asked) return nullptr;
  const IdentifiedVehicle& asked = *vehicle.asked;
  nlohmann::json flights = nlohmann::json::array();
  for (const std::string& name : vehicle.flights) flights.push_back(pinnquad::printable(name));
  return {{"airframe", vehicle.given          ? "given"
                       : vehicle.identified() ? "identified"
                                              : "assumed"},
          {"identified", vehicle.identified()},
          {"not_identified_because",
           vehicle.identified() ? nlohmann::json() : nlohmann::json(pinnquad::printable(asked.why_not))},
          {"flights", std::move(flights)},
          {"duration_s", asked.found.duration_s},
          {"blocks", asked.found.blocks},
          {"numbers", numbers_json(identified_numbers(asked.found))},
          {"assumed", vehicle.assumed},
          {"unknown", vehicle.unknown},
          {"contradicted", vehicle.doubts}};
}

}  // namespace programs
