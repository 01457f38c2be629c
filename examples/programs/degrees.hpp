// SPDX-License-Identifier: MIT
// Angles as people read them.
#pragma once

namespace programs {

constexpr double degrees_per_radian = 57.295779513082323;

}  // namespace programs
