// SPDX-License-Identifier: MIT
// The numbers of an attitude as a log has them: whole numbers, three of four, angles in another unit.
#pragma once

#include <vector>

#include "logs/bound_log.hpp"

namespace pinnquad::logs {

/// Throws for a row whose numbers are no unit quaternion; zeros are a row without attitude.
void require_unit(const Signal& signal);

/// Pitch beyond 90 degrees in more than a few rows is in another unit: turned into a quaternion it would wrap round.
/// Throws InputError with the unit that fits, where that is not the mapping's.
void require_radians(const Signal& signal);

/// x, y, z of a unit quaternion as w, x, y, z, w >= 0; longer than one by rounding: w is 0.
void make_scalar(std::vector<std::vector<double>>& values);

/// Whole numbers up to 32767 are a quaternion of 16-bit integers (Betaflight's imuQuaternion).
bool counts_to_32767(const std::vector<std::vector<double>>& values);

}  // namespace pinnquad::logs
