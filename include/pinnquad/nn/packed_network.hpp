// SPDX-License-Identifier: MIT
// A network's parameters arranged for the vector unit, and the forward pass over them.
// Packing is done once: at compile time for an exported model, at construction otherwise.
#pragma once

#include <cstddef>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/nn/kernel/column_broadcast.hpp"
#include "pinnquad/nn/kernel/register_layer.hpp"
#include "pinnquad/nn/network.hpp"

namespace pinnquad {

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// How a layer is stored and run from memory to memory; the primary template keeps the layer's own layout and forward
/// pass.
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

/// The layers' outputs are dropped. Not called: a reference to registers would cost some of them.
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

/// Kernel of PackedLayer: a dense layer passes its sums through an activation that takes a pack.
template <class Pack>
struct PackedKernel {
  template <class Layer, class Elementwise>
  static constexpr bool fuses = PackedLayer<Layer, Pack>::dense&& activates_pack<Elementwise, Pack>;
};

/// True where the inputs of an activation are kept too: its slope needs them.
template <class Keep, class Activation>
constexpr bool keeps_sums() noexcept {
  if constexpr (Keep::keeps && !std::is_void_v<Activation>) {
    return slopes_from_input<Activation>;
  } else {
    return false;
  }
}

/// The steps of a network, each from memory to memory: any layer, size and scalar.
template <class Network, class Pack>
struct MemoryRun {
  using Scalar = typename Network::Scalar;
  using Kernel = PackedKernel<Pack>;
  using Sizes = typename Network::Sizes;
  static constexpr int width = padded<Pack>(Network::widest);

  static constexpr int size() noexcept { return walk_forward<Network, Kernel>(CountSize{}, 0); }
  static constexpr void pack(const Scalar* parameters, Scalar* packed) noexcept {
    walk_forward<Network, Kernel>(Arrange{{}, parameters}, packed);
  }
  template <class X, class Keep>
  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* packed, const X& x, Scalar* y, const Keep& keep) noexcept {
    if constexpr (std::is_same_v<X, InRow<Scalar>>) {
      forward(packed, x.x, y, keep);
    } else {
      Scalar row[static_cast<unsigned>(Network::inputs)];
      for (int i = 0; i < Network::inputs; ++i) row[i] = x[i];
      forward(packed, static_cast<const Scalar*>(row), y, keep);
    }
  }

 private:
  template <class Keep>
  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* packed, const Scalar* x, Scalar* y,
                                             const Keep& keep) noexcept {
    alignas(64) Scalar even[static_cast<std::size_t>(width)];
    alignas(64) Scalar odd[static_cast<std::size_t>(width)];
    const At end = walk_forward<Network, Kernel>(Forward<Keep>{{}, keep}, At{packed, x, even, odd});
    for (int i = 0; i < Network::outputs; ++i) y[i] = end.x[i];
  }

  struct CountSize : StepByStep {
    template <class Step>
    constexpr int visit(int size) const noexcept {
      return size + PackedLayer<typename Step::Layer, Pack>::size;
    }
  };
  struct Arrange : StepByStep {
    const Scalar* parameters;
    template <class Step>
    constexpr Scalar* visit(Scalar* packed) const noexcept {
      using Packed = PackedLayer<typename Step::Layer, Pack>;
      Packed::pack(parameters + Step::parameters_offset, packed);
      return packed + Packed::size;
    }
  };

  /// Weights and inputs of a step, and the two buffers: it writes to `target`.
  struct At {
    const Scalar* packed;
    const Scalar* x;
    Scalar* target;
    Scalar* other;
  };
  template <class Keep>
  struct Forward : StepByStep {
    const Keep& keep;
    template <class Step>
    PINNQUAD_ALWAYS_INLINE At visit(const At& at) const noexcept {
      using Activation = typename Step::Activation;
      using Packed = PackedLayer<typename Step::Layer, Pack>;
      constexpr int outputs = Step::Layer::outputs;
      if constexpr (keeps_sums<Keep, Activation>()) {
        Packed::forward(at.packed, at.x, at.target, Activate<void>{});
        keep(Step::sums_offset, StoredOutputs<Scalar, outputs>{at.target});
        for (int i = 0; i < padded<Pack>(outputs); i += Pack::width) {
          Activate<Activation>{}(Pack::load(at.target + i)).store(at.target + i);
        }
      } else {
        Packed::forward(at.packed, at.x, at.target, Activate<Activation>{});
      }
      if constexpr (Keep::keeps) {
        keep(Step::outputs_offset, StoredOutputs<Scalar, outputs>{at.target});
      }
      return {at.packed + Packed::size, at.target, at.other, at.target};
    }
  };
};

