// SPDX-License-Identifier: MIT
// Hyperbolic tangent activation: y = tanh(v). Calls the C library once per neuron.
#pragma once

#include <cmath>

#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

template <class ScalarType, int Size>
struct TanhLayer : ElementwiseLayer<TanhLayer<ScalarType, Size>, ScalarType, Size> {
  static PINNQUAD_ALWAYS_INLINE ScalarType activate(ScalarType v) noexcept {
    using std::tanh;
    return tanh(v);
  }
  template <class Pack>
  static PINNQUAD_ALWAYS_INLINE Pack activate(Pack v) noexcept {
    return Pack::hyperbolic_tangent(v);
  }
  /// 1 - y^2.
  static PINNQUAD_ALWAYS_INLINE ScalarType slope(ScalarType y) noexcept { return ScalarType(1) - y * y; }
  template <class Pack>
  static PINNQUAD_ALWAYS_INLINE Pack scaled(Pack y, Pack dy) noexcept {
    return dy - y * y * dy;
  }
};

struct Tanh {
  template <class Scalar, int In>
  using Bind = TanhLayer<Scalar, In>;
};

}  // namespace pinnquad
