// SPDX-License-Identifier: MIT
// Two layers of a user's own: an activation without a pack form, and a layer with parameters that is not element-wise.
// The library's own tests take them too (tests/support/own_layers.hpp).
#pragma once

#include <pinnquad/nn/layer.hpp>
#include <pinnquad/training/backward.hpp>

namespace own {

/// y = v < 0 ? v / 16 : v.
template <class ScalarType, int Size>
struct LeakyReluLayer : pinnquad::ElementwiseLayer<LeakyReluLayer<ScalarType, Size>, ScalarType, Size> {
  static ScalarType activate(ScalarType v) noexcept { return v < ScalarType(0) ? v * ScalarType(0.0625) : v; }
  static ScalarType slope(ScalarType y) noexcept { return y < ScalarType(0) ? ScalarType(0.0625) : ScalarType(1); }
};
struct LeakyRelu {
  template <class Scalar, int In>
  using Bind = LeakyReluLayer<Scalar, In>;
};

/// y_i = p_i x_i; starts near the identity.
template <class ScalarType, int Size>
struct ChannelScaleLayer {
  using Scalar = ScalarType;
  static constexpr int inputs = Size;
  static constexpr int outputs = Size;
  static constexpr int parameter_count = Size;

  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    for (int i = 0; i < Size; ++i) y[i] = parameters[i] * x[i];
  }
  template <class Engine>
  static void initialise(Scalar* parameters, Engine&) noexcept {
    for (int i = 0; i < Size; ++i) parameters[i] = Scalar(0.95 + 0.05 * (i % 3));
  }
};
struct ChannelScale {
  template <class Scalar, int In>
  using Bind = ChannelScaleLayer<Scalar, In>;
};

}  // namespace own

template <class Scalar, int Size>
struct pinnquad::BackwardRule<own::ChannelScaleLayer<Scalar, Size>> {
  static void backward(const Scalar* parameters, const Scalar* x, const Scalar*, const Scalar* dy, Scalar* dx,
                       Scalar* parameter_gradient) noexcept {
    for (int i = 0; i < Size; ++i) {
      dx[i] = parameters[i] * dy[i];
      parameter_gradient[i] += x[i] * dy[i];
    }
  }
};
