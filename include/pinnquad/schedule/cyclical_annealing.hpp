// SPDX-License-Identifier: MIT
// Eq. (6): the weight is held, then falls linearly, and starts anew each cycle (Fig. 3).
#pragma once

#include "pinnquad/schedule/schedule.hpp"

namespace pinnquad {

/// beta = mod(k, P) / P with P = ceil(T / M): lambda_max while beta <= R, then (1 - beta) / (1 - R) lambda_max.
/// k is the epoch from 0, T the epochs. It never reaches 0: a cycle's last epoch has lambda_max / (P (1 - R)). R = 1 means
/// constant; the last cycle may be cut short (docs/paper.md, deviation 11).
struct CyclicalAnnealing {
  double maximum = 0.1;  ///< lambda_max
  int cycles = 5;        ///< M
  double hold = 0.5;     ///< R, the share of a cycle at lambda_max

  constexpr double weight(int epoch, int epochs) const noexcept {
    const int period = (epochs + cycles - 1) / cycles;
    if (period <= 0) return maximum;
    const double beta = static_cast<double>(epoch % period) / period;
    return beta <= hold ? maximum : (1.0 - beta) / (1.0 - hold) * maximum;
  }
};

}  // namespace pinnquad
