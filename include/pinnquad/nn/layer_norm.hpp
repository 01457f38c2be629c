// SPDX-License-Identifier: MIT
// Layer normalisation (Ba et al. 2016) and root-mean-square normalisation (Zhang and Sennrich 2019) of the first Count
// numbers; those behind them pass on unchanged, as a skip connection needs it.
//   LayerNorm<Count>: y_i = gamma_i (x_i - mean) / sqrt(variance + 1e-5) + beta_i, variance = mean of (x - mean)^2
//   RmsNorm<Count>:   the same with 0 for the mean
// Parameters: Count times gamma, then beta. Another epsilon e is the same with sqrt(1e-5 / e) x.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/kernel/portable.hpp"

namespace pinnquad {

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// `count` numbers, each `stride` behind the one before, normalised: (x_i - mean) scale.
template <class Number>
struct Normalised {
  const Number* x;
  int count, stride;
  Number mean, scale;

  PINNQUAD_ALWAYS_INLINE Number operator[](int i) const noexcept { return (x[i * stride] - mean) * scale; }
  /// v becomes J v with their Jacobian J, which is symmetric: scale (v_i - mean of v - n_i mean of n v).
  PINNQUAD_ALWAYS_INLINE void multiply_by_jacobian(Number* v, bool centred) const noexcept {
    Number sum(0), along(0);
    for (int i = 0; i < count; ++i) {
      sum += v[i * stride];
      along = multiply_add((*this)[i], v[i * stride], along);
    }
    sum = centred ? sum / Number(count) : Number(0);
    along = along / Number(count);
    for (int i = 0; i < count; ++i) {
      v[i * stride] = scale * (multiply_add(-(*this)[i], along, v[i * stride]) - sum);
    }
  }
};

/// The variance is that of differences from the mean: no squares cancel.
template <class Number>
PINNQUAD_ALWAYS_INLINE Normalised<Number> normalised(const Number* x, int count, int stride, bool centred) noexcept {
  Number mean(0), squares(0);
  if (centred) {
    for (int i = 0; i < count; ++i) mean += x[i * stride];
    mean = mean / Number(count);
  }
  for (int i = 0; i < count; ++i) {
    const Number off = x[i * stride] - mean;
    squares = multiply_add(off, off, squares);
  }
  return {x, count, stride, mean, Number(1) / square_root(squares / Number(count) + Number(1e-5))};
}

}  // namespace PINNQUAD_INSTRUCTION_SET

/// A LayerNorm or RmsNorm, bound.
template <class ScalarType, int Size, int Count, bool Centred>
struct NormLayer {
  static_assert(Count >= 1 && Count <= Size,
                "pinnquad: LayerNorm<n> and RmsNorm<n> normalise at most as many numbers as the layer before makes");
  using Scalar = ScalarType;
  static constexpr int inputs = Size;
  static constexpr int outputs = Size;
  static constexpr int parameter_count = 2 * Count;

  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    const auto own = of(x);
    for (int i = 0; i < Count; ++i) y[i] = multiply_add(parameters[i], own[i], parameters[Count + i]);
    for (int i = Count; i < Size; ++i) y[i] = x[i];
  }
  /// The first Count numbers, normalised.
  static PINNQUAD_ALWAYS_INLINE Normalised<Scalar> of(const Scalar* x) noexcept {
    return normalised(x, Count, 1, Centred);
  }
  /// Gradients by the outputs become those by the inputs.
  static PINNQUAD_ALWAYS_INLINE void pull_back(const Scalar* parameters, const Scalar* x, const Scalar* by_output,
                                               Scalar* by_input) noexcept {
    for (int i = 0; i < Size; ++i) by_input[i] = i < Count ? parameters[i] * by_output[i] : by_output[i];
    of(x).multiply_by_jacobian(by_input, Centred);
  }
  static void add_gradient(const Scalar* x, const Scalar* by_output, Scalar* parameter_gradient) noexcept {
    const auto own = of(x);
    for (int i = 0; i < Count; ++i) {
      parameter_gradient[i] += own[i] * by_output[i];
      parameter_gradient[Count + i] += by_output[i];
    }
  }
  /// A gamma of 1.
  template <class Engine>
  static void initialise(Scalar* parameters, Engine&) noexcept {
    for (int i = 0; i < Count; ++i) parameters[i] = Scalar(1);
  }
};

}  // namespace detail

/// Normalises the first `Count` numbers to a mean of 0 and a variance of 1.
template <int Count>
struct LayerNorm {
  template <class Scalar, int In>
  using Bind = detail::NormLayer<Scalar, In, Count, true>;
};

/// The same without taking the mean off.
template <int Count>
struct RmsNorm {
  template <class Scalar, int In>
  using Bind = detail::NormLayer<Scalar, In, Count, false>;
};

}  // namespace pinnquad
