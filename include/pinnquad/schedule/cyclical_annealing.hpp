// SPDX-License-Identifier: MIT
// Eq. (6): the weight is held, then falls linearly, and starts anew each cycle (Fig. 3).
#pragma once

#include <limits>

#include "pinnquad/data/settings.hpp"
#include "pinnquad/schedule/schedule.hpp"

namespace pinnquad {

/// beta = mod(k, P) / P with P = ceil(T / M): lambda_max while beta <= R, then (1 - beta) / (1 - R) lambda_max.
/// k is the epoch from 0, T the epochs. It never reaches 0: a cycle's last epoch has lambda_max / (P (1 - R)). R = 1 means
/// constant; the last cycle may be cut short (docs/paper.md, deviation 11). Fewer than one cycle have no weight: NaN, see
/// check().
struct CyclicalAnnealing {
  double maximum = 0.1;  ///< lambda_max
  int cycles = 5;        ///< M
  double hold = 0.5;     ///< R, the share of a cycle at lambda_max

  constexpr double weight(int epoch, int epochs) const noexcept {
    if (cycles < 1) return std::numeric_limits<double>::quiet_NaN();
    if (epochs < 1) return maximum;
    const int period = (epochs - 1) / cycles + 1;
    const double beta = static_cast<double>(epoch % period) / period;
    return beta <= hold ? maximum : (1.0 - beta) / (1.0 - hold) * maximum;
  }

  /// Throws std::invalid_argument unless the maximum is a finite number from 0, cycles >= 1 and 0 <= hold <= 1.
  constexpr void check() const {
    detail::expect_from_zero("CyclicalAnnealing::maximum", maximum);
    if (cycles < 1) detail::refuse_setting("CyclicalAnnealing::cycles", "a number from 1", cycles);
    if (!(hold >= 0.0 && hold <= 1.0)) {
      detail::refuse_setting("CyclicalAnnealing::hold", "a share from 0 to 1", hold);
    }
  }
};

}  // namespace pinnquad
