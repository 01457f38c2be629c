// SPDX-License-Identifier: MIT
// Mish (Misra 2019): y = v tanh(log(1 + exp(v))). PyTorch's Mish. Calls the C library once per neuron.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

/// Mish, y = v tanh(log(1 + exp(v))), of each output of the layer before.
struct Mish {
  static constexpr const char* description = "pinnquad::Mish";

  template <class Scalar, int In>
  struct Bind : ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static constexpr bool lane_by_lane = true;
    static PINNQUAD_ALWAYS_INLINE Scalar activate(Scalar v) noexcept { return v * gate(v).value; }
    /// g + v dg/dv with the gate g. Two inputs have the same output: asked with v.
    static PINNQUAD_ALWAYS_INLINE Scalar slope_from_input(Scalar v) noexcept {
      const Gate g = gate(v);
      return g.value + v * g.slope;
    }

   private:
    struct Gate {
      Scalar value, slope;
    };
    /// tanh(log(1 + e)) = n / (n + 2) with e = exp(v), n = e (e + 2); beyond 25 it is 1 to double's last digit.
    static PINNQUAD_ALWAYS_INLINE Gate gate(Scalar v) noexcept {
      const Scalar e = detail::exponential(v > Scalar(25) ? Scalar(25) : v);
      const Scalar n = e * (e + Scalar(2)), whole = n + Scalar(2);
      // of d(n / (n + 2))/dv = 4 e (e + 1) / (n + 2)^2 nothing overflows in float: e / whole is below 1
      return {n / whole, v > Scalar(25) ? Scalar(0) : Scalar(4) * (e / whole) * ((e + Scalar(1)) / whole)};
    }
  };
};

}  // namespace pinnquad
