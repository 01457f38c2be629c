// SPDX-License-Identifier: MIT
// Softplus: y = log(1 + exp(v)), a smooth ReLU; PyTorch's Softplus(beta=1), without its threshold. Calls the C library
// twice per neuron.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

/// Softplus, y = log(1 + exp(v)), of each output of the layer before.
struct Softplus {
  static constexpr const char* description = "pinnquad::Softplus";

  template <class Scalar, int In>
  struct Bind : ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static constexpr bool lane_by_lane = true;
    /// max(v, 0) + log(1 + exp(-|v|)): nothing overflows.
    static PINNQUAD_ALWAYS_INLINE Scalar activate(Scalar v) noexcept {
      return detail::positive_part(v) + detail::log_of_one_plus(detail::exponential(-detail::absolute(v)));
    }
    /// 1 / (1 + exp(-v)) = 1 - exp(-y).
    static PINNQUAD_ALWAYS_INLINE Scalar slope(Scalar y) noexcept { return -detail::exponential_minus_one(-y); }
  };
};

}  // namespace pinnquad
