// SPDX-License-Identifier: MIT
// Half a cosine from the full learning rate down to nothing (Loshchilov and Hutter 2017, without restarts).
#pragma once

#include <cmath>

#include "pinnquad/schedule/rate.hpp"

namespace pinnquad {

/// (1 + cos(pi t / T)) / 2 in step t of T, from 0: PyTorch's CosineAnnealingLR with T_max = T, stepped once per batch.
struct CosineDecay {
  double factor(double done) const noexcept {
    constexpr double pi = 3.14159265358979323846;
    return 0.5 * (1.0 + std::cos(pi * done));
  }
};

}  // namespace pinnquad
