// SPDX-License-Identifier: MIT
// The quantities of a flight's rows, and the units in which logs have them.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "pinnquad/core/rotation.hpp"

namespace programs {

/// The quantities that a mapping may name. The order is that of a mapping's messages.
enum class Quantity {
  attitude,
  body_rates,
  angular_acceleration,
  specific_force,
  acceleration,
  velocity,
  position,
  altitude,
  motors,
  torque_and_thrust,
  landed,
  extra  ///< any other column, for models that take it: not among `quantities`
};

/// The dimension of a unit.
enum class Dimension { time, angle, turning, angular_acceleration, acceleration, speed, length, rotor_speed, none };

struct QuantityFacts {
  Quantity quantity;
  const char* key;  ///< its table in a mapping
  std::size_t columns;
  Dimension dimension;
  const char* words;
};

// clang-format off
inline constexpr std::array<QuantityFacts, 11> quantities = {{
    {Quantity::attitude, "attitude", 4, Dimension::angle, "quaternion or Euler angles"},
    {Quantity::body_rates, "body_rates", 3, Dimension::turning, "angular velocity in the body's axes"},
    {Quantity::angular_acceleration, "angular_acceleration", 3, Dimension::angular_acceleration, "its derivative"},
    {Quantity::specific_force, "specific_force", 3, Dimension::acceleration,
     "what an accelerometer measures: at rest -g along z down"},
    {Quantity::acceleration, "acceleration", 3, Dimension::acceleration, "of the vehicle against the world: at rest 0"},
    {Quantity::velocity, "velocity", 3, Dimension::speed, "against the ground"},
    {Quantity::position, "position", 3, Dimension::length, "in the world"},
    {Quantity::altitude, "altitude", 1, Dimension::length, "height, positive up"},
    {Quantity::motors, "motors", 4, Dimension::none, "the command of each motor"},
    {Quantity::torque_and_thrust, "torque_and_thrust", 4, Dimension::none,
     "set points from which the motors' commands are rebuilt"},
    {Quantity::landed, "landed", 1, Dimension::none, "1 on the ground, 0 in the air"}}};
// clang-format on

inline constexpr const QuantityFacts& facts_of(Quantity quantity) {
  return quantities[static_cast<std::size_t>(quantity)];
}

struct Unit {
  Dimension dimension;
  const char* name;
  double in_si;
};

inline constexpr double g_m_s2 = 9.80665;  // standard gravity: what "g" means in a log

inline constexpr std::array<Unit, 24> units = {
    {{Dimension::time, "s", 1},
     {Dimension::time, "ms", 1e-3},
     {Dimension::time, "us", 1e-6},
     {Dimension::time, "ns", 1e-9},
     {Dimension::angle, "rad", 1},
     {Dimension::angle, "deg", 1 / pinnquad::degrees_per_radian},
     {Dimension::turning, "rad/s", 1},
     {Dimension::turning, "deg/s", 1 / pinnquad::degrees_per_radian},
     {Dimension::angular_acceleration, "rad/s^2", 1},
     {Dimension::angular_acceleration, "deg/s^2", 1 / pinnquad::degrees_per_radian},
     {Dimension::acceleration, "m/s^2", 1},
     {Dimension::acceleration, "g", g_m_s2},
     {Dimension::acceleration, "mm/s^2", 1e-3},
     {Dimension::speed, "m/s", 1},
     {Dimension::speed, "mm/s", 1e-3},
     {Dimension::speed, "cm/s", 1e-2},
     {Dimension::speed, "km/h", 1 / 3.6},
     {Dimension::length, "m", 1},
     {Dimension::length, "mm", 1e-3},
     {Dimension::length, "cm", 1e-2},
     {Dimension::length, "ft", 0.3048},
     {Dimension::rotor_speed, "rev/s", 1},
     {Dimension::rotor_speed, "rpm", 1.0 / 60},
     {Dimension::rotor_speed, "rad/s", 0.15915494309189535}}};

/// Null if that dimension has no such unit.
inline const Unit* unit_named(Dimension dimension, std::string_view name) {
  for (const Unit& unit : units) {
    if (unit.dimension == dimension && name == unit.name) return &unit;
  }
  return nullptr;
}

/// "\"rad\" or \"deg\"": for messages.
inline std::string unit_names(Dimension dimension) {
  std::string names;
  for (const Unit& unit : units) {
    if (unit.dimension == dimension) names += (names.empty() ? "\"" : ", \"") + std::string(unit.name) + "\"";
  }
  return names;
}

}  // namespace programs
