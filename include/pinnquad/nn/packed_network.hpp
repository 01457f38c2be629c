// SPDX-License-Identifier: MIT
// A network's parameters arranged for the vector unit, and the forward pass over them.
// Packing is done once: at compile time for an exported model, at construction otherwise.
#pragma once

#include "pinnquad/core/finite.hpp"
#include "pinnquad/nn/kernel/column_broadcast.hpp"
#include "pinnquad/nn/kernel/register_layer.hpp"
#include "pinnquad/nn/network.hpp"

namespace pinnquad {

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// How a layer is stored and run from memory to memory; the primary template keeps the layer's own layout and forward pass.
template <class Layer, class Pack>
struct PackedLayer {
  using Scalar = typename Layer::Scalar;
  static constexpr bool dense = false;
  static constexpr int size = padded<Pack>(Layer::parameter_count);
  static constexpr void pack(const Scalar* parameters, Scalar* packed) noexcept {
    for (int i = 0; i < Layer::parameter_count; ++i) packed[i] = parameters[i];
  }
  template <class Activation>
  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* packed, const Scalar* x, Scalar* y,
                                             const Activation&) noexcept {
    Layer::forward(packed, x, y);
  }
};

template <class ScalarType, int In, int Out, class Pack>
struct PackedLayer<DenseLayer<ScalarType, In, Out>, Pack> {
  using Scalar = ScalarType;
  static constexpr bool dense = true;
  static constexpr int size = packed_size<Pack, Out, In>;
  static constexpr void pack(const Scalar* parameters, Scalar* packed) noexcept {
    pack_columns<Pack, Out, In>(parameters, parameters + Out * In, packed);
  }
  template <class Activation>
  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* packed, const Scalar* x, Scalar* y,
                                             const Activation& activation) noexcept {
    multiply_packed<Pack, Out, In>(packed, x, y, activation);
  }
};

/// The activation of an element-wise layer, for a pack or a scalar.
template <class Layer>
struct Activate {
  template <class Value>
  PINNQUAD_ALWAYS_INLINE Value operator()(const Value& v) const noexcept {
    return Layer::activate(v);
  }
};
/// For a forward pass whose layers' outputs nobody asks for. Not called: a reference to registers would cost some of them.
struct KeepNothing {
  static constexpr bool keeps = false;
};
/// Stores each layer's outputs at their offset among the outputs of all layers.
template <class Scalar>
struct KeepOutputs {
  static constexpr bool keeps = true;
  Scalar* kept;
  template <class Values>
  PINNQUAD_ALWAYS_INLINE void operator()(int offset, const Values& values) const noexcept {
    values.store(kept + offset);
  }
};
/// `Size` outputs of a layer in memory.
template <class Scalar, int Size>
struct StoredOutputs {
  const Scalar* values;
  PINNQUAD_ALWAYS_INLINE void store(Scalar* y) const noexcept {
    for (int i = 0; i < Size; ++i) y[i] = values[i];
  }
};

/// Layer `Index` of a network and, where it is dense, the activation behind it.
template <class Network, class Pack, int Index>
struct FusedLayer {
  using Layer = typename Network::template Layer<Index>;
  using Packed = PackedLayer<Layer, Pack>;
  static constexpr bool fused() noexcept {
    if constexpr (Packed::dense && Index + 1 < Network::layer_count) {
      using Next = typename Network::template Layer<Index + 1>;
      return is_elementwise<Next> && activates_pack<Next, Pack>;
    } else {
      return false;
    }
  }
  static constexpr int next = Index + (fused() ? 2 : 1);
  static constexpr bool last = next == Network::layer_count;
  using Activation = std::conditional_t<fused(), Activate<typename Network::template Layer<next - 1>>, Unchanged>;
  /// Of this layer's outputs, activated, among those of all layers of the network.
  static constexpr int outputs_offset = Network::Sizes::outputs_before(next - 1);
};

/// The layers from `Index` on, each from memory to memory: any layer, size and scalar.
template <class Network, class Pack, int Index = 0>
struct MemoryRun {
  using Scalar = typename Network::Scalar;
  using Fused = FusedLayer<Network, Pack, Index>;
  using Packed = typename Fused::Packed;
  using Rest = MemoryRun<Network, Pack, Fused::next>;
  static constexpr int width = padded<Pack>(Network::widest);

