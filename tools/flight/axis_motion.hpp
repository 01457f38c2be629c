// SPDX-License-Identifier: MIT
// The two series of Fig. 2: what a flight's commands ask for about an axis, and the motion that followed.
#pragma once

#include <array>
#include <vector>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace programs {

/// About one axis, row by row.
struct AxisMotion {
  std::array<double, pinnquad::rotor_count> signs{};  ///< of the commands in the sum: allocation_signs()
  std::vector<double> angular_acceleration;           ///< rad/s^2
  std::vector<double> command_sum;                    ///< S = signs . u
};

/// `axis`: 0 roll, 1 pitch, 2 yaw.
inline AxisMotion axis_motion(const pinnquad::Flight& flight, const pinnquad::Airframe<double>& airframe, int axis) {
  AxisMotion motion;
  motion.signs = pinnquad::allocation_signs(airframe, axis);
  for (const pinnquad::Sample& sample : flight) {
    motion.angular_acceleration.push_back(sample.angular_acceleration_rad_s2[axis]);
    motion.command_sum.push_back(pinnquad::signed_sum(motion.signs, sample.commands));
  }
  return motion;
}

}  // namespace programs
