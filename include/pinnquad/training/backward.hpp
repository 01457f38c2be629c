// SPDX-License-Identifier: MIT
// Backward passes of layers. The contract of a layer's own: a specialisation `BackwardRule<Layer>` for one sample,
//   static void backward(const Scalar* parameters, const Scalar* x, const Scalar* y, const Scalar* dy, Scalar* dx,
//                        Scalar* parameter_gradient) noexcept;
// dx is set, parameter_gradient is added to. Dense needs none, and an element-wise layer has its slope (nn/layer.hpp).
// Over a mini-batch activations are [sample][padded width], and parameters stand as the kernels want them. Only a layer
// with `whole_tiles` is run on padding rows too, and finds zeros there (network_gradient.hpp).
#pragma once

#include <type_traits>
#include <utility>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/nn/dense.hpp"
#include "pinnquad/nn/kernel/tile.hpp"
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

/// The members of every layer over a mini-batch, but for load(), store(), store_gradient(), forward() and backward().
struct BatchTraits {
  static constexpr bool in_place = false;         ///< works in the buffer of a layer before that does not need it
  static constexpr bool needs_output = false;     ///< backward() reads y: it may not be overwritten
  static constexpr bool couples_samples = false;  ///< outputs depend on the other samples of the batch (batch_norm.hpp)
  static constexpr bool whole_tiles = false;      ///< `samples` has to be a multiple of the pack's tile_rows
  static constexpr int size = 0;                  ///< of the arrays that an optimiser sees

  /// Call after `stored` was changed.
  void refresh() noexcept {}
};

/// The flat arrays that an optimiser sees.
template <class Scalar, int Size>
struct BatchParameters : BatchTraits {
  static constexpr int size = Size;
  alignas(64) Scalar stored[Size > 0 ? Size : 1] = {};
  alignas(64) Scalar gradient[Size > 0 ? Size : 1] = {};
  alignas(64) Scalar first_moment[Size > 0 ? Size : 1] = {};
  alignas(64) Scalar second_moment[Size > 0 ? Size : 1] = {};
};

/// Any layer: its BackwardRule sample by sample.
template <class Layer, class Pack, int BatchSize, class = void>
struct BatchLayer : BatchParameters<typename Layer::Scalar, padded<Pack>(Layer::parameter_count)> {
  static_assert(is_detected<BackwardOf, Layer>,
                "pinnquad: this layer cannot be trained; specialise BackwardRule (training/backward.hpp)");
  static_assert(is_noexcept_where_given<BackwardOf, Layer>(),
                "pinnquad: a BackwardRule's backward() must be noexcept (training/backward.hpp)");
  using Scalar = typename Layer::Scalar;
  static constexpr bool needs_output = true;
  static constexpr int x_stride = padded<Pack>(Layer::inputs);
  static constexpr int y_stride = padded<Pack>(Layer::outputs);

  void load(const Scalar* parameters) noexcept { copy(parameters, this->stored); }
  void store(Scalar* parameters) const noexcept { copy(this->stored, parameters); }
  void store_gradient(Scalar* parameters) const noexcept { copy(this->gradient, parameters); }

  void forward(const Scalar* x, Scalar* y, int samples) const noexcept {
    for (int i = 0; i < samples; ++i) Layer::forward(this->stored, x + i * x_stride, y + i * y_stride);
  }
  /// `delta` holds dy; dx goes to `previous` (which may be null for the first layer).
  void backward(const Scalar* x, const Scalar* y, const Scalar* delta, Scalar* previous, int samples) noexcept {
    for (Scalar& g : this->gradient) g = Scalar(0);
    Scalar scratch[x_stride] = {};
    for (int i = 0; i < samples; ++i) {
      Scalar* dx = previous != nullptr ? previous + i * x_stride : scratch;
      BackwardRule<Layer>::backward(this->stored, x + i * x_stride, y + i * y_stride, delta + i * y_stride, dx,
                                    this->gradient);
    }
  }

 private:
  static void copy(const Scalar* from, Scalar* to) noexcept {
    for (int i = 0; i < Layer::parameter_count; ++i) to[i] = from[i];
  }
};

/// Dense: weights stand input by input, each row padded, the bias (if any) as last row; a transposed copy serves dX.
/// dx = W^T dy, dW = dy x^T, db = dy, by register tiles.
template <class Scalar, int In, int Out, bool HasBias, class Pack>
struct BatchDense : BatchParameters<Scalar, (In + (HasBias ? 1 : 0)) * padded<Pack>(Out)> {
  static constexpr bool whole_tiles = true;
  static constexpr int x_stride = padded<Pack>(In);
  static constexpr int y_stride = padded<Pack>(Out);

  alignas(64) Scalar by_output[Out * x_stride] = {};  // [output][input]

