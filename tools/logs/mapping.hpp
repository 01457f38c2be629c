// SPDX-License-Identifier: MIT
// The meaning of the columns of a log: which of them make which quantity of a flight's rows, in which unit, frame and
// order.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "logs/motor_order.hpp"

namespace pinnquad::logs {

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
enum class Dimension {
  time,
  angle,
  turning,
  angular_acceleration,
  acceleration,
  speed,
  length,
  rotor_speed,
  force,
  torque,
  none
};

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

enum class WorldFrame { ned, enu };
enum class BodyFrame { frd, flu };
enum class Axes { body, world };

/// The meaning of the numbers of `motors`.
enum class MotorNumbers {
  thrust,  ///< share of the greatest thrust, 0..1
  signal,  ///< what the motor's controller is told, from `least` to `most`: a command of the airframe's thrust curve
  speed    ///< rotor speed
};

/// A place in the mapping's file, for messages; 0 where it has none.
struct MappingPlace {
  std::size_t line = 0;
  std::size_t column = 0;
};

struct NamedColumn {
  std::string name;
  MappingPlace place;
};

/// A number that the mapping says, or that the log has among its parameters: 0.1, "1/acc_1G", "motorOutput[0]".
struct MappedNumber {
  double value = 0;       ///< where the log is not asked
  std::string parameter;  ///< of the log; empty: `value`
  bool divides = false;   ///< one over it
};

/// Where a quantity may stand: one of several, the first that the log has is taken.
struct Source {
  Quantity quantity = Quantity::attitude;
  std::string topic;  ///< empty: the log's table
  int instance = 0;
  std::string thrust_topic;  ///< of torque_and_thrust, where it is another one
  std::vector<NamedColumn> columns;
  /// A number n of the log is (n * scale + offset) * in_si.
  MappedNumber scale{1, {}, false};
  double offset = 0;
  double in_si = 1;
  std::string unit;         ///< that the mapping says; empty: SI
  bool optional = false;    ///< a log without it is one
  std::string time_column;  ///< empty: the topic's clock
  double time_in_s = 1e-6;
  bool held = false;  ///< a value holds until the next one
  MappingPlace place;

  bool euler = false;                             ///< of attitude: roll, pitch, yaw instead of a quaternion
  std::array<double, 3> euler_signs = {1, 1, 1};  ///< "-pitch": the log has it the other way round
  bool without_scalar = false;                    ///< x, y, z alone: w >= 0 is what makes them a unit quaternion
  bool scalar_last = false;                       ///< x, y, z, w
  bool world_to_body = false;                     ///< the quaternion's direction
  WorldFrame world = WorldFrame::ned;
  BodyFrame body = BodyFrame::frd;
  Axes axes = Axes::body;  ///< of accelerations and velocities

  MotorNumbers numbers = MotorNumbers::thrust;
  std::array<MotorOrder::Corner, rotor_count> corners = px4_motor_order.corners;
  MappedNumber least{0, {}, false}, most{1, {}, false};  ///< of a motor's number: stopped or idle, and full
  std::optional<double> thrust_curve;                    ///< of a signal: thrust = s ((1 - k) + k s)
  std::string thrust_curve_parameter;                    ///< that the log has it by
  bool thrust_is_up = false;  ///< of torque_and_thrust: positive for thrust, PX4's z is negative
  bool wrench = false;        ///< torque and thrust are in units, not shares: the airframe makes the commands
  double thrust_in_si = 1;    ///< `in_si` is the torque's
};

/// A column that goes along as it is: a model's extra input.
struct ExtraSource {
  std::string name;  ///< "battery_voltage"
  std::string unit;  ///< "V"
  Source source;     ///< one column; `scale` and `offset` lead to the unit
};

struct Mapping {
  std::string name;  ///< of a ready one; else its file
  std::string file;  ///< for messages
  std::string about;
  std::string airframe;     ///< where none is given
  NamedColumn time_column;  ///< of a table, which has no clock of its own
  double time_in_s = 1;
  double time_scale = 1;  ///< of every clock of the log: a second of it in seconds

  NamedColumn flight_column;      ///< labels that part a table into flights
  NamedColumn trajectory_column;  ///< labels that name what was flown
  std::string trajectory;  ///< pattern of a flight's name, "*_(*)_*": what stands in brackets is the trajectory's
  double split_gap_s = 5;  ///< a longer pause parts two flights

  double ground_m = 0;             ///< height of the ground in the log's own heights
  bool ground_from_log = false;    ///< that of the rows before the flight
  double least_height_m = 0;       ///< rows lower than this above ground are on it; 0: no such test
  bool ground_by_contact = false;  ///< what bears the vehicle is told by forces and commands (row_checks.hpp)

  double lowest_command = 0, highest_command = 1;  ///< where a motor is at its limit
  double idle_below = 0.05;                        ///< all four commands lower than this: the motors idle

  double least_rate_hz = 0;  ///< a slower source is taken only where there is no other
  std::optional<double> lag_s;

  std::vector<Source> sources;
  std::vector<ExtraSource> extras;
};

/// The factor to SI of a unit that a mapping, or a log's column, names: "deg", "m/s/s"; empty for one that is none of
/// that dimension.
std::optional<double> unit_in_si(Dimension dimension, const std::string& name);

/// The mapping of a TOML text, whose tables are the quantities; `path` is for messages. Throws InputError with line and
/// column: no TOML, keys that are none, values of another kind.
Mapping parse_mapping(const std::string& text, const std::string& path);

/// The same of a file.
Mapping read_mapping_file(const std::string& path);

}  // namespace pinnquad::logs
