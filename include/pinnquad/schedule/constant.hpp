// SPDX-License-Identifier: MIT
// The same weight in every epoch.
#pragma once

#include "pinnquad/schedule/schedule.hpp"

namespace pinnquad {

struct Constant {
  double value = 0.1;  ///< the paper's lambda_max

  constexpr double weight(int /*epoch*/, int /*epochs*/) const noexcept { return value; }
};

}  // namespace pinnquad
