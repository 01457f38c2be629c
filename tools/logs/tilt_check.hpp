// SPDX-License-Identifier: MIT
// Is a velocity in the axes that the mapping says, where a log has no accelerometer? An acceleration that is derived of
// the velocity agrees with it in any axes. The rotors push along the body's z axis: level flight at a tilt accelerates
// by g times its tangent, less drag, and an altitude rises by the velocity along up.
#pragma once

#include <optional>

#include "pinnquad/data/motion_checks.hpp"

namespace pinnquad::logs {

/// Compares, over steps of 0.2 s, the changes of the velocity along north and east with
///   a = -g (R e_z)_ne / (R e_z)_d - d v - c,
/// R from body to world; drag d >= 0 and wind c are those that leave least of the flight's mean of a v; the change of
/// the altitude, if there is one, with the velocity along down. A mistake where both agree far better, plainly, with
/// columns of other axes (detail::VelocityReading).
/// Measured: more than nine tenths of own flights, lively or in gusts, are told; no own flight of any kind is refused.
/// Limits: at one heading the body's axes and the world's differ by the tilt alone, too little for most flights; in a
/// hover nothing moves.
std::optional<detail::Implausible> find_velocity_off_tilt(const Flight& flight, bool has_altitude);

}  // namespace pinnquad::logs