  static constexpr int size() noexcept {
    if constexpr (Fused::last) {
      return Packed::size;
    } else {
      return Packed::size + Rest::size();
    }
  }
  static constexpr void pack(const Scalar* parameters, Scalar* packed) noexcept {
    Packed::pack(parameters, packed);
    if constexpr (!Fused::last) Rest::pack(parameters + Fused::Layer::parameter_count, packed + Packed::size);
  }
  template <class Keep>
  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* packed, const Scalar* x, Scalar* y,
                                             const Keep& keep) noexcept {
    alignas(64) Scalar even[width];
    alignas(64) Scalar odd[width];
    forward(packed, x, even, odd, y, keep);
  }
  template <class Keep>
  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* packed, const Scalar* x, Scalar* target, Scalar* other,
                                             Scalar* y, const Keep& keep) noexcept {
    Packed::forward(packed, x, target, typename Fused::Activation{});
    if constexpr (Keep::keeps) keep(Fused::outputs_offset, StoredOutputs<Scalar, Fused::Layer::outputs>{target});
    if constexpr (Fused::last) {
      for (int i = 0; i < Network::outputs; ++i) y[i] = target[i];
    } else {
      Rest::forward(packed + Packed::size, target, other, target, y, keep);
    }
  }
};

/// Layers from `Index` on that are the same, activations included: one, two, ...
template <class Network, class Pack, int Index>
constexpr int count_alike() noexcept {
  using This = FusedLayer<Network, Pack, Index>;
  if constexpr (This::last) {
    return 1;
  } else {
    using Next = FusedLayer<Network, Pack, This::next>;
    if constexpr (std::is_same_v<typename This::Layer, typename Next::Layer> &&
                  std::is_same_v<typename This::Activation, typename Next::Activation>) {
      return 1 + count_alike<Network, Pack, This::next>();
    } else {
      return 1;
    }
  }
}

/// The layers from `Index` on, from register to register: dense layers of float, each with at most one activation, small
/// enough for the registers. Hidden layers that are all the same are a loop.
template <class Network, class Pack, int Index = 0, class Values = MemoryValues<Pack, Network::inputs>>
struct RegisterRun {
  using Fused = FusedLayer<Network, Pack, Index>;
  using Layer = typename Fused::Layer;
  using Activation = typename Fused::Activation;
  using Dense = RegisterLayer<Pack, Layer::outputs, Values>;
  using Result = typename Dense::Result;
  static constexpr int count = std::is_same_v<Values, Result> ? count_alike<Network, Pack, Index>() : 1;
  static constexpr int next = Index + count * (Fused::next - Index);
  static constexpr bool last = next >= Network::layer_count;
  using Rest = RegisterRun<Network, Pack, next, Result>;

  static constexpr int size() noexcept {
    if constexpr (last) {
      return count * Dense::size;
    } else {
      return count * Dense::size + Rest::size();
    }
  }
  static constexpr void pack(const float* parameters, float* packed) noexcept {
    for (int i = 0; i < count; ++i) {
      const float* own = parameters + i * Layer::parameter_count;
      Dense::pack(own, own + Layer::weight_count, packed + i * Dense::size);
    }
    if constexpr (!last) Rest::pack(parameters + count * Layer::parameter_count, packed + count * Dense::size);
  }
  template <class Keep>
  static PINNQUAD_ALWAYS_INLINE void forward(const float* packed, const Values& x, float* y,
                                             const Keep& keep) noexcept {
    const Result result = multiply(packed, x, keep);
    if constexpr (Keep::keeps && count == 1) keep(Fused::outputs_offset, result);
    if constexpr (last) {
      result.store(y);
    } else {
      Rest::forward(packed + count * Dense::size, result, y, keep);
    }
  }
  template <class Keep>
  static PINNQUAD_ALWAYS_INLINE void forward(const float* packed, const float* x, float* y, const Keep& keep) noexcept {
    forward(packed, Values{x}, y, keep);
  }

