// SPDX-License-Identifier: MIT
// The vehicle of flights as an airframe, or why there is none: what `identify` writes and `train` takes where no
// airframe is given.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "airframe/choice.hpp"
#include "command_line/in_words.hpp"
#include "identify/identified_numbers.hpp"
#include "identify/sound_flights.hpp"
#include "logs/command_curve.hpp"
#include "pinnquad/regression/identified_airframe.hpp"

namespace programs {

struct IdentifiedVehicle {
  pinnquad::Identification found;
  std::optional<pinnquad::IdentifiedAirframe> airframe;
  std::string why_not;  ///< without an airframe: the number that is missing, its column and what was seen
};

/// Stands for all that flights do not say: the airframe of the mapping, or an X of PX4's motor order without a name.
inline NamedAirframe airframe_of(const pinnquad::logs::ImportedDataset& dataset) {
  constexpr double mass_kg = 1, arm_m = 0.2, lag_s = 0.03;
  NamedAirframe like{"", {}};
  each_airframe([&](auto tag) {  // a dataset keeps the name alone, of a file too
    using Vehicle = typename decltype(tag)::type;
    if (Vehicle::name == dataset.airframe) like = chosen_airframe(dataset.airframe);
  });
  if (!like.name.empty()) return like;
  like.value.mass_kg = mass_kg;
  like.value.rotors = pinnquad::x_rotors(arm_m, arm_m);
  like.value.propeller_diameter_m = 0.2;
  like.value.max_rotor_speed_rev_s = 100;
  like.value.thrust_coefficient = 0.1;
  like.value.power_coefficient = 0.05;
  like.value.rotor_time_constant_s = lag_s;
  pinnquad::logs::set_thrust_curve(like.value, dataset.curve.k);
  return like;
}

namespace detail {

/// "rotor lag is 1.33 s, where quadrotors have 0 to 0.2 s": with the columns, and what to look at.
inline std::string implausible_in_words(const pinnquad::ImplausibleNumber& number) {
  const std::string key = number.key, unit = number.unit[0] == '\0' ? "" : " " + std::string(number.unit);
  const auto text = [](double value) { return in_words("%.3g", value); };
  std::string column = "columns u1 to u4: ", look_at = "were the commands filtered, clipped or stamped late?";
  for (const auto& [turn, rate] : {std::pair("roll", "w_x"), {"pitch", "w_y"}, {"yaw", "w_z"}}) {
    if (key.rfind(turn, 0) != 0) continue;
    column = "column " + std::string(rate) + ": ";
    look_at = "look at its unit, rad/s, and at the range of the commands u1 to u4, 0 to 1";
  }
  if (key.rfind("inertia", 0) == 0) look_at = "look at the arms, in m, and at the range of the commands, 0 to 1";
  return column + number.words + " is " + text(number.value) + unit + ", where quadrotors have " +
         text(number.range.least) + " to " + text(number.range.most) + unit + ": " + look_at;
}

inline std::string why_no_airframe(const pinnquad::Identification& found, const pinnquad::Airframe<double>& like) {
  constexpr std::array<const char*, 4> needed = {"thrust_m_s2", "roll_effectiveness_rad_s2",
                                                 "pitch_effectiveness_rad_s2", "yaw_effectiveness_rad_s2"};
  constexpr std::array<const char*, 4> columns = {"vdot_bz", "w_x", "w_y", "w_z"};
  constexpr double least_s = 10;
  if (!std::isfinite(found.thrust_m_s2.half_width) && found.duration_s < least_s) {
    return "expected 10 s or more of flight, in stretches of a second or more without a gap, found " +
           pinnquad::number_text(std::round(10 * found.duration_s) / 10) + " s";
  }
  const std::vector<IdentifiedNumber> numbers = identified_numbers(found);
  for (std::size_t i = 0; i < needed.size(); ++i) {
    for (const IdentifiedNumber& number : numbers) {
      if (number.key != needed[i]) continue;
      const bool backwards = number.estimate.high() < 0;
      if (i == 3 && !backwards) continue;
      if (pinnquad::is_told(number.estimate, 0.5) && !backwards) continue;
      return "column " + std::string(columns[i]) + ": " + number.words + " is " +
             (backwards ? "negative, " + interval_text(number.estimate) + ": the commands turn it the other way"
                        : "not determined, " + interval_text(number.estimate) + ", as " + number.moved +
                              "; fly: " + number.flight);
    }
  }
  if (const auto number = pinnquad::implausible_number(found, like)) return implausible_in_words(*number);
  return "no vehicle has these numbers";
}

}  // namespace detail

/// Where roll and pitch are further apart than a quadrotor's; empty else.
inline std::string unlike_axes_in_words(const pinnquad::Identification& found) {
  const auto ratio = pinnquad::unlike_axes(found);
  if (!ratio) return "";
  return in_words(
      "roll effectiveness is %.3g rad/s^2 (%s), pitch effectiveness %.3g (%s): a quadrotor's are alike "
      "within a factor of %.0f; look at the motor order, or fly more of the axis with the wider interval",
      found.effectiveness_rad_s2[0].value, interval_text(found.effectiveness_rad_s2[0]).c_str(),
      found.effectiveness_rad_s2[1].value, interval_text(found.effectiveness_rad_s2[1]).c_str(),
      pinnquad::plausible::roll_over_pitch);
}

/// Of a dataset's flights, with the mass, the arms, the spins and the propeller of `like`. A lag that the import
/// removed is in the delay again. Throws InputError, one line, for flights that no vehicle can be identified from.
inline IdentifiedVehicle identified_vehicle(const pinnquad::logs::ImportedDataset& dataset,
                                            const pinnquad::Airframe<double>& like,
                                            const pinnquad::IdentificationSettings& settings) {
  const std::vector<pinnquad::Flight> flights = sound_flights(dataset);
  IdentifiedVehicle vehicle;
  vehicle.found = pinnquad::identify(pinnquad::all_rows(flights), pinnquad::axis_signs(like), settings);
  vehicle.found.delay_s.value += dataset.lag_removed_s;
  vehicle.found.response_s.value += dataset.lag_removed_s;
  vehicle.airframe = pinnquad::identified_airframe(vehicle.found, like);
  if (!vehicle.airframe) vehicle.why_not = detail::why_no_airframe(vehicle.found, like);
  return vehicle;
}

/// "mass 1.2 kg (--mass)": what the flights do not say and the airframe has. `mass_of`, `arms_of`: the option that said
/// it; empty for none.
inline std::vector<std::string> assumptions(const NamedAirframe& like, const pinnquad::IdentifiedAirframe& made,
                                            const std::string& mass_of = {}, const std::string& arms_of = {}) {
  std::vector<std::string> told;
  const auto text = [](double value) { return pinnquad::number_text(value); };
  const std::string of = like.name.empty() ? "assumed" : "of " + like.name;
  const pinnquad::RotorMount<double>& corner = like.value.rotors[0];
  told.push_back("mass " + text(like.value.mass_kg) + " kg (" + (mass_of.empty() ? of : mass_of) + ")");
  told.push_back("arms " + text(std::abs(corner.x_m)) + " m along x, " + text(std::abs(corner.y_m)) + " m along y (" +
                 (arms_of.empty() ? of : arms_of) + ")");
  told.push_back("propeller " + text(like.value.propeller_diameter_m) + " m at " +
                 text(like.value.max_rotor_speed_rev_s) + " rev/s (" + of + ")");
  for (const std::string& key : made.assumed) {
    if (key == "inertia_kg_m2[2]") told.push_back("Jz, 0.9 (Jx + Jy): the flights do not tell it");
    if (key == "power_coefficient") told.push_back("torque of a rotor over its thrust (" + of + ")");
    if (key == "rotor_time_constant_s") {
      told.push_back("rotor lag " + text(like.value.rotor_time_constant_s) + " s (" + of + ")");
    }
    if (key.rfind("drag_area", 0) == 0) told.push_back(key + " (" + of + ")");
  }
  return told;
}

}  // namespace programs
