// SPDX-License-Identifier: MIT
// Hyperbolic tangent activation: y = tanh(v). Calls the C library once per neuron.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

/// Hyperbolic tangent, y = tanh(v), of each output of the layer before.
struct Tanh {
  static constexpr const char* description = "pinnquad::Tanh";

  template <class Scalar, int In>
  struct Bind : ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static constexpr bool lane_by_lane = true;
    static PINNQUAD_ALWAYS_INLINE Scalar activate(Scalar v) noexcept { return detail::hyperbolic_tangent(v); }
    /// 1 - y^2.
    static PINNQUAD_ALWAYS_INLINE Scalar slope(Scalar y) noexcept { return Scalar(1) - y * y; }
    template <class Pack>
    static PINNQUAD_ALWAYS_INLINE Pack scaled(Pack y, Pack dy) noexcept {
      return dy - y * y * dy;
    }
  };
};

}  // namespace pinnquad
