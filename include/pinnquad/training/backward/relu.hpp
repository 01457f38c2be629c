// SPDX-License-Identifier: MIT
// Backward rule of ReLU.
#pragma once

#include "pinnquad/nn/relu.hpp"
#include "pinnquad/training/backward/backward.hpp"

namespace pinnquad {

/// dy/dv = 1 where y > 0, else 0 (0 at the kink).
template <class Scalar, int Size>
struct BackwardRule<ReluLayer<Scalar, Size>> {
  static Scalar slope(Scalar y) noexcept { return y > Scalar(0) ? Scalar(1) : Scalar(0); }
  template <class Pack>
  static PINNQUAD_ALWAYS_INLINE Pack scaled(Pack y, Pack dy) noexcept {
    return Pack::where_positive(y, dy);
  }
};

}  // namespace pinnquad