 private:
  template <class Keep>
  static PINNQUAD_ALWAYS_INLINE Result multiply(const float* packed, const Values& x, const Keep& keep) noexcept {
    if constexpr (count == 1) {
      return Dense::multiply(packed, x, Activation{});
    } else {
      constexpr int step = Network::Sizes::outputs_before(Fused::next) - Network::Sizes::outputs_before(Index);
      Result result = x;
      for (int i = 0; i < count; ++i) {
        result = Dense::multiply(packed + i * Dense::size, result, Activation{});
        if constexpr (Keep::keeps) keep(Fused::outputs_offset + i * step, result);
      }
      return result;
    }
  }
};

/// True for activations that go through a pack lane by lane: registers hold a value in several lanes, so each would be worked
/// out several times.
template <class Activation, class = void>
inline constexpr bool lane_by_lane = false;
template <class Layer>
inline constexpr bool lane_by_lane<Activate<Layer>, std::void_t<decltype(Layer::lane_by_lane)>> = Layer::lane_by_lane;

/// Dense layers up to this many inputs and outputs run in registers; behind it the unrolled code outgrows its use.
inline constexpr int largest_in_registers = 40;

/// True if all layers from `Index` on can be a RegisterRun.
template <class Network, class Pack, int Index = 0>
constexpr bool fits_registers() noexcept {
  using Fused = FusedLayer<Network, Pack, Index>;
  if constexpr (!keeps_layers_in_registers<Pack> || !Fused::Packed::dense || lane_by_lane<typename Fused::Activation> ||
                Fused::Layer::inputs > largest_in_registers || Fused::Layer::outputs > largest_in_registers) {
    return false;
  } else if constexpr (Fused::last) {
    return true;
  } else {
    return fits_registers<Network, Pack, Fused::next>();
  }
}

template <class Network, class Pack, bool InRegisters = fits_registers<Network, Pack>()>
struct ChooseRun {
  using type = RegisterRun<Network, Pack>;
};
template <class Network, class Pack>
struct ChooseRun<Network, Pack, false> {
  using type = MemoryRun<Network, Pack>;
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// A forward pass for batch 1 at the speed of the vector unit. Results agree with Network::forward to rounding: the sums are
/// taken in several chains. NaN in an input reaches every output that depends on it.
/// Aligned to 64 bytes, and so is what holds one: statics, the stack and C++17's operator new see to it; memory of malloc or an
/// RTOS must be aligned by whoever places one there.
template <class NetworkType, class PackType = NativePack<typename NetworkType::Scalar>>
class PackedNetwork {
  static_assert(is_network<NetworkType>, "pinnquad: PackedNetwork<N> needs a Network (nn/network.hpp)");

 public:
  using Scalar = typename NetworkType::Scalar;
  using Pack = PackType;

  /// All weights zero.
  constexpr PackedNetwork() noexcept = default;
  constexpr explicit PackedNetwork(const typename NetworkType::Parameters& parameters) noexcept
      : PackedNetwork(parameters.data()) {}
  /// From `parameter_count` scalars in the network's own layout.
  constexpr explicit PackedNetwork(const Scalar* parameters) noexcept { assign(parameters); }

  /// Packs other parameters in place.
  constexpr void assign(const Scalar* parameters) noexcept { Run::pack(parameters, packed_); }

  /// y[0, outputs) = network(x[0, inputs)).
  PINNQUAD_ALWAYS_INLINE void forward(const Scalar* x, Scalar* y) const noexcept {
    Run::forward(packed_, x, y, detail::KeepNothing{});
  }
  /// The same; each layer's outputs are left in `kept`, layer by layer as Sizes::outputs_before() counts them. The outputs of a
  /// layer whose activation is fused into it are not written.
  PINNQUAD_ALWAYS_INLINE void forward_keeping(const Scalar* x, Scalar* y, Scalar* kept) const noexcept {
    Run::forward(packed_, x, y, detail::KeepOutputs<Scalar>{kept});
  }

  /// True if no weight is NaN or infinite, on the bits.
  PINNQUAD_ALWAYS_INLINE bool finite() const noexcept { return all_finite(packed_, Run::size()); }

 private:
  using Run = typename detail::ChooseRun<NetworkType, Pack>::type;

  alignas(64) Scalar packed_[static_cast<unsigned>(Run::size())] = {};
};

}  // namespace PINNQUAD_INSTRUCTION_SET

}  // namespace pinnquad
