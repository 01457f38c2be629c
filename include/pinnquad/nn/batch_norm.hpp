// SPDX-License-Identifier: MIT
// Batch normalisation (Ioffe and Szegedy 2015) with running statistics, and the paper's network with it.
// Training by batch statistics: training/batch_norm.hpp. An exported network has none left: training/folding.hpp.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/network.hpp"

namespace pinnquad {

/// Added to a variance before its root is taken (PyTorch's `eps`).
inline constexpr double batch_norm_epsilon = 1e-5;

/// y_i = gamma_i (x_i - mean_i) / sqrt(variance_i + 1e-5) + beta_i.
/// Parameters: gamma, beta, running mean, running variance, one of each per neuron. Training moves gamma and beta down
/// the gradient and lets the other two follow the batches.
struct BatchNorm {
  static constexpr const char* description = "pinnquad::BatchNorm";

  template <class ScalarType, int Size>
  struct Bind {
    using Scalar = ScalarType;
    static constexpr int inputs = Size;
    static constexpr int outputs = Size;
    static constexpr int parameter_count = 4 * Size;

    static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
      const Scalar* gamma = parameters;
      const Scalar* beta = parameters + Size;
      const Scalar* mean = parameters + 2 * Size;
      const Scalar* variance = parameters + 3 * Size;
      for (int i = 0; i < Size; ++i) {
        y[i] = gamma[i] * ((x[i] - mean[i]) / detail::square_root(variance[i] + Scalar(batch_norm_epsilon))) + beta[i];
      }
    }
  };
};

/// The paper's network with batch norm between Dense and activation (docs/paper.md, deviation 15):
/// `BatchNormMlp<float, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>`.
template <class Scalar, class InputSize, class HiddenLayers, class OutputSize, class Activation>
using BatchNormMlp =
    typename detail::Mlp<Scalar, InputSize, HiddenLayers, OutputSize, DenseWithoutBias, BatchNorm, Activation>::type;

}  // namespace pinnquad
