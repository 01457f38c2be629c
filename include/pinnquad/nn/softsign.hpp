// SPDX-License-Identifier: MIT
// Softsign: y = v / (1 + |v|). PyTorch's Softsign. Calls nothing.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

/// Softsign, y = v / (1 + |v|), of each output of the layer before.
struct Softsign {
  static constexpr const char* description = "pinnquad::Softsign";

  template <class Scalar, int In>
  struct Bind : ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static constexpr bool lane_by_lane = true;
    static PINNQUAD_ALWAYS_INLINE Scalar activate(Scalar v) noexcept { return v / (Scalar(1) + detail::absolute(v)); }
    /// 1 / (1 + |v|)^2 = (1 - |y|)^2.
    static PINNQUAD_ALWAYS_INLINE Scalar slope(Scalar y) noexcept {
      const Scalar rest = Scalar(1) - detail::absolute(y);
      return rest * rest;
    }
  };
};

}  // namespace pinnquad
