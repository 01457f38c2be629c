// SPDX-License-Identifier: MIT
// Backward rule of the fully connected layer: dx = W^T dy, dW = dy x^T, db = dy.
// The trainer's batch form of the same products is in training/batch_layer.hpp.
#pragma once

#include "pinnquad/nn/dense.hpp"
#include "pinnquad/training/backward/backward.hpp"

namespace pinnquad {

template <class Scalar, int In, int Out>
struct BackwardRule<DenseWithoutBiasLayer<Scalar, In, Out>> {
  static void backward(const Scalar* parameters, const Scalar* x, const Scalar*, const Scalar* dy, Scalar* dx,
                       Scalar* parameter_gradient) noexcept {
    for (int column = 0; column < In; ++column) dx[column] = Scalar(0);
    for (int row = 0; row < Out; ++row) {
      for (int column = 0; column < In; ++column) {
        dx[column] += parameters[row * In + column] * dy[row];
        parameter_gradient[row * In + column] += dy[row] * x[column];
      }
    }
  }
};

/// The same, and db = dy.
template <class Scalar, int In, int Out>
struct BackwardRule<DenseLayer<Scalar, In, Out>> {
  static void backward(const Scalar* parameters, const Scalar* x, const Scalar* y, const Scalar* dy, Scalar* dx,
                       Scalar* parameter_gradient) noexcept {
    BackwardRule<DenseWithoutBiasLayer<Scalar, In, Out>>::backward(parameters, x, y, dy, dx, parameter_gradient);
    for (int row = 0; row < Out; ++row) parameter_gradient[Out * In + row] += dy[row];
  }
};

}  // namespace pinnquad
