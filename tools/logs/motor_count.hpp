// SPDX-License-Identifier: MIT
// The number of motors that a log commands: planes, hexacopters and '+' frames are named, and slots of an array that
// nobody uses count as none.
#pragma once

#include <string>
#include <vector>

#include "logs/mapping.hpp"
#include "pinnquad/logs/flight_log.hpp"

namespace pinnquad::logs {

/// The columns of the same array behind the four, up to twelve motors: a log may have them. None where the four are no
/// array.
std::vector<std::string> further_motor_names(const Source& source);

/// Throws InputError, one line, for a vehicle that is no X quadrotor: one of the four columns never commands anything
/// beside others that do, columns of the same array beyond the four do, or PX4's parameters put the rotors on the axes.
/// A command that is NaN throughout, or never above a hundredth of its range, is that of no motor: ROS 2 fills twelve
/// slots with 0, and PX4 writes 0 to 0.0025 while it is disarmed. `least`, `most`: of a motor's number.
void require_four_motors(const FlightLog& log, const LogTopic& topic, const Source& source, double least, double most,
                         const std::string& mapping_file);

}  // namespace pinnquad::logs
