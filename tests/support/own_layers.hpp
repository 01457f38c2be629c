// SPDX-License-Identifier: MIT
// Layers as a user writes them: element-wise without a pack form, with parameters of its own, and one whose backward
// rule needs its output. The contract has to carry them as well as it carries the library's own.
#pragma once

#include <cmath>

#include "consumer/extension/own_layers.hpp"
#include "pinnquad/nn/layer.hpp"
#include "pinnquad/training/backward.hpp"

namespace pinnquad::test {

using own::ChannelScale;
using own::LeakyRelu;

/// y = softmax(x): every output depends on every input, and the rule needs y.
template <class ScalarType, int Size>
struct SoftmaxLayer {
  using Scalar = ScalarType;
  static constexpr int inputs = Size;
  static constexpr int outputs = Size;
  static constexpr int parameter_count = 0;
  static void forward(const Scalar*, const Scalar* x, Scalar* y) noexcept {
    using std::exp;
    Scalar sum(0);
    for (int i = 0; i < Size; ++i) sum += exp(x[i]);
    for (int i = 0; i < Size; ++i) y[i] = exp(x[i]) / sum;
  }
};
struct Softmax {
  template <class Scalar, int In>
  using Bind = SoftmaxLayer<Scalar, In>;
};

/// y = x / |x|: has no value, and no slope, where all inputs are 0.
template <class ScalarType, int Size>
struct UnitLengthLayer {
  using Scalar = ScalarType;
  static constexpr int inputs = Size;
  static constexpr int outputs = Size;
  static constexpr int parameter_count = 0;
  static void forward(const Scalar*, const Scalar* x, Scalar* y) noexcept {
    using std::sqrt;
    Scalar squares(0);
    for (int i = 0; i < Size; ++i) squares += x[i] * x[i];
    for (int i = 0; i < Size; ++i) y[i] = x[i] / sqrt(squares);
  }
};
struct UnitLength {
  template <class Scalar, int In>
  using Bind = UnitLengthLayer<Scalar, In>;
};

/// y = 1 / v: a pole at 0.
template <class ScalarType, int Size>
struct ReciprocalLayer : ElementwiseLayer<ReciprocalLayer<ScalarType, Size>, ScalarType, Size> {
  static ScalarType activate(ScalarType v) noexcept { return ScalarType(1) / v; }
  static ScalarType slope(ScalarType y) noexcept { return -y * y; }
};
struct Reciprocal {
  template <class Scalar, int In>
  using Bind = ReciprocalLayer<Scalar, In>;
};

/// y = v^2: two inputs have the same output, so the slope is asked with the input. Packs too, without a call: it runs
/// in registers.
template <class ScalarType, int Size>
struct SquareLayer : ElementwiseLayer<SquareLayer<ScalarType, Size>, ScalarType, Size> {
  template <class Value>
  static Value activate(Value v) noexcept {
    return v * v;
  }
  static ScalarType slope_from_input(ScalarType v) noexcept { return v + v; }
  template <class Pack>
  static Pack scaled_from_input(Pack v, Pack dy) noexcept {
    return (v + v) * dy;
  }
};
struct Square {
  template <class Scalar, int In>
  using Bind = SquareLayer<Scalar, In>;
};

/// The same without a pack form.
template <class ScalarType, int Size>
struct ScalarSquareLayer : ElementwiseLayer<ScalarSquareLayer<ScalarType, Size>, ScalarType, Size> {
  static ScalarType activate(ScalarType v) noexcept { return v * v; }
  static ScalarType slope_from_input(ScalarType v) noexcept { return v + v; }
};
struct ScalarSquare {
  template <class Scalar, int In>
  using Bind = ScalarSquareLayer<Scalar, In>;
};

/// The same, a whole pack at a time.
template <class ScalarType, int Size>
struct PackReciprocalLayer : ElementwiseLayer<PackReciprocalLayer<ScalarType, Size>, ScalarType, Size> {
  static ScalarType activate(ScalarType v) noexcept { return ScalarType(1) / v; }
  static ScalarType slope(ScalarType y) noexcept { return -y * y; }
  template <class Pack>
  static auto activate(Pack v) noexcept -> decltype(Pack::broadcast(ScalarType(1)) / v) {
    return Pack::broadcast(ScalarType(1)) / v;
  }
  template <class Pack>
  static auto scaled(Pack y, Pack dy) noexcept -> decltype(Pack::broadcast(ScalarType(0)) - y * y * dy) {
    return Pack::broadcast(ScalarType(0)) - y * y * dy;
  }
};
struct PackReciprocal {
  template <class Scalar, int In>
  using Bind = PackReciprocalLayer<Scalar, In>;
};

}  // namespace pinnquad::test

namespace pinnquad {

template <class Scalar, int Size>
struct BackwardRule<test::UnitLengthLayer<Scalar, Size>> {
  static void backward(const Scalar*, const Scalar* x, const Scalar* y, const Scalar* dy, Scalar* dx,
                       Scalar*) noexcept {
    using std::sqrt;
    Scalar squares(0), along(0);
    for (int i = 0; i < Size; ++i) {
      squares += x[i] * x[i];
      along += y[i] * dy[i];
    }
    for (int i = 0; i < Size; ++i) dx[i] = (dy[i] - along * y[i]) / sqrt(squares);
  }
};

template <class Scalar, int Size>
struct BackwardRule<test::SoftmaxLayer<Scalar, Size>> {
  static void backward(const Scalar*, const Scalar*, const Scalar* y, const Scalar* dy, Scalar* dx, Scalar*) noexcept {
    Scalar mean(0);
    for (int i = 0; i < Size; ++i) mean += y[i] * dy[i];
    for (int i = 0; i < Size; ++i) dx[i] = y[i] * (dy[i] - mean);
  }
};

}  // namespace pinnquad
