// SPDX-License-Identifier: MIT
// Fully connected layer: y = W x + b, or y = W x where a batch norm that follows would subtract b again.
// Parameters: W row-major (row = output, column = input), then b. This layout holds from training to flash.
#pragma once

#include "pinnquad/nn/kernel/portable.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

template <class ScalarType, int In, int Out>
struct DenseLayer {
  using Scalar = ScalarType;
  static constexpr int inputs = In;
  static constexpr int outputs = Out;
  static constexpr int weight_count = Out * In;
  static constexpr int parameter_count = weight_count + Out;

  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    multiply_row_major<Out, In>(parameters, parameters + weight_count, x, y);
  }

  /// y = activate(W x + b), in one pass; `Activation` is an element-wise layer.
  template <class Activation>
  static PINNQUAD_ALWAYS_INLINE void forward_fused(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    multiply_row_major<Out, In>(parameters, parameters + weight_count, x, y,
                                [](Scalar v) PINNQUAD_INLINE_LAMBDA { return Activation::activate(v); });
  }

  /// y[0, Count) = activate(W x + b) for the `Count` neurons from `first` on. Inputs that the kernel holds all at a
  /// time may stand anywhere: `X` is a pointer to them then, or anything else with [input].
  template <int Count, class X, class Activate>
  static PINNQUAD_ALWAYS_INLINE void forward_some(const Scalar* parameters, int first, const X& x, Scalar* y,
                                                  Activate activate) noexcept {
    multiply_row_major<Count, In>(parameters + first * In, parameters + weight_count + first, x, y, activate);
  }
  /// y += what the `Count` inputs from `first` on, x[0, Count), give to W x. The sums of forward() are b and then all
  /// inputs.
  template <int Count>
  static PINNQUAD_ALWAYS_INLINE void add_some(const Scalar* parameters, int first, const Scalar* x,
                                              Scalar* y) noexcept {
    add_columns<Out, Count>(parameters + first, In, x, y);
  }
};

namespace detail {
template <class T>
struct IsDense : std::false_type {};
template <class Scalar, int In, int Out>
struct IsDense<DenseLayer<Scalar, In, Out>> : std::true_type {};
template <class T>
inline constexpr bool is_dense = IsDense<T>::value;
}  // namespace detail

/// `Out` neurons; the number of inputs is deduced.
template <int Out>
struct Dense {
  template <class Scalar, int In>
  using Bind = DenseLayer<Scalar, In, Out>;
};

template <class ScalarType, int In, int Out>
struct DenseWithoutBiasLayer {
  using Scalar = ScalarType;
  static constexpr int inputs = In;
  static constexpr int outputs = Out;
  static constexpr int parameter_count = Out * In;

  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    multiply_row_major<Out, In>(parameters, x, y);
  }
};

/// `Out` neurons without bias: what stands before a BatchNorm.
template <int Out>
struct DenseWithoutBias {
  template <class Scalar, int In>
  using Bind = DenseWithoutBiasLayer<Scalar, In, Out>;
};

}  // namespace pinnquad
