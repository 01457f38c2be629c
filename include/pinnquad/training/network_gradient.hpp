// SPDX-License-Identifier: MIT
// Forward and backward pass of a whole network over a mini-batch. No heap; holds its own activations.
#pragma once

#include <cstddef>
#include <tuple>
#include <utility>

#include "pinnquad/nn/network.hpp"
#include "pinnquad/training/backward.hpp"
#include "pinnquad/training/batch_norm.hpp"

namespace pinnquad {

namespace detail {

/// Activations of one layer, [feature][sample]; empty for layers that work in the buffer of the layer before.
template <class Scalar, int Size>
struct ActivationBuffer {
  alignas(64) Scalar values[static_cast<std::size_t>(Size)] = {};
};
template <class Scalar>
struct ActivationBuffer<Scalar, 0> {};

/// Gradient of a scalar loss by all parameters, for up to BatchSize samples.
/// Use: put() standardised samples, forward(n), output_delta() <- dL/dy, backward(n), then each layer's `gradient`.
template <class NetworkType, int BatchSize, class PackType = pinnquad::NativePack<typename NetworkType::Scalar>>
class NetworkGradient {
 public:
  using Scalar = typename NetworkType::Scalar;
  using Pack = PackType;
  static constexpr int capacity = batch_capacity<Pack, BatchSize>;

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

  /// Inputs of the next pass: `samples` of them (1 to `capacity`), one after the other. The lanes of a pack that they
  /// leave over repeat the last.
  void put(const Scalar* x, int samples) noexcept {
    transpose<Pack>(x, NetworkType::inputs, samples, NetworkType::inputs, input_, capacity);
    for (int k = 0; k < NetworkType::inputs; ++k) {
      Scalar* const row = input_ + k * capacity;
      for (int i = samples; i < padded<Pack>(samples); ++i) row[i] = row[samples - 1];
    }
  }
  Scalar output(int k, int sample) const noexcept {
    return const_cast<NetworkGradient*>(this)->template activations<last>()[k * capacity + sample];
  }
  /// dL/dy of one sample.
  Scalar& output_delta(int k, int sample) noexcept { return delta_[0][k * capacity + sample]; }

  /// Outputs of the samples put, batch norm by their statistics.
  void forward(int samples) noexcept { walk_forward<NetworkType, Kernel>(Forward<true>{{}, *this}, samples); }

  /// The same with batch norm's running statistics: outputs of the network as it will fly. backward() does not fit
  /// this pass.
  void predict(int samples) noexcept { walk_forward<NetworkType, Kernel>(Forward<false>{{}, *this}, samples); }

  /// Running statistics follow the batch of the last forward().
  void follow_statistics() noexcept {
    each([&](auto& layer, auto) {
      if constexpr (std::decay_t<decltype(layer)>::couples_samples) layer.follow_statistics();
    });
  }

  /// Gradients of all layers.
  void backward(int samples) noexcept {
    walk_back<NetworkType, SlopeKernel>(Backward{{}, *this, samples}, Deltas{delta_[0], delta_[1]});
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
  /// Back, such a layer runs with the layer behind it where that takes its slope.
  struct SlopeKernel {
    template <class NetworkLayer, class Elementwise>
    static constexpr bool fuses = BatchLayer<NetworkLayer, Pack, BatchSize>::fuses_slope&&
        BatchLayer<Elementwise, Pack, BatchSize>::in_place&& scales_pack<Elementwise, Pack>;
  };
  /// True for a layer in the buffer of the layer before it, or of the inputs.
  template <int Index>
  static constexpr bool overwrites() noexcept {
    return runs_with_layer_before<NetworkType, Kernel, Index>() || (Index == 0 && Layer<Index>::in_place);
  }
  template <int Index>
  static constexpr int buffer_size = NetworkType::template Layer<Index>::outputs* capacity;
  template <class Indices>
  struct BuffersOf;
  template <int... Index>
  struct BuffersOf<std::integer_sequence<int, Index...>> {
    using type = std::tuple<ActivationBuffer<Scalar, overwrites<Index>() ? 0 : buffer_size<Index>>...>;
  };
  using Buffers = typename BuffersOf<std::make_integer_sequence<int, layer_count>>::type;

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
      using Activation = typename Step::Activation;
      constexpr int index = Step::index;
      Scalar* values = of.template activations<index>();
      if constexpr (!Layer<index>::fuses_activation) {
        of.template run<index, Training>(samples);
      } else if constexpr (std::is_void_v<Activation> || activates_pack<Activation, Pack>) {
        of.template run<index, Training>(samples, Activate<Activation>{});
        return samples;
      } else {
        of.template run<index, Training>(samples, Activate<void>{});
      }
      if constexpr (Step::fused) std::get<index + 1>(of.layers_).forward(values, values, samples);
      return samples;
    }
  };
  template <int Index, bool Training, class... Activation>
  void run(int samples, const Activation&... activation) noexcept {
    auto& layer = std::get<Index>(layers_);
    Scalar* values = activations<Index>();
    if constexpr (Layer<Index>::in_place) {
      if constexpr (!overwrites<Index>()) {
        const Scalar* before = activations<Index - 1>();
        for (int i = 0; i < buffer_size<Index>; ++i) values[i] = before[i];
      }
      layer.forward(values, values, samples);
    } else if constexpr (Layer<Index>::couples_samples && !Training) {
      layer.predict(activations<Index - 1>(), values, samples, activation...);
    } else {
      layer.forward(activations<Index - 1>(), values, samples, activation...);
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
      const Scalar* values = of.template activations<index>();
      if constexpr (Layer<index>::in_place) {
        layer.backward(values, values, delta.here, delta.here, samples);
        return delta;
      } else {
        const Scalar* x = of.template activations<index - 1>();
        Scalar* previous = index > 0 ? delta.other : nullptr;
        if constexpr (Layer<index>::fuses_slope) {
          layer.backward(x, delta.here, previous, samples, ScaleBySlope<typename Step::Activation>{});
        } else {
          layer.backward(x, values, delta.here, previous, samples);
        }
        return {delta.other, delta.here};
      }
    }
  };

  Layers layers_{};
  Buffers buffers_{};
  alignas(64) Scalar input_[NetworkType::inputs * capacity] = {};
  alignas(64) Scalar delta_[2][NetworkType::widest * capacity] = {};
};

}  // namespace detail

}  // namespace pinnquad
