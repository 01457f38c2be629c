// SPDX-License-Identifier: MIT
// Leaky rectified linear unit: y = v < 0 ? 0.01 v : v, PyTorch's LeakyReLU by default. NaN goes through. Another slope
// below 0 is a map of twice as many ReLUs between dense layers, as `pinnquad convert` writes it.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

/// Leaky ReLU, y = v < 0 ? 0.01 v : v, of each output of the layer before.
struct LeakyRelu {
  static constexpr const char* description = "pinnquad::LeakyRelu";

  template <class Scalar, int In>
  struct Bind : ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static constexpr Scalar below = Scalar(0.01);  ///< its slope there
    static PINNQUAD_ALWAYS_INLINE Scalar activate(Scalar v) noexcept {
      return detail::positive_part(v) - below * detail::positive_part(-v);
    }
    /// The same bits, fused or not: one of the two parts is 0.
    template <class Pack>
    static PINNQUAD_ALWAYS_INLINE Pack activate(Pack v) noexcept {
      return Pack::positive_part(v) - Pack::broadcast(below) * Pack::positive_part(Pack::broadcast(Scalar(0)) - v);
    }
    /// 1 where y > 0, else 0.01 (at the kink too).
    static PINNQUAD_ALWAYS_INLINE Scalar slope(Scalar y) noexcept { return y > Scalar(0) ? Scalar(1) : below; }
    template <class Pack>
    static PINNQUAD_ALWAYS_INLINE Pack scaled(Pack y, Pack dy) noexcept {
      const Pack above = Pack::where_positive(y, dy);
      return above + Pack::broadcast(below) * (dy - above);
    }
  };
};

}  // namespace pinnquad
