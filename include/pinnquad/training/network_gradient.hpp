// SPDX-License-Identifier: MIT
// Forward and backward pass of a whole network over a mini-batch. No heap; holds its own activations.
#pragma once

#include <tuple>
#include <utility>

#include "pinnquad/nn/network.hpp"
#include "pinnquad/training/backward.hpp"
#include "pinnquad/training/batch_norm.hpp"

namespace pinnquad {

namespace detail {

/// Activations of one layer, [sample][padded width]; empty for layers that work in the buffer of the layer before.
template <class Scalar, int Size>
struct ActivationBuffer {
  alignas(64) Scalar values[Size] = {};
};
template <class Scalar>
struct ActivationBuffer<Scalar, 0> {};

/// Gradient of a scalar loss by all parameters, for up to BatchSize samples.
/// Tiles may be wider than the batch. The rows past its samples are zeros in every activation and in every dL/dy, and
/// only Dense, which makes 0 of them, is run on them: they add nothing to a gradient, whatever a layer gives for an
/// input of zeros. Use: input() <- standardised samples, forward(n), output_delta() <- dL/dy, backward(n), then each
/// layer's `gradient`.
template <class NetworkType, int BatchSize, class PackType = pinnquad::NativePack<typename NetworkType::Scalar>>
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
    walk_forward<NetworkType, Kernel>(Forward<true>{{}, *this}, samples);
  }

  /// The same with batch norm's running statistics: outputs of the network as it will fly. backward() does not fit
  /// this pass.
  void predict(int samples) noexcept {
    clear_padding(input_, input_stride, samples);
    walk_forward<NetworkType, Kernel>(Forward<false>{{}, *this}, samples);
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
    walk_back<NetworkType, FusesNothing>(Backward{{}, *this, samples}, Deltas{delta_[0], delta_[1]});
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
  template <class... Layers>
  static std::tuple<BatchLayer<Layers, Pack, BatchSize>...> batched(const std::tuple<Layers...>&);
  using Layers = decltype(batched(std::declval<typename NetworkType::Layers>()));
  template <int Index>
  using Layer = std::tuple_element_t<static_cast<std::size_t>(Index), Layers>;

  /// An element-wise layer that works in place runs with the layer before it, unless that one's backward pass needs
  /// what it gave.
  struct Kernel {
    template <class NetworkLayer, class Elementwise>
    static constexpr bool fuses =
        !BatchLayer<NetworkLayer, Pack, BatchSize>::needs_output && BatchLayer<Elementwise, Pack, BatchSize>::in_place;
  };
  /// True for a layer in the buffer of the layer before it, or of the inputs.
  template <int Index>
  static constexpr bool overwrites() noexcept {
    return runs_with_layer_before<NetworkType, Kernel, Index>() || (Index == 0 && Layer<Index>::in_place);
  }
  template <int Index>
  static constexpr int stride = padded<Pack>(NetworkType::template Layer<Index>::outputs);
  template <class Indices>
  struct BuffersOf;
  template <int... Index>
  struct BuffersOf<std::integer_sequence<int, Index...>> {
    using type = std::tuple<ActivationBuffer<Scalar, overwrites<Index>() ? 0 : capacity * stride<Index>>...>;
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

  /// A layer, and the one that works in its buffer.
  template <bool Training>
  struct Forward : StepByStep {
    NetworkGradient& of;
    template <class Step>
    int visit(int samples) const noexcept {
      Scalar* values = of.template activations<Step::index>();
      of.template run<Step::index, Training>(samples);
      if constexpr (Step::fused) {
        std::get<Step::index + 1>(of.layers_).forward(values, values, samples);
      }
      clear_padding(values, stride<Step::index>, samples);
      return samples;
    }
  };
  template <int Index, bool Training>
  void run(int samples) noexcept {
    auto& layer = std::get<Index>(layers_);
    const int rows = rows_of<Index>(samples);
    Scalar* values = activations<Index>();
    if constexpr (Layer<Index>::in_place) {
      if constexpr (!overwrites<Index>()) {
        const Scalar* before = activations<Index - 1>();
        for (int i = 0; i < rows * stride<Index>; ++i) values[i] = before[i];
      }
      layer.forward(values, values, rows);
    } else if constexpr (Layer<Index>::couples_samples && !Training) {
      layer.predict(activations<Index - 1>(), values, rows);
    } else {
      layer.forward(activations<Index - 1>(), values, rows);
    }
  }

  /// Gradients by what a layer gave, and the other buffer.
  struct Deltas {
    Scalar* here;
    Scalar* other;
  };
  struct Backward : StepByStep {
    NetworkGradient& of;
    int samples;
    template <class Step>
    Deltas visit(const Deltas& delta) const noexcept {
      constexpr int index = Step::index;
      auto& layer = std::get<index>(of.layers_);
      const int rows = rows_of<index>(samples);
      const Scalar* values = of.template activations<index>();
      if constexpr (Layer<index>::in_place) {
        layer.backward(values, values, delta.here, delta.here, rows);
        return delta;
      } else {
        Scalar* previous = index > 0 ? delta.other : nullptr;
        layer.backward(of.template activations<index - 1>(), values, delta.here, previous, rows);
        if constexpr (index > 0) clear_padding(previous, stride<index - 1>, samples);
        return {delta.other, delta.here};
      }
    }
  };

  Layers layers_{};
  Buffers buffers_{};
  alignas(64) Scalar input_[capacity * input_stride] = {};
  alignas(64) Scalar delta_[2][capacity * widest] = {};
};

}  // namespace detail

}  // namespace pinnquad
