// SPDX-License-Identifier: MIT
// The finding of a check of a log: the check, its number, one sentence for the pilot.
#pragma once

#include <cmath>
#include <string>

namespace programs {

struct Finding {
  std::string check;     ///< "rate_frame", "motor_order": for scripts
  double number = 0;     ///< by which it was decided, in `unit`
  std::string unit;      ///< "1" for a share or a ratio
  std::string sentence;  ///< the observation, and the remedy
};

namespace detail {
/// "37 %" of 0.37.
inline std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }
}  // namespace detail

}  // namespace programs
