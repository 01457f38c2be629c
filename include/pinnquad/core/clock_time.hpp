// SPDX-License-Identifier: MIT
// Times that a log's rows and an exported model can state of a clock: a sample period, a lag that was removed.
#pragma once

#include "pinnquad/core/attributes.hpp"

namespace pinnquad {

inline constexpr double longest_clock_s = 4.0;
/// 0 to longest_clock_s; false for NaN.
PINNQUAD_ALWAYS_INLINE constexpr bool is_clock_time(double seconds) noexcept {
  return seconds >= 0.0 && seconds <= longest_clock_s;
}

}  // namespace pinnquad