  void load(const Scalar* parameters) noexcept {
    for (int out = 0; out < Out; ++out) {
      for (int in = 0; in < In; ++in) this->stored[in * y_stride + out] = parameters[out * In + in];
      if constexpr (HasBias) this->stored[In * y_stride + out] = parameters[Out * In + out];
    }
    refresh();
  }
  void store(Scalar* parameters) const noexcept { gather(this->stored, parameters); }
  void store_gradient(Scalar* parameters) const noexcept { gather(this->gradient, parameters); }
  void refresh() noexcept {
    for (int out = 0; out < Out; ++out) {
      for (int in = 0; in < In; ++in) by_output[out * x_stride + in] = this->stored[in * y_stride + out];
    }
  }

  void forward(const Scalar* x, Scalar* y, int samples) const noexcept {
    const Scalar* weights = this->stored;
    multiply_batch<Pack, x_stride, y_stride>(x, weights, In, HasBias ? weights + In * y_stride : nullptr, y, samples);
  }
  void backward(const Scalar* x, const Scalar*, const Scalar* delta, Scalar* previous, int samples) noexcept {
    multiply_transposed<Pack, In, x_stride, y_stride>(x, delta, samples, this->gradient);
    if constexpr (HasBias) {
      constexpr int vectors = y_stride / Pack::width;
      Pack sum[vectors];
      for (Pack& s : sum) s = Pack::broadcast(Scalar(0));
      for (int i = 0; i < samples; ++i) {
        unroll<vectors>([&](auto v) PINNQUAD_INLINE_LAMBDA {
          sum[v] = sum[v] + Pack::load(delta + i * y_stride + v * Pack::width);
        });
      }
      for (int v = 0; v < vectors; ++v) sum[v].store(this->gradient + In * y_stride + v * Pack::width);
    }
    if (previous != nullptr) {
      multiply_batch<Pack, y_stride, x_stride>(delta, by_output, Out, nullptr, previous, samples);
    }
  }

 private:
  static void gather(const Scalar* from, Scalar* parameters) noexcept {
    for (int out = 0; out < Out; ++out) {
      for (int in = 0; in < In; ++in) parameters[out * In + in] = from[in * y_stride + out];
      if constexpr (HasBias) parameters[Out * In + out] = from[In * y_stride + out];
    }
  }
};
template <class Scalar, int In, int Out, bool HasBias, class Pack, int BatchSize>
struct BatchLayer<DenseLayer<Scalar, In, Out, HasBias>, Pack, BatchSize, void>
    : BatchDense<Scalar, In, Out, HasBias, Pack> {};

/// Element-wise, with a slope from the output: forward works on its own buffer or on that of the layer before, dx
/// overwrites dy. The padding columns of both may hold anything: no layer reads them into a real column. With a slope
/// from the input, the input is left as it is, and dx goes to a buffer of its own.
template <class Layer, class Pack, int BatchSize>
struct BatchLayer<Layer, Pack, BatchSize, std::enable_if_t<is_elementwise<Layer>>> : BatchTraits {
  static_assert(has_slope<Layer>,
                "pinnquad: this layer cannot be trained; an element-wise layer needs slope(y) or slope_from_input(v) "
                "(nn/layer.hpp)");
  using Scalar = typename Layer::Scalar;
  static constexpr bool in_place = !slopes_from_input<Layer>;
  static constexpr bool needs_output = in_place;
  static constexpr int stride = padded<Pack>(Layer::outputs);

  void load(const Scalar*) noexcept {}
  void store(Scalar*) const noexcept {}
  void store_gradient(Scalar*) const noexcept {}

  void forward(const Scalar* x, Scalar* y, int samples) const noexcept {
    if constexpr (activates_pack<Layer, Pack>) {
      const Activate<Layer> activate;
      for (int i = 0; i < samples * stride; i += Pack::width) activate(Pack::load(x + i)).store(y + i);
    } else {
      for (int i = 0; i < samples; ++i) Layer::forward(nullptr, x + i * stride, y + i * stride);
    }
  }
  void backward(const Scalar* x, const Scalar* y, const Scalar* delta, Scalar* previous, int samples) noexcept {
    if (previous == nullptr) return;
    const Scalar* seen = in_place ? y : x;
    constexpr int step = scales_pack<Layer, Pack> ? Pack::width : 1;
    for (int i = 0; i < samples * stride; i += step) {
      if constexpr (scales_pack<Layer, Pack>) {
        scaled_by_slope<Layer>(Pack::load(seen + i), Pack::load(delta + i)).store(previous + i);
      } else {
        previous[i] = scaled_by_slope<Layer>(seen[i], delta[i]);
      }
    }
  }
};

}  // namespace detail

}  // namespace pinnquad
