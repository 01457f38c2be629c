// SPDX-License-Identifier: MIT
// A layer over a mini-batch: activations are [sample][padded width], parameters stand as the kernels want them.
// Dense uses register tiles, element-wise layers work in place, any other layer runs its BackwardRule sample by sample.
// Only a layer with `whole_tiles` is run on padding rows too, and finds zeros there (network_gradient.hpp).
#pragma once

#include "pinnquad/nn/kernel/tile.hpp"
#include "pinnquad/training/backward.hpp"

namespace pinnquad {

/// Any layer, sample by sample. The optimiser sees `stored` and `gradient`: flat arrays of `size` scalars.
template <class Layer, class Pack, int BatchSize, class = void>
struct BatchLayer {
  static_assert(is_trainable<Layer>,
                "pinnquad: this layer cannot be trained; specialise BackwardRule (training/backward.hpp)");
  static_assert(is_noexcept_backward<Layer>,
                "pinnquad: a BackwardRule's backward() must be noexcept (training/backward.hpp)");
  using Scalar = typename Layer::Scalar;
  static constexpr bool in_place = false;
  static constexpr bool needs_output = true;      ///< backward() reads y: it may not be overwritten
  static constexpr bool couples_samples = false;  ///< outputs depend on the other samples of the batch (batch_norm.hpp)
  static constexpr bool whole_tiles = false;      ///< `samples` has to be a multiple of the pack's tile_rows
  static constexpr int size = padded<Pack>(Layer::parameter_count);
  static constexpr int x_stride = padded<Pack>(Layer::inputs);
  static constexpr int y_stride = padded<Pack>(Layer::outputs);

  alignas(64) Scalar stored[size > 0 ? size : 1] = {};
  alignas(64) Scalar gradient[size > 0 ? size : 1] = {};

  void load(const Scalar* parameters) noexcept {
    for (int i = 0; i < Layer::parameter_count; ++i) stored[i] = parameters[i];
  }
  void store(Scalar* parameters) const noexcept {
    for (int i = 0; i < Layer::parameter_count; ++i) parameters[i] = stored[i];
  }
  void store_gradient(Scalar* parameters) const noexcept {
    for (int i = 0; i < Layer::parameter_count; ++i) parameters[i] = gradient[i];
  }
  void refresh() noexcept {}

  void forward(const Scalar* x, Scalar* y, int samples) const noexcept {
    for (int i = 0; i < samples; ++i) Layer::forward(stored, x + i * x_stride, y + i * y_stride);
  }
  /// `delta` holds dy; dx goes to `previous` (which may be null for the first layer).
  void backward(const Scalar* x, const Scalar* y, const Scalar* delta, Scalar* previous, int samples) noexcept {
    for (Scalar& g : gradient) g = Scalar(0);
    Scalar scratch[x_stride] = {};
    for (int i = 0; i < samples; ++i) {
      Scalar* dx = previous != nullptr ? previous + i * x_stride : scratch;
      BackwardRule<Layer>::backward(stored, x + i * x_stride, y + i * y_stride, delta + i * y_stride, dx, gradient);
    }
  }
};

namespace detail {

/// Dense: weights stand input by input, each row padded, the bias (if any) as last row; a transposed copy serves dX.
template <class Scalar, int In, int Out, bool HasBias, class Pack>
struct BatchDense {
  static constexpr bool in_place = false;
  static constexpr bool needs_output = false;
  static constexpr bool couples_samples = false;
  static constexpr bool whole_tiles = true;
  static constexpr int x_stride = padded<Pack>(In);
  static constexpr int y_stride = padded<Pack>(Out);
  static constexpr int size = (In + (HasBias ? 1 : 0)) * y_stride;

  alignas(64) Scalar stored[size] = {};  // [input][output], then the bias
  alignas(64) Scalar gradient[size] = {};
  alignas(64) Scalar by_output[Out * x_stride] = {};  // [output][input]

  void load(const Scalar* parameters) noexcept {
    for (int out = 0; out < Out; ++out) {
      for (int in = 0; in < In; ++in) stored[in * y_stride + out] = parameters[out * In + in];
      if constexpr (HasBias) stored[In * y_stride + out] = parameters[Out * In + out];
    }
    refresh();
  }
  void store(Scalar* parameters) const noexcept { gather(stored, parameters); }
  void store_gradient(Scalar* parameters) const noexcept { gather(gradient, parameters); }
  /// Call after `stored` was changed.
  void refresh() noexcept {
    for (int out = 0; out < Out; ++out) {
      for (int in = 0; in < In; ++in) by_output[out * x_stride + in] = stored[in * y_stride + out];
    }
  }

