// SPDX-License-Identifier: MIT
// Hard swish (Howard et al. 2019): y = v min(max(v + 3, 0), 6) / 6. PyTorch's Hardswish. Calls nothing.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

/// Hard swish, y = v min(max(v + 3, 0), 6) / 6, of each output of the layer before.
struct HardSwish {
  static constexpr const char* description = "pinnquad::HardSwish";

  template <class Scalar, int In>
  struct Bind : ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static constexpr bool lane_by_lane = true;
    static PINNQUAD_ALWAYS_INLINE Scalar activate(Scalar v) noexcept {
      return v <= Scalar(-3) ? Scalar(0) : (v >= Scalar(3) ? v : v * (v + Scalar(3)) * Scalar(1.0 / 6));
    }
    /// 0 up to -3, 1 from 3 on, (2 v + 3) / 6 between. Two inputs have the same output: asked with v.
    static PINNQUAD_ALWAYS_INLINE Scalar slope_from_input(Scalar v) noexcept {
      return v <= Scalar(-3) ? Scalar(0) : (v >= Scalar(3) ? Scalar(1) : (v + v + Scalar(3)) * Scalar(1.0 / 6));
    }
  };
};

}  // namespace pinnquad
