// SPDX-License-Identifier: MIT
// Exponential linear unit (Clevert et al. 2016) with alpha 1: y = v > 0 ? v : exp(v) - 1. PyTorch's ELU by default.
// Calls the C library once per neuron that is not above 0. Another alpha is a map of ReLU and this one between dense
// layers, as `pinnquad convert` writes it.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

/// ELU, y = v > 0 ? v : exp(v) - 1, of each output of the layer before.
struct Elu {
  static constexpr const char* description = "pinnquad::Elu";

  template <class Scalar, int In>
  struct Bind : ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static constexpr bool lane_by_lane = true;
    static PINNQUAD_ALWAYS_INLINE Scalar activate(Scalar v) noexcept {
      return v > Scalar(0) ? v : detail::exponential_minus_one(v);
    }
    /// exp(v) = 1 + y below 0, else 1: never above 1, nor below 0.
    static PINNQUAD_ALWAYS_INLINE Scalar slope(Scalar y) noexcept { return y > Scalar(0) ? Scalar(1) : Scalar(1) + y; }
  };
};

}  // namespace pinnquad
