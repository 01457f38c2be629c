// SPDX-License-Identifier: MIT
// Gaussian error linear unit in its approximation by tanh (Hendrycks and Gimpel 2016):
//   y = v (1 + tanh(sqrt(2 / pi) (v + 0.044715 v^3))) / 2
// PyTorch's GELU(approximate='tanh'). Calls the C library once per neuron.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

/// GELU by tanh, y = v (1 + tanh(sqrt(2 / pi) (v + 0.044715 v^3))) / 2, of each output of the layer before.
struct GeluTanh {
  static constexpr const char* description = "pinnquad::GeluTanh";

  template <class Scalar, int In>
  struct Bind : ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static constexpr bool lane_by_lane = true;
    static PINNQUAD_ALWAYS_INLINE Scalar activate(Scalar v) noexcept { return v * gate(v); }
    /// g + v dg/dv with the gate g. Two inputs have the same output: asked with v.
    static PINNQUAD_ALWAYS_INLINE Scalar slope_from_input(Scalar v) noexcept {
      const Scalar g = gate(v), near = detail::absolute(v) < Scalar(10) ? v : Scalar(0);  // further out dg/dv is 0
      return g + near * (Scalar(2) * g * (Scalar(1) - g) * (root + Scalar(3) * cubic * near * near));
    }

   private:
    static constexpr auto root = Scalar(0.79788456080286536), cubic = Scalar(0.79788456080286536 * 0.044715);
    /// (1 + tanh(z)) / 2 = 1 / (1 + exp(-2 z)): the tail below 0 keeps its digits. Further out than 20 it is 0 or 1.
    static PINNQUAD_ALWAYS_INLINE Scalar gate(Scalar v) noexcept {
      const Scalar far(20), bounded = v > far ? far : v;
      return v < -far ? Scalar(0) : detail::logistic(Scalar(2) * bounded * (root + cubic * bounded * bounded));
    }
  };
};

}  // namespace pinnquad
