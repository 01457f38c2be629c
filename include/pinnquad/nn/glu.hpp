// SPDX-License-Identifier: MIT
// Gated linear unit (Dauphin et al. 2017): y_i = x_i / (1 + exp(-x_(Count + i))) for i < Count, half as many numbers as
// it reads; those behind the 2 Count pass on unchanged. PyTorch's GLU. Calls the C library once per gate.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

/// GLU of `Count` numbers: y_i = x_i / (1 + exp(-x_(Count + i))).
template <int Count>
struct Glu {
  template <class ScalarType, int In>
  struct Bind {
    static_assert(Count >= 1 && 2 * Count <= In, "pinnquad: Glu<n> reads 2 n numbers of the layer before");
    using Scalar = ScalarType;
    static constexpr int inputs = In;
    static constexpr int outputs = In - Count;
    static constexpr int parameter_count = 0;
    static constexpr int count = Count;

    static PINNQUAD_ALWAYS_INLINE void forward(const Scalar*, const Scalar* x, Scalar* y) noexcept {
      for (int i = 0; i < Count; ++i) y[i] = x[i] * detail::logistic(x[Count + i]);
      for (int i = Count; i < outputs; ++i) y[i] = x[Count + i];
    }
    /// Gradients by the outputs become those by the inputs.
    static PINNQUAD_ALWAYS_INLINE void pull_back(const Scalar*, const Scalar* x, const Scalar* by_output,
                                                 Scalar* by_input) noexcept {
      for (int i = 0; i < Count; ++i) {
        const Scalar gate = detail::logistic(x[Count + i]);
        by_input[i] = gate * by_output[i];
        by_input[Count + i] = x[i] * gate * (Scalar(1) - gate) * by_output[i];
      }
      for (int i = 2 * Count; i < In; ++i) by_input[i] = by_output[i - Count];
    }
  };
};

}  // namespace pinnquad
