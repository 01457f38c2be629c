// SPDX-License-Identifier: MIT
// The contract of a layer's backward pass: a specialisation `BackwardRule<Layer>` for one sample,
//   static void backward(const Scalar* parameters, const Scalar* x, const Scalar* y, const Scalar* dy, Scalar* dx,
//                        Scalar* parameter_gradient) noexcept;
// dx is set, parameter_gradient is added to. An element-wise layer needs none: it has its slope (nn/layer.hpp).
// Rule of the fully connected layer: dx = W^T dy, dW = dy x^T, db = dy. Its batch form: training/batch_layer.hpp.
#pragma once

#include <type_traits>
#include <utility>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/nn/dense.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

template <class Layer>
struct BackwardRule;

namespace detail {
template <class Layer>
using BackwardOf = std::bool_constant<noexcept(BackwardRule<Layer>::backward(
    std::declval<const typename Layer::Scalar*>(), std::declval<const typename Layer::Scalar*>(),
    std::declval<const typename Layer::Scalar*>(), std::declval<const typename Layer::Scalar*>(),
    std::declval<typename Layer::Scalar*>(), std::declval<typename Layer::Scalar*>()))>;
}  // namespace detail

/// True for a bound layer that can be trained, but for `noexcept`.
template <class Layer>
inline constexpr bool is_trainable = is_elementwise<Layer> ? has_slope<Layer> : is_detected<detail::BackwardOf, Layer>;

/// True if the layer's BackwardRule, where it has one, is noexcept: the Trainer's backward pass is.
template <class Layer>
inline constexpr bool is_noexcept_backward = detail::is_noexcept_where_given<detail::BackwardOf, Layer>();

template <class Scalar, int In, int Out, bool HasBias>
struct BackwardRule<DenseLayer<Scalar, In, Out, HasBias>> {
  static void backward(const Scalar* parameters, const Scalar* x, const Scalar*, const Scalar* dy, Scalar* dx,
                       Scalar* parameter_gradient) noexcept {
    for (int column = 0; column < In; ++column) dx[column] = Scalar(0);
    for (int row = 0; row < Out; ++row) {
      for (int column = 0; column < In; ++column) {
        dx[column] += parameters[row * In + column] * dy[row];
        parameter_gradient[row * In + column] += dy[row] * x[column];
      }
    }
    if constexpr (HasBias) {
      for (int row = 0; row < Out; ++row) parameter_gradient[Out * In + row] += dy[row];
    }
  }
};

}  // namespace pinnquad