  void forward(const Scalar* x, Scalar* y, int samples) const noexcept {
    multiply_batch<Pack, x_stride, y_stride>(x, stored, In, HasBias ? stored + In * y_stride : nullptr, y, samples);
  }
  void backward(const Scalar* x, const Scalar*, const Scalar* delta, Scalar* previous, int samples) noexcept {
    multiply_transposed<Pack, In, x_stride, y_stride>(x, delta, samples, gradient);
    if constexpr (HasBias) {
      constexpr int vectors = y_stride / Pack::width;
      Pack sum[vectors];
      for (Pack& s : sum) s = Pack::broadcast(Scalar(0));
      for (int i = 0; i < samples; ++i) {
        unroll<vectors>([&](auto v) PINNQUAD_INLINE_LAMBDA {
          sum[v] = sum[v] + Pack::load(delta + i * y_stride + v * Pack::width);
        });
      }
      for (int v = 0; v < vectors; ++v) sum[v].store(gradient + In * y_stride + v * Pack::width);
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

}  // namespace detail

template <class Scalar, int In, int Out, bool HasBias, class Pack, int BatchSize>
struct BatchLayer<DenseLayer<Scalar, In, Out, HasBias>, Pack, BatchSize, void>
    : detail::BatchDense<Scalar, In, Out, HasBias, Pack> {};

/// Element-wise, with a slope from the output: forward works on its own buffer or on that of the layer before, dx
/// overwrites dy. The padding columns of both may hold anything: no layer reads them into a real column. With a slope
/// from the input, the input is left as it is, and dx goes to a buffer of its own.
template <class Layer, class Pack, int BatchSize>
struct BatchLayer<Layer, Pack, BatchSize, std::enable_if_t<is_elementwise<Layer>>> {
  static_assert(is_trainable<Layer>,
                "pinnquad: this layer cannot be trained; an element-wise layer needs slope(y) or slope_from_input(v) "
                "(nn/layer.hpp)");
  using Scalar = typename Layer::Scalar;
  static constexpr bool in_place = !slopes_from_input<Layer>;  ///< if the layer before does not need its output
  static constexpr bool needs_output = in_place;
  static constexpr bool couples_samples = false;
  static constexpr bool whole_tiles = false;
  static constexpr int size = 0;
  static constexpr int stride = padded<Pack>(Layer::outputs);

  void load(const Scalar*) noexcept {}
  void store(Scalar*) const noexcept {}
  void store_gradient(Scalar*) const noexcept {}
  void refresh() noexcept {}

  void forward(Scalar* values, int samples) const noexcept { forward(values, values, samples); }
  void forward(const Scalar* x, Scalar* y, int samples) const noexcept {
    if constexpr (activates_pack<Layer, Pack>) {
      const detail::Activate<Layer> activate;
      for (int i = 0; i < samples * stride; i += Pack::width) activate(Pack::load(x + i)).store(y + i);
    } else {
      for (int i = 0; i < samples; ++i) Layer::forward(nullptr, x + i * stride, y + i * stride);
    }
  }
  void backward(const Scalar* y, Scalar* delta, int samples) noexcept { scale(y, delta, delta, samples); }
  /// `delta` holds dy; dx goes to `previous` (which may be null for the first layer).
  void backward(const Scalar* x, const Scalar*, const Scalar* delta, Scalar* previous, int samples) noexcept {
    if (previous != nullptr) scale(x, delta, previous, samples);
  }

 private:
  static void scale(const Scalar* seen, const Scalar* dy, Scalar* dx, int samples) noexcept {
    constexpr int step = scales_pack<Layer, Pack> ? Pack::width : 1;
    for (int i = 0; i < samples * stride; i += step) {
      if constexpr (scales_pack<Layer, Pack>) {
        detail::scaled_by_slope<Layer>(Pack::load(seen + i), Pack::load(dy + i)).store(dx + i);
      } else {
        dx[i] = detail::scaled_by_slope<Layer>(seen[i], dy[i]);
      }
    }
  }
};

}  // namespace pinnquad
