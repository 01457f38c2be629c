// SPDX-License-Identifier: MIT
// The optimiser's own learning rate in every step.
#pragma once

#include "pinnquad/schedule/rate.hpp"

namespace pinnquad {

struct ConstantRate {
  constexpr double factor(double /*done*/) const noexcept { return 1.0; }
};

}  // namespace pinnquad
