// SPDX-License-Identifier: MIT
// The two series of Fig. 2: what a flight's commands ask for about an axis, and the motion that followed.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace programs {

/// About one axis, row by row.
struct AxisMotion {
  std::string words;                         ///< "roll: S = −u1 + u2 + u3 − u4"
  std::vector<double> angular_acceleration;  ///< rad/s^2
  std::vector<double> command_sum;           ///< S
};

/// `axis`: 0 roll, 1 pitch, 2 yaw.
inline AxisMotion axis_motion(const pinnquad::Flight& flight, const pinnquad::Airframe<double>& airframe, int axis) {
  constexpr std::array<const char*, 3> names = {"roll", "pitch", "yaw"};
  const auto signs = pinnquad::allocation_signs(airframe, axis);  // of the commands in S
  AxisMotion motion;
  motion.words = names[static_cast<std::size_t>(axis)] + std::string(": S =");
  for (std::size_t i = 0; i < signs.size(); ++i) {
    motion.words += (signs[i] < 0 ? (i == 0 ? " −u" : " − u") : (i == 0 ? " u" : " + u")) + std::to_string(i + 1);
  }
  for (const pinnquad::Sample& sample : flight) {
    motion.angular_acceleration.push_back(sample.angular_acceleration_rad_s2[axis]);
    motion.command_sum.push_back(pinnquad::signed_sum(signs, sample.commands));
  }
  return motion;
}

}  // namespace programs
