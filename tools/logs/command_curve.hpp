// SPDX-License-Identifier: MIT
// From a log's motor commands to thrust: the curve that the mapping states, or that its flights show.
#pragma once

#include <optional>

#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/logs/read_dataset.hpp"

namespace pinnquad::logs {

/// `stated`: by the mapping or the log. Else it is fitted to twenty minutes of all flights together, as
/// `pinnquad identify` does it (regression/identification.hpp): by how much more a command turns and lifts the vehicle
/// where the rotors are fast. Straight where the flights do not tell it.
CommandCurve command_curve(const Dataset& flights, const std::optional<double>& stated);

/// All rotors get the curve `k`.
inline void set_thrust_curve(Airframe<double>& airframe, double k) {
  for (RotorMount<double>& rotor : airframe.rotors) rotor.thrust_curve = k;
}

}  // namespace pinnquad::logs