/// The steps of a network, from register to register: dense layers, each with at most one activation, small
/// enough for the registers. Hidden layers that are all the same are a loop.
template <class Network, class Pack>
struct RegisterRun {
  using Scalar = typename Network::Scalar;
  using Kernel = PackedKernel<Pack>;
  using Sizes = typename Network::Sizes;

  static constexpr int size() noexcept {
    return walk_forward<Network, Kernel>(CountSize{}, Count<FirstValues>{0}).size;
  }
  static constexpr void pack(const Scalar* parameters, Scalar* packed) noexcept {
    walk_forward<Network, Kernel>(Arrange{{}, parameters}, Place<FirstValues>{packed});
  }
  template <class X, class Keep>
  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* packed, const X& x, Scalar* y, const Keep& keep) noexcept {
    run<0>(packed, MemoryValues<Pack, Network::inputs, X>{x}, y, keep);
  }

 private:
  using FirstValues = MemoryValues<Pack, Network::inputs, InRow<Scalar>>;
  template <class Step, class State>
  using Dense = RegisterLayer<Pack, Step::Layer::outputs, typename State::Values>;

  /// A layer that gives its values as it takes them is followed by the next one alike in a loop.
  struct Loops {
    template <class Step, class State>
    static constexpr int together = std::is_same_v<typename State::Values, typename Dense<Step, State>::Result>
                                        ? Step::count_alike()
                                        : 1;
  };

  template <class ValuesType>
  struct Count {
    using Values = ValuesType;
    int size;
  };
  struct CountSize : Loops {
    template <class Step, class State>
    constexpr auto visit(const State& state) const noexcept {
      using Layer = Dense<Step, State>;
      return Count<typename Layer::Result>{state.size + Loops::template together<Step, State> * Layer::size};
    }
  };

  template <class ValuesType>
  struct Place {
    using Values = ValuesType;
    Scalar* packed;
  };
  struct Arrange : Loops {
    const Scalar* parameters;
    template <class Step, class State>
    constexpr auto visit(const State& state) const noexcept {
      using Layer = Dense<Step, State>;
      constexpr int count = Loops::template together<Step, State>;
      for (int i = 0; i < count; ++i) {
        const Scalar* own = parameters + Step::parameters_offset + i * Step::Layer::parameter_count;
        Layer::pack(own, own + Step::Layer::weight_count, state.packed + i * Layer::size);
      }
      return Place<typename Layer::Result>{state.packed + count * Layer::size};
    }
  };

  /// The steps from `Index` on, as walk_forward() takes them. Handed on from call to call: values returned from visit
  /// to visit would cost registers.
  template <int Index, class Values, class Keep>
  static PINNQUAD_ALWAYS_INLINE void run(const Scalar* packed, const Values& x, Scalar* y, const Keep& keep) noexcept {
    using Here = Step<Network, Kernel, Index>;
    using Layer = RegisterLayer<Pack, Here::Layer::outputs, Values>;
    constexpr int count = Loops::template together<Here, Place<Values>>;
    const typename Layer::Result result = multiply<Here, count>(packed, x, keep);
    if constexpr (Here::ends_with(count)) {
      result.store(y);
    } else {
      run<Index + count * Here::advance>(packed + count * Layer::size, result, y, keep);
    }
  }
  template <class Here, int Count, class Values, class Keep>
  static PINNQUAD_ALWAYS_INLINE auto multiply(const Scalar* packed, const Values& x, const Keep& keep) noexcept {
    using Layer = RegisterLayer<Pack, Here::Layer::outputs, Values>;
    using Activation = typename Here::Activation;
    constexpr int stride = Sizes::outputs_before(Here::next) - Sizes::outputs_before(Here::index);
    if constexpr (keeps_sums<Keep, Activation>()) {
      return in_turn<Layer, Count>(x, [&](const auto& values, int turn) PINNQUAD_INLINE_LAMBDA {
        auto result = Layer::multiply(packed + turn * Layer::size, values, Activate<void>{});
        keep(Here::sums_offset + turn * stride, result);
        result.apply(Activate<Activation>{});
        keep(Here::outputs_offset + turn * stride, result);
        return result;
      });
    } else if constexpr (Count == 1) {
      const typename Layer::Result result = Layer::multiply(packed, x, Activate<Activation>{});
      if constexpr (Keep::keeps) keep(Here::outputs_offset, result);
      return result;
    } else {
      typename Layer::Result result = x;
      for (int i = 0; i < Count; ++i) {
        result = Layer::multiply(packed + i * Layer::size, result, Activate<Activation>{});
        if constexpr (Keep::keeps) keep(Here::outputs_offset + i * stride, result);
      }
      return result;
    }
  }
  template <class Layer, int Count, class Values, class Turn>
  static PINNQUAD_ALWAYS_INLINE typename Layer::Result in_turn(const Values& x, const Turn& turn) noexcept {
    if constexpr (Count == 1) {
      return turn(x, 0);
    } else {
      typename Layer::Result result = x;
      for (int i = 0; i < Count; ++i) result = turn(result, i);
      return result;
    }
  }
};

