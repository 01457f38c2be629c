// SPDX-License-Identifier: MIT
// Backward rule of tanh.
#pragma once

#include "pinnquad/nn/tanh.hpp"
#include "pinnquad/training/backward/backward.hpp"

namespace pinnquad {

/// dy/dv = 1 - y^2.
template <class Scalar, int Size>
struct BackwardRule<TanhLayer<Scalar, Size>> {
  static Scalar slope(Scalar y) noexcept { return Scalar(1) - y * y; }
  template <class Pack>
  static PINNQUAD_ALWAYS_INLINE Pack scaled(Pack y, Pack dy) noexcept {
    return dy - y * y * dy;
  }
};

}  // namespace pinnquad
