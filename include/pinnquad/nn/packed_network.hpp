// SPDX-License-Identifier: MIT
// A network's parameters arranged for the vector unit, and the forward pass over them.
// Packing is done once: at compile time for an exported model, at construction otherwise.
#pragma once

#include "pinnquad/nn/kernel/column_broadcast.hpp"
#include "pinnquad/nn/network.hpp"

namespace pinnquad {

namespace detail {

/// How a layer is stored and run; the primary template keeps the layer's own layout and forward pass.
template <class Layer, class Pack>
struct PackedLayer {
  using Scalar = typename Layer::Scalar;
  static constexpr int size = Layer::parameter_count;
  static constexpr bool fuses_activation = false;
  static constexpr void pack(const Scalar* parameters, Scalar* packed) noexcept {
    for (int i = 0; i < size; ++i) packed[i] = parameters[i];
  }
  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* packed, const Scalar* x, Scalar* y) noexcept {
    Layer::forward(packed, x, y);
  }
};

template <class Scalar, int In, int Out, class Pack>
struct PackedLayer<DenseLayer<Scalar, In, Out>, Pack> {
  static constexpr int size = packed_size<Pack, Out, In>;
  static constexpr bool fuses_activation = true;
  static constexpr void pack(const Scalar* parameters, Scalar* packed) noexcept {
    pack_columns<Pack, Out, In>(parameters, parameters + Out * In, packed);
  }
  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* packed, const Scalar* x, Scalar* y) noexcept {
    multiply_packed<Pack, Out, In>(packed, x, y, [](Pack v) PINNQUAD_INLINE_LAMBDA { return v; });
  }
  template <class Activation>
  static PINNQUAD_ALWAYS_INLINE void forward_fused(const Scalar* packed, const Scalar* x, Scalar* y) noexcept {
    multiply_packed<Pack, Out, In>(packed, x, y, [](Pack v) PINNQUAD_INLINE_LAMBDA { return Activation::activate(v); });
  }
};

template <class Layers, class Pack>
struct PackedSizes;
template <class... Layers, class Pack>
struct PackedSizes<std::tuple<Layers...>, Pack> {
  static constexpr std::array<int, sizeof...(Layers)> sizes = {PackedLayer<Layers, Pack>::size...};
  static constexpr int offset(int layer) noexcept {
    int sum = 0;
    for (int i = 0; i < layer; ++i) sum += sizes[static_cast<std::size_t>(i)];
    return sum;
  }
};

}  // namespace detail

/// A forward pass for batch 1 at the speed of the vector unit. Results agree with Network::forward to rounding: the sums are
/// taken in several chains.
template <class NetworkType, class PackType = NativePack<typename NetworkType::Scalar>>
class PackedNetwork {
  static_assert(is_network<NetworkType>, "pinnquad: PackedNetwork<N> needs a Network (nn/network.hpp)");

 public:
  using Scalar = typename NetworkType::Scalar;
  using Pack = PackType;

  /// All weights zero.
  constexpr PackedNetwork() noexcept = default;
  constexpr explicit PackedNetwork(const typename NetworkType::Parameters& parameters) noexcept {
    assign(parameters.data());
  }

  /// Packs other parameters, NetworkType::parameter_count of them, in place.
  constexpr void assign(const Scalar* parameters) noexcept { pack<0>(parameters); }

  /// y[0, outputs) = network(x[0, inputs)).
  PINNQUAD_ALWAYS_INLINE void forward(const Scalar* x, Scalar* y) const noexcept {
    alignas(64) Scalar buffer[2][static_cast<std::size_t>(width)];
    run<0>(x, buffer[0], buffer[1], y);
  }

 private:
  using Sizes = detail::PackedSizes<typename NetworkType::Layers, Pack>;
  static constexpr int layer_count = NetworkType::layer_count;
  static constexpr int width = padded<Pack>(NetworkType::widest);

  template <int Index>
  using Packed = detail::PackedLayer<typename NetworkType::template Layer<Index>, Pack>;

  template <int Index>
  constexpr void pack(const Scalar* parameters) noexcept {
    if constexpr (Index < layer_count) {
      Packed<Index>::pack(parameters + NetworkType::Sizes::offset(Index), packed_.data() + Sizes::offset(Index));
      pack<Index + 1>(parameters);
    }
  }

  template <int Index>
  static constexpr bool fused() noexcept {
    if constexpr (Index + 1 < layer_count) {
      using Next = typename NetworkType::template Layer<Index + 1>;
      return Packed<Index>::fuses_activation && is_elementwise<Next> && activates_pack<Next, Pack>;
    } else {
      return false;
    }
  }

  template <int Index>
  PINNQUAD_ALWAYS_INLINE void run(const Scalar* x, Scalar* target, Scalar* other, Scalar* y) const noexcept {
    if constexpr (Index == layer_count) {
      for (int i = 0; i < NetworkType::outputs; ++i) y[i] = x[i];
    } else if constexpr (fused<Index>()) {
      Packed<Index>::template forward_fused<typename NetworkType::template Layer<Index + 1>>(
          packed_.data() + Sizes::offset(Index), x, target);
      run<Index + 2>(target, other, target, y);
    } else {
      Packed<Index>::forward(packed_.data() + Sizes::offset(Index), x, target);
      run<Index + 1>(target, other, target, y);
    }
  }

  alignas(64) std::array<Scalar, static_cast<std::size_t>(Sizes::offset(layer_count))> packed_{};
};

}  // namespace pinnquad
