// SPDX-License-Identifier: MIT
// Sigmoid linear unit (swish): y = v / (1 + exp(-v)). Calls the C library once per neuron. NaN for -infinity, as
// PyTorch's SiLU.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

/// SiLU, y = v / (1 + exp(-v)), of each output of the layer before.
struct Silu {
  static constexpr const char* description = "pinnquad::Silu";

  template <class Scalar, int In>
  struct Bind : ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static constexpr bool lane_by_lane = true;
    static PINNQUAD_ALWAYS_INLINE Scalar activate(Scalar v) noexcept {
      return v / (Scalar(1) + detail::exponential(-v));
    }
    /// s (1 + v (1 - s)) with s = 1 / (1 + exp(-v)). Two inputs have the same output: asked with v.
    static PINNQUAD_ALWAYS_INLINE Scalar slope_from_input(Scalar v) noexcept {
      const Scalar s = detail::logistic(v);
      return s * (Scalar(1) + v * (Scalar(1) - s));
    }
  };
};

}  // namespace pinnquad
