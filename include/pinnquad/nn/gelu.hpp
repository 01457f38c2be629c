// SPDX-License-Identifier: MIT
// Gaussian error linear unit (Hendrycks and Gimpel 2016), the exact form: y = v Phi(v) = v (1 + erf(v / sqrt 2)) / 2.
// PyTorch's GELU(approximate='none'). Calls the C library once per neuron. NaN for -infinity, as there.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

/// GELU, y = v (1 + erf(v / sqrt 2)) / 2, of each output of the layer before.
struct Gelu {
  static constexpr const char* description = "pinnquad::Gelu";

  template <class Scalar, int In>
  struct Bind : ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static constexpr bool lane_by_lane = true;
    static PINNQUAD_ALWAYS_INLINE Scalar activate(Scalar v) noexcept { return v * normal_probability(v); }
    /// Phi(v) + v phi(v), phi the density of the standard normal distribution. Two inputs have the same output: asked
    /// with v.
    static PINNQUAD_ALWAYS_INLINE Scalar slope_from_input(Scalar v) noexcept {
      constexpr auto density_at_0 = Scalar(0.39894228040143268);  // 1 / sqrt(2 pi)
      return normal_probability(v) + v * (density_at_0 * detail::exponential(Scalar(-0.5) * v * v));
    }

   private:
    /// Phi(v), by erfc: the tail below 0 keeps its digits.
    static PINNQUAD_ALWAYS_INLINE Scalar normal_probability(Scalar v) noexcept {
      constexpr auto half_root = Scalar(0.70710678118654752);  // sqrt(1/2)
      return Scalar(0.5) * detail::complementary_error_function(-half_root * v);
    }
  };
};

}  // namespace pinnquad
