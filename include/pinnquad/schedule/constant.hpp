// SPDX-License-Identifier: MIT
// The same weight in every epoch.
#pragma once

#include "pinnquad/data/settings.hpp"
#include "pinnquad/schedule/schedule.hpp"

namespace pinnquad {

struct Constant {
  double value = 0.1;  ///< the paper's lambda_max

  constexpr double weight(int /*epoch*/, int /*epochs*/) const noexcept { return value; }

  /// Throws std::invalid_argument unless the weight is a finite number from 0.
  constexpr void check() const { detail::expect_from_zero("Constant::value", value); }
};

}  // namespace pinnquad
