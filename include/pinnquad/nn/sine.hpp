// SPDX-License-Identifier: MIT
// Sine activation (SIREN, Sitzmann et al. 2020): y = sin(v); a frequency is a factor of the weights before it. Calls
// the C library once per neuron. NaN for an infinity.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

/// Sine, y = sin(v), of each output of the layer before.
struct Sine {
  static constexpr const char* description = "pinnquad::Sine";

  template <class Scalar, int In>
  struct Bind : ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static constexpr bool lane_by_lane = true;
    static PINNQUAD_ALWAYS_INLINE Scalar activate(Scalar v) noexcept { return detail::sine(v); }
    /// cos v: the output does not tell its sign.
    static PINNQUAD_ALWAYS_INLINE Scalar slope_from_input(Scalar v) noexcept { return detail::cosine(v); }
  };
};

}  // namespace pinnquad