/// Dense layers up to this many inputs and outputs run in registers; beyond it the unrolled code is too large.
inline constexpr int largest_in_registers = 40;

/// Whether all steps of a network can be a RegisterRun. Registers hold a value in several lanes: an activation lane by
/// lane would be computed several times.
template <class Pack>
struct FitsRegisters : StepByStep {
  template <class Step>
  constexpr bool visit(bool fits) const noexcept {
    using Layer = typename Step::Layer;
    return fits && PackedLayer<Layer, Pack>::dense && !is_lane_by_lane<typename Step::Activation> &&
           Layer::inputs <= largest_in_registers && Layer::outputs <= largest_in_registers;
  }
};
template <class Network, class Pack>
constexpr bool fits_registers() noexcept {
  return walk_forward<Network, PackedKernel<Pack>>(FitsRegisters<Pack>{}, keeps_layers_in_registers<Pack>);
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// A forward pass for batch 1 at the speed of the vector unit. Results agree with Network::forward to rounding: the
/// sums are taken in several chains. NaN in an input reaches every output that depends on it. Aligned to 64 bytes, and
/// so is what holds one: statics, the stack and C++17's operator new see to it; memory of malloc or an RTOS must be
/// aligned by whoever places one there.
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
    forward_of(detail::InRow<Scalar>{x}, y);
  }
  /// The same for inputs that stand anywhere: `X` is as InRow (nn/kernel/register_layer.hpp).
  template <class X>
  PINNQUAD_ALWAYS_INLINE void forward_of(const X& x, Scalar* y) const noexcept {
    Run::forward(packed_, x, y, detail::KeepNothing{});
  }
  /// The same; each layer's outputs are left in `kept`, layer by layer as Sizes::outputs_before() counts them. The
  /// outputs of a layer whose activation is fused into it are written only where the activation slopes_from_input.
  PINNQUAD_ALWAYS_INLINE void forward_keeping(const Scalar* x, Scalar* y, Scalar* kept) const noexcept {
    Run::forward(packed_, detail::InRow<Scalar>{x}, y, detail::KeepOutputs<Scalar>{kept});
  }

  /// True if no weight is NaN or infinite, on the bits.
  PINNQUAD_ALWAYS_INLINE bool finite() const noexcept { return all_finite(packed_, Run::size()); }

 private:
  using Run = std::conditional_t<detail::fits_registers<NetworkType, Pack>(), detail::RegisterRun<NetworkType, Pack>,
                                 detail::MemoryRun<NetworkType, Pack>>;

  alignas(64) Scalar packed_[static_cast<unsigned>(Run::size())] = {};
};

}  // namespace PINNQUAD_INSTRUCTION_SET

}  // namespace pinnquad
