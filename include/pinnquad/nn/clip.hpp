// SPDX-License-Identifier: MIT
// Clipping as a layer: y = v between -3.5 and 3.5, else that bound. As the first layer it bounds the standardised
// inputs: the layers behind it see no input far outside the training set. NaN goes through.
#pragma once

#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

/// Clip, y = v held between -3.5 and 3.5, of each output of the layer before.
struct Clip {
  static constexpr const char* description = "pinnquad::Clip";

  template <class Scalar, int In>
  struct Bind : ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static constexpr Scalar bound = Scalar(3.5);
    static PINNQUAD_ALWAYS_INLINE Scalar activate(Scalar v) noexcept {
      return v < -bound ? -bound : (v > bound ? bound : v);
    }
    /// 1 inside, 0 outside and on the bounds.
    static PINNQUAD_ALWAYS_INLINE Scalar slope(Scalar y) noexcept {
      return y > -bound && y < bound ? Scalar(1) : Scalar(0);
    }
  };
};

}  // namespace pinnquad
