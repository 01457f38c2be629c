// SPDX-License-Identifier: MIT
// A log's motors as commands of a Sample: front right, rear left, front left, rear right, 0..1, whose
// meaning is that of the airframe's thrust curves.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "airframe/file.hpp"
#include "logs/signal.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace programs {

namespace detail {

/// Index of the motor of a source's order that stands at the Sample's place.
inline std::size_t motor_at(const Source& source, std::size_t place) {
  for (std::size_t i = 0; i < pinnquad::rotor_count; ++i) {
    if (source.corners[i] == px4_motor_order.corners[place]) return i;
  }
  return place;
}

inline double thrust_curve(const std::optional<NamedAirframe>& airframe, std::size_t rotor) {
  return airframe ? airframe->value.rotors[rotor].thrust_curve : 0.0;
}

}  // namespace detail

/// Replaces the columns of `motors` by commands. A number below `least` is a stopped motor: 0; what is above `most` is
/// 1, and falls to the rule for saturated rows. `curve`: thrust = s ((1 - k) + k s) of a signal, where the log or the
/// mapping says so; then the command is the airframe's of that thrust, and else the signal itself.
inline void to_commands(const Source& source, const std::optional<NamedAirframe>& airframe, double curve,
                        std::vector<std::vector<double>>& values) {
  std::vector<std::vector<double>> commands;
  for (std::size_t place = 0; place < pinnquad::rotor_count; ++place) {
    std::vector<double> u = values[detail::motor_at(source, place)];
    for (double& value : u) {
      if (source.numbers == MotorNumbers::speed) {
        value = airframe ? pinnquad::command_from_speed(airframe->value, place, value) : std::nan("");
        continue;
      }
      const bool ranged = !pinnquad::detail::equal(source.least, 0.0) || !pinnquad::detail::equal(source.most, 1.0);
      value = (value - source.least) / (source.most - source.least);
      if (ranged && value < 0) value = 0;
      if (ranged && value > 1) value = 1;
      const bool straight = source.numbers == MotorNumbers::signal && !(curve > 0);
      if (straight) continue;
      const double share = source.numbers == MotorNumbers::thrust ? value : pinnquad::thrust_fraction(curve, value);
      value = pinnquad::command_of_fraction(detail::thrust_curve(airframe, place), share);
    }
    commands.push_back(std::move(u));
  }
  values = std::move(commands);
}

/// Thrust shares of a symmetric X quadrotor from what its controller asked for, torque normalised to -1..1 and thrust
/// to 0..1:
///   u = T -+ r x +- r y +- z, r = sqrt(1/2), as PX4's allocation makes them while no motor is at its limit.
/// NaN where one would be beyond: its desaturation is not known then.
inline std::array<double, 4> rebuilt_commands(const std::array<double, 3>& torque, double thrust) {
  const double r = std::sqrt(0.5), x = r * torque[0], y = r * torque[1], z = torque[2];
  const std::array<double, 4> u = {thrust - x + y + z, thrust + x - y + z, thrust + x + y - z, thrust - x - y - z};
  for (const double one : u) {
    if (one >= 0 && one <= 1) continue;
    const double none = std::nan("");
    return {none, none, none, none};
  }
  return u;
}

/// The columns of `torque_and_thrust` as commands.
inline void rebuild_commands(const Source& source, const std::optional<NamedAirframe>& airframe,
                             std::vector<std::vector<double>>& values) {
  for (std::size_t row = 0; row < values[0].size(); ++row) {
    const double thrust = source.thrust_is_up ? values[3][row] : -values[3][row];
    const std::array<double, 4> u = rebuilt_commands({values[0][row], values[1][row], values[2][row]}, thrust);
    for (std::size_t place = 0; place < u.size(); ++place) {
      values[place][row] = pinnquad::command_of_fraction(detail::thrust_curve(airframe, place), u[place]);
    }
  }
}

}  // namespace programs
