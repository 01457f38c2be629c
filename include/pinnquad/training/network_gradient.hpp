// SPDX-License-Identifier: MIT
// Forward and backward pass of a whole network over a mini-batch. No heap; holds its own activations.
#pragma once

#include <tuple>

#include "pinnquad/nn/network.hpp"
#include "pinnquad/training/batch_layer.hpp"
#include "pinnquad/training/batch_norm.hpp"

namespace pinnquad {

namespace detail {
template <class Layers, class Pack, int BatchSize>
struct BatchLayers;
template <class... Layers, class Pack, int BatchSize>
struct BatchLayers<std::tuple<Layers...>, Pack, BatchSize> {
  using type = std::tuple<BatchLayer<Layers, Pack, BatchSize>...>;
};

/// Activations of one layer, [sample][padded width]; empty for layers that work in the buffer of the layer before.
template <class Scalar, int Size>
struct ActivationBuffer {
  alignas(64) Scalar values[Size] = {};
};
template <class Scalar>
struct ActivationBuffer<Scalar, 0> {};

}  // namespace detail

/// Gradient of a scalar loss by all parameters, for up to BatchSize samples.
/// Tiles may be wider than the batch. The rows past its samples are zeros in every activation and in every dL/dy, and only
/// Dense, which makes 0 of them, is run on them: they add nothing to a gradient, whatever a layer gives for an input of zeros.
/// Use: input() <- standardised samples, forward(n), output_delta() <- dL/dy, backward(n), then each layer's `gradient`.
template <class NetworkType, int BatchSize, class PackType = NativePack<typename NetworkType::Scalar>>
class NetworkGradient {
 public:
  using Scalar = typename NetworkType::Scalar;
  using Pack = PackType;
  static constexpr int capacity = (BatchSize + Pack::tile_rows - 1) / Pack::tile_rows * Pack::tile_rows;
  static constexpr int input_stride = padded<Pack>(NetworkType::inputs);
  static constexpr int output_stride = padded<Pack>(NetworkType::outputs);

  void load(const typename NetworkType::Parameters& parameters) noexcept {
    each([&](auto& layer, auto index) { layer.load(parameters.data() + NetworkType::Sizes::offset(index)); });
  }
  void store(typename NetworkType::Parameters& parameters) const noexcept {
    each([&](const auto& layer, auto index) { layer.store(parameters.data() + NetworkType::Sizes::offset(index)); });
  }
  /// The gradient in the layout of the parameters.
  void store_gradient(typename NetworkType::Parameters& gradient) const noexcept {
    each([&](const auto& layer, auto index) {
      layer.store_gradient(gradient.data() + NetworkType::Sizes::offset(index));
    });
  }

  Scalar* input(int sample) noexcept { return input_ + sample * input_stride; }
  const Scalar* output(int sample) const noexcept {
    return const_cast<NetworkGradient*>(this)->template activations<last>() + sample * output_stride;
  }
  /// dL/dy of one sample; the whole row up to output_stride is the network's, entries past `outputs` stay zero.
  Scalar* output_delta(int sample) noexcept { return delta_[0] + sample * output_stride; }

  /// Outputs of the first `samples` inputs (at most `capacity`), batch norm by the statistics of these samples.
  void forward(int samples) noexcept {
    clear_padding(input_, input_stride, samples);
    forward_from<0, true>(samples);
  }

  /// The same with batch norm's running statistics: outputs of the network as it will fly. backward() does not fit this pass.
  void predict(int samples) noexcept {
    clear_padding(input_, input_stride, samples);
    forward_from<0, false>(samples);
  }

  /// Running statistics follow the batch of the last forward().
  void follow_statistics() noexcept {
    each([&](auto& layer, auto) {
      if constexpr (std::decay_t<decltype(layer)>::couples_samples) layer.follow_statistics();
    });
  }

  /// Gradients of all layers.
  void backward(int samples) noexcept {
    clear_padding(delta_[0], output_stride, samples);
    backward_from<last>(delta_[0], delta_[1], samples);
  }

