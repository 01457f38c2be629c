// SPDX-License-Identifier: MIT
// Fully connected layer: y = W x + b, or y = W x where a batch norm that follows would subtract b again.
// Parameters: W row-major (row = output, column = input), then b. This layout holds from training to flash.
#pragma once

#include "pinnquad/nn/kernel/portable.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

namespace detail {
/// A Dense or DenseWithoutBias, bound.
template <class ScalarType, int In, int Out, bool HasBias = true>
struct DenseLayer {
  using Scalar = ScalarType;
  static constexpr int inputs = In;
  static constexpr int outputs = Out;
  static constexpr int weight_count = Out * In;
  static constexpr int parameter_count = weight_count + (HasBias ? Out : 0);

  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    forward_fused<void>(parameters, x, y);
  }

  /// y = activate(W x + b), in one pass; `Activation` is an element-wise layer, or void.
  template <class Activation, class X>
  static PINNQUAD_ALWAYS_INLINE void forward_fused(const Scalar* parameters, const X& x, Scalar* y) noexcept {
    forward_some<Out>(parameters, 0, x, y, Activate<Activation>{});
  }

  /// y[0, Count) = activate(W x + b) for the `Count` neurons from `first` on. Inputs that the kernel holds all at a
  /// time may stand anywhere: `X` is a pointer to them then, or anything else with [input].
  template <int Count, class X, class Activate>
  static PINNQUAD_ALWAYS_INLINE void forward_some(const Scalar* parameters, int first, const X& x, Scalar* y,
                                                  Activate activate) noexcept {
    if constexpr (HasBias) {
      multiply_row_major<Count, In>(parameters + first * In, parameters + weight_count + first, x, y, activate);
    } else {
      multiply_row_major<Count, In>(parameters + first * In, NoBias<Scalar>{}, x, y, activate);
    }
  }
  /// y += what the `Count` inputs from `first` on, x[0, Count), give to W x. The sums of forward() are b and then all
  /// inputs.
  template <int Count>
  static PINNQUAD_ALWAYS_INLINE void add_some(const Scalar* parameters, int first, const Scalar* x,
                                              Scalar* y) noexcept {
    add_columns<Out, Count>(parameters + first, In, x, y);
  }
};

template <class T>
inline constexpr bool is_dense_with_bias = false;
template <class Scalar, int In, int Out>
inline constexpr bool is_dense_with_bias<DenseLayer<Scalar, In, Out>> = true;
}  // namespace detail

/// `Out` neurons; the number of inputs is deduced.
template <int Out>
struct Dense {
  template <class Scalar, int In>
  using Bind = detail::DenseLayer<Scalar, In, Out>;
};

/// `Out` neurons without bias: what stands before a BatchNorm.
template <int Out>
struct DenseWithoutBias {
  template <class Scalar, int In>
  using Bind = detail::DenseLayer<Scalar, In, Out, false>;
};

}  // namespace pinnquad
