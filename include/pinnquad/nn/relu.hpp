// SPDX-License-Identifier: MIT
// Rectified linear unit: y = v < 0 ? 0 : v. NaN goes through (fmax would swallow it).
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

/// ReLU, y = v < 0 ? 0 : v, of each output of the layer before.
struct Relu {
  static constexpr const char* description = "pinnquad::Relu";

  template <class Scalar, int In>
  struct Bind : ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static PINNQUAD_ALWAYS_INLINE Scalar activate(Scalar v) noexcept { return detail::positive_part(v); }
    template <class Pack>
    static PINNQUAD_ALWAYS_INLINE Pack activate(Pack v) noexcept {
      return Pack::positive_part(v);
    }
    /// 1 where y > 0, else 0 (0 at the kink).
    static PINNQUAD_ALWAYS_INLINE Scalar slope(Scalar y) noexcept { return y > Scalar(0) ? Scalar(1) : Scalar(0); }
    template <class Pack>
    static PINNQUAD_ALWAYS_INLINE Pack scaled(Pack y, Pack dy) noexcept {
      return Pack::where_positive(y, dy);
    }
  };
};

}  // namespace pinnquad