  /// function(layer, integral_constant<index>) for every layer.
  template <class Function>
  void each(Function&& function) {
    unroll<layer_count>([&](auto index) { function(std::get<index>(layers_), index); });
  }
  template <class Function>
  void each(Function&& function) const {
    unroll<layer_count>([&](auto index) { function(std::get<index>(layers_), index); });
  }

 private:
  static constexpr int layer_count = NetworkType::layer_count;
  static constexpr int last = layer_count - 1;
  static constexpr int widest = padded<Pack>(NetworkType::widest);
  using Layers = typename detail::BatchLayers<typename NetworkType::Layers, Pack, BatchSize>::type;
  template <int Index>
  using Layer = std::tuple_element_t<static_cast<std::size_t>(Index), Layers>;

  /// An element-wise layer overwrites the output of the layer before, unless that one's backward pass needs it.
  template <int Index>
  static constexpr bool overwrites() noexcept {
    if constexpr (Index == 0) {
      return Layer<Index>::in_place;
    } else {
      return Layer<Index>::in_place && !Layer<Index - 1>::needs_output;
    }
  }
  template <int Index>
  static constexpr int stride = padded<Pack>(NetworkType::template Layer<Index>::outputs);
  template <class Indices>
  struct BuffersOf;
  template <int... Index>
  struct BuffersOf<std::integer_sequence<int, Index...>> {
    using type = std::tuple<detail::ActivationBuffer<Scalar, overwrites<Index>() ? 0 : capacity * stride<Index>>...>;
  };
  using Buffers = typename BuffersOf<std::make_integer_sequence<int, layer_count>>::type;

  static int tiled(int samples) noexcept { return (samples + Pack::tile_rows - 1) / Pack::tile_rows * Pack::tile_rows; }

  static void clear_padding(Scalar* values, int row_stride, int samples) noexcept {
    for (int i = samples * row_stride; i < tiled(samples) * row_stride; ++i) values[i] = Scalar(0);
  }
  template <int Index>
  static int rows_of(int samples) noexcept {
    return Layer<Index>::whole_tiles ? tiled(samples) : samples;
  }

  /// Where a layer's output stands: its own buffer, or that of the layer it works in.
  template <int Index>
  Scalar* activations() noexcept {
    if constexpr (Index < 0) {
      return input_;
    } else if constexpr (overwrites<Index>()) {
      return activations<Index - 1>();
    } else {
      return std::get<Index>(buffers_).values;
    }
  }

  template <int Index, bool Training>
  void forward_from(int samples) noexcept {
    if constexpr (Index < layer_count) {
      auto& layer = std::get<Index>(layers_);
      const int rows = rows_of<Index>(samples);
      Scalar* values = activations<Index>();
      if constexpr (Layer<Index>::in_place) {
        if constexpr (!overwrites<Index>()) {
          const Scalar* before = activations<Index - 1>();
          for (int i = 0; i < rows * stride<Index>; ++i) values[i] = before[i];
        }
        layer.forward(values, rows);
      } else if constexpr (Layer<Index>::couples_samples && !Training) {
        layer.predict(activations<Index - 1>(), values, rows);
      } else {
        layer.forward(activations<Index - 1>(), values, rows);
      }
      clear_padding(values, stride<Index>, samples);
      forward_from<Index + 1, Training>(samples);
    }
  }

  template <int Index>
  void backward_from(Scalar* delta, Scalar* other, int samples) noexcept {
    if constexpr (Index >= 0) {
      auto& layer = std::get<Index>(layers_);
      const int rows = rows_of<Index>(samples);
      if constexpr (Layer<Index>::in_place) {
        layer.backward(activations<Index>(), delta, rows);
        backward_from<Index - 1>(delta, other, samples);
      } else {
        Scalar* previous = Index > 0 ? other : nullptr;
        layer.backward(activations<Index - 1>(), activations<Index>(), delta, previous, rows);
        if constexpr (Index > 0) clear_padding(previous, stride<Index - 1>, samples);
        backward_from<Index - 1>(other, delta, samples);
      }
    }
  }

  Layers layers_{};
  Buffers buffers_{};
  alignas(64) Scalar input_[capacity * input_stride] = {};
  alignas(64) Scalar delta_[2][capacity * widest] = {};
};

}  // namespace pinnquad
