// SPDX-License-Identifier: MIT
// Clipping as a layer: y = v between -3.5 and 3.5, else that bound. As the first layer it bounds the standardised
// inputs: the layers behind it see no input far outside the training set. NaN goes through.
#pragma once

#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

template <class ScalarType, int Size>
struct ClipLayer : ElementwiseLayer<ClipLayer<ScalarType, Size>, ScalarType, Size> {
  static constexpr ScalarType bound = ScalarType(3.5);

  static PINNQUAD_ALWAYS_INLINE ScalarType activate(ScalarType v) noexcept {
    return v < -bound ? -bound : (v > bound ? bound : v);
  }
  /// 1 inside, 0 outside and on the bounds.
  static PINNQUAD_ALWAYS_INLINE ScalarType slope(ScalarType y) noexcept {
    return y > -bound && y < bound ? ScalarType(1) : ScalarType(0);
  }
};

struct Clip {
  static constexpr const char* description = "pinnquad::Clip";

  template <class Scalar, int In>
  using Bind = ClipLayer<Scalar, In>;
};

}  // namespace pinnquad
