// SPDX-License-Identifier: MIT
// Are attitudes read as the log wrote them? Asked of the motion: an attitude turns with the body rates, and the
// specific force that it turns into the world holds the vehicle up on average.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "pinnquad/core/rotation.hpp"

namespace pinnquad::logs {

/// How a log writes an attitude. As ours: (w, x, y, z), from body FRD to world NED.
struct AttitudeConvention {
  bool scalar_last = false;    ///< x, y, z, w
  bool world_to_body = false;  ///< turns the world into the body
  bool enu = false;            ///< the world is east, north, up
  bool flu = false;            ///< the body is x forward, y left, z up
};

/// Four numbers as a log has them, read as our attitude.
Quaternion<double> read_attitude(const std::array<double, 4>& numbers, const AttitudeConvention& as);

/// The numbers that are read as this attitude, up to their common sign.
std::array<double, 4> written_attitude(Quaternion<double> q, const AttitudeConvention& as);

/// Series on one uniform clock, rows with a NaN left out; `q`: w, x, y, z of the attitudes as they were read. In each
/// convention: the share of the body rates' squares that the turning of the attitude over 0.2 s leaves, and the
/// distance of the mean specific force in the world to -g, in g (at most 1 each). A finding where the convention of
/// `read` misses by 0.5 or more in sum, and another by less than a third of that. number: the sum. Limits: a vehicle
/// that neither turns nor tilts says only which way is up; heading is not judged (no magnetic field is known); rates
/// and force must be in FRD.
std::optional<std::string> check_attitude(double period_s, const AttitudeConvention& read,
                                          const std::array<const std::vector<double>*, 4>& q,
                                          const std::array<const std::vector<double>*, 3>& body_rates_rad_s,
                                          const std::array<const std::vector<double>*, 3>& specific_force_m_s2);

/// Rotors push along -z of FRD: a mean specific force along +z is that of another body frame. number: the mean in g.
/// `read_as_flu`: the mapping's body, which a finding does not advise again.
std::optional<std::string> check_thrust_direction(const std::vector<double>& specific_force_z_m_s2,
                                                  bool read_as_flu = false);

}  // namespace pinnquad::logs
