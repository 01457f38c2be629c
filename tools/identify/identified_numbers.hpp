// SPDX-License-Identifier: MIT
// The numbers of an identification as they are told: name, unit, interval, how well the flights tell them, and which
// flight would tell more.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/in_words.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/regression/identification.hpp"

namespace programs {

struct IdentifiedNumber {
  std::string key;    ///< "roll_effectiveness_rad_s2"
  std::string words;  ///< "roll effectiveness"
  std::string unit;
  pinnquad::Estimate estimate;
  double scale = 0;    ///< a size that matters: what is known to a share of it is known, however small it is
  std::string flight;  ///< what to fly to learn it
  std::string moved;   ///< how much of that there was
};

/// Half the interval over the value, or over the size that matters.
inline double looseness(const IdentifiedNumber& number) {
  return number.estimate.half_width / std::max(std::abs(number.estimate.value), number.scale);
}

/// How well the flights tell a number: half its interval is 5 %, 15 %, 50 % of it, or more.
inline const char* excitation_words(const IdentifiedNumber& number) {
  const double loose = looseness(number);
  return loose <= 0.05 ? "good" : loose <= 0.15 ? "fair" : loose <= 0.5 ? "weak" : "not determined";
}
inline bool is_told(const IdentifiedNumber& number) { return looseness(number) <= 0.5; }

inline std::vector<IdentifiedNumber> identified_numbers(const pinnquad::Identification& found) {
  constexpr std::array<const char*, 3> turns = {"roll", "pitch", "yaw"}, axes = {"x", "y", "z"};
  const std::array<std::string, 3> about = {"roll to and fro, steps of 10 degrees at 0.5 to 3 Hz, for 20 s",
                                            "pitch to and fro, steps of 10 degrees at 0.5 to 3 Hz, for 20 s",
                                            "yaw to and fro, steps of 60 degrees, for 30 s"};
  const std::array<std::string, 3> along = {"forward and back at 2, 5 and 8 m/s, 20 s",
                                            "to the right and left at 2, 5 and 8 m/s, 20 s",
                                            "climbs and descents at 1, 2 and 4 m/s, 20 s"};
  const auto text = [](double value) { return pinnquad::number_text(std::round(1e4 * value) / 1e4); };
  std::vector<IdentifiedNumber> numbers;
  const std::string lifted = "the sum of the commands moved by " + text(found.collective_deviation);
  numbers.push_back({"thrust_m_s2", "thrust of a rotor over mass", "m/s^2", found.thrust_m_s2, 0, along[2], lifted});
  if (found.thrust_curve.half_width < 1e9) {
    numbers.push_back({"thrust_curve", "thrust curve", "1", found.thrust_curve, 0.5,
                       "climbs with full power and descents with little, 20 s", lifted});
  }
  std::array<std::string, 3> turned, moved;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    turned[axis] = "its signed command sum moved by " + text(found.signed_sum_deviation[axis]);
    moved[axis] = "the speed moved by " + text(found.speed_deviation_m_s[axis]) + " m/s";
    numbers.push_back({std::string(turns[axis]) + "_effectiveness_rad_s2", std::string(turns[axis]) + " effectiveness",
                       "rad/s^2", found.effectiveness_rad_s2[axis], 0, about[axis], turned[axis]});
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t across = axis == 1 ? 0 : 1;
    numbers.push_back({std::string(turns[axis]) + "_by_velocity_rad_s_m",
                       std::string(turns[axis]) + " by the air, of speed along " + axes[across], "rad/s/m",
                       found.by_velocity_rad_s_m[axis], 1, along[across], moved[across]});
  }
  const std::string quick = "quick small rolls and pitches, 5 degrees at 2 to 5 Hz, for 20 s";
  numbers.push_back({"rotor_lag_s", "rotor lag", "s", found.lag_s, 0, quick, turned[0]});
  if (!found.delay_held) {
    const bool apart = std::abs(found.fall_after_rise_s.value) > found.fall_after_rise_s.half_width;
    if (apart) {
      numbers.push_back({"rise_s", "lag of growing thrust", "s", found.rise_s, 0, quick, turned[0]});
      numbers.push_back({"fall_s", "lag of falling thrust", "s", found.fall_s, 0, quick, turned[0]});
    }
    numbers.push_back({"delay_s", "delay before it, filters included", "s", found.delay_s, 0.01, quick, turned[0]});
  }
  numbers.push_back({"response_s", "lag and delay together", "s", found.response_s, 0, quick, turned[0]});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    numbers.push_back({std::string(turns[axis]) + "_damping_1_s", std::string(turns[axis]) + " damping", "1/s",
                       found.damping_1_s[axis], 1, about[axis], turned[axis]});
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    numbers.push_back({std::string("linear_drag_") + axes[axis] + "_1_s",
                       std::string("linear drag along ") + axes[axis], "1/s", found.linear_drag_1_s[axis], 0.3,
                       along[axis], moved[axis]});
    numbers.push_back({std::string("quadratic_drag_") + axes[axis] + "_1_m",
                       std::string("quadratic drag along ") + axes[axis], "1/m", found.quadratic_drag_1_m[axis], 0.1,
                       along[axis], moved[axis]});
    numbers.push_back({std::string("drag_") + axes[axis] + "_1_m",
                       std::string("drag along ") + axes[axis] + ", all quadratic", "1/m", found.drag_1_m[axis], 0.1,
                       along[axis], moved[axis]});
  }
  for (std::size_t axis = 0; axis < 2; ++axis) {
    numbers.push_back({axis == 0 ? "offset_y_over_arm" : "offset_x_over_arm",
                       std::string("centre of gravity along ") + (axis == 0 ? "y" : "x"), "arms",
                       found.imbalance[axis] * (axis == 0 ? 1 : -1), 0.02, "hover for 20 s", turned[axis]});
  }
  numbers.push_back(
      {"yaw_trim", "yaw trim of all rotors over one", "1", found.imbalance[2], 0.1, "hover for 20 s", turned[2]});
  for (std::size_t axis = 0; axis < 2; ++axis) {
    numbers.push_back({std::string("gyroscopic_") + turns[axis], std::string("gyroscopic term of ") + turns[axis], "1",
                       found.gyroscopic[axis], 0.5, "turns at speed: circles with the heading along the path, 30 s",
                       "the body turned about one axis at a time"});
  }
  if (found.mean_voltage_V > 0) {
    numbers.push_back({"battery", "thrust over battery voltage, relative", "1", found.battery, 1,
                       "from a full battery to an empty one", "at a mean of " + text(found.mean_voltage_V) + " V"});
  }
  return numbers;
}

inline std::string interval_text(const pinnquad::Estimate& estimate) {
  if (!std::isfinite(estimate.half_width)) return "none";
  return in_words("%.4g to %.4g", estimate.low(), estimate.high());
}

/// By key: value, interval, unit, excitation; null for what is infinite.
inline nlohmann::json numbers_json(const std::vector<IdentifiedNumber>& numbers) {
  const auto json_of = [](double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(); };
  nlohmann::json all = nlohmann::json::object();
  for (const IdentifiedNumber& number : numbers) {
    nlohmann::json& one = all[number.key];
    one = {{"value", json_of(number.estimate.value)},
           {"low", json_of(number.estimate.low())},
           {"high", json_of(number.estimate.high())},
           {"unit", number.unit},
           {"excitation", excitation_words(number)}};
    if (!is_told(number)) one["fly"] = number.flight;
  }
  return all;
}

}  // namespace programs
