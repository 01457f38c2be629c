// SPDX-License-Identifier: MIT
// The walk over a network's layers: it fuses layers that run as one, counts equal ones in a row, and visits them in
// order. The forward passes (portable, packed, batched), the Jacobian and training are visitors of it.
#pragma once

#include <type_traits>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Direction of a walk: from the inputs to the outputs, or back.
enum class Way : int { forward = 1, back = -1 };

/// For a walk that visits each layer alone.
struct FusesNothing {
  template <class Layer, class Elementwise>
  static constexpr bool fuses = false;
};

template <bool Exists, class Network, int Index>
struct LayerIf {
  using type = void;
};
template <class Network, int Index>
struct LayerIf<true, Network, Index> {
  using type = typename Network::template Layer<Index>;
};

/// The layers that run as one from `Index` on: this layer and, where the kernel fuses it, the element-wise layer that
/// comes next on the way. A kernel states:
///   template <class Layer, class Elementwise> static constexpr bool fuses;
template <class Network, class Kernel, int Index, Way way = Way::forward>
struct Step {
  static constexpr int index = Index;
  using Layer = typename Network::template Layer<Index>;

  static constexpr bool is_fused() noexcept {
    constexpr int beside = Index + static_cast<int>(way);
    if constexpr (beside < 0 || beside >= Network::layer_count) {
      return false;
    } else if constexpr (!is_elementwise<typename Network::template Layer<beside>>) {
      return false;
    } else {
      return Kernel::template fuses<Layer, typename Network::template Layer<beside>>;
    }
  }
  static constexpr bool fused = is_fused();
  /// Layers that run as one, and how far on the next step stands.
  static constexpr int length = fused ? 2 : 1;
  static constexpr int advance = static_cast<int>(way) * length;
  static constexpr int next = Index + advance;
  static constexpr bool last = next < 0 || next >= Network::layer_count;
  /// The element-wise layer that runs with this one, or void.
  using Activation = typename LayerIf<fused, Network, Index + static_cast<int>(way)>::type;

  // constants, not calls: unoptimised code would emit a function of the network, for whatever instruction set
  /// Place of the layer's parameters among all.
  static constexpr int parameters_offset = Network::Sizes::offset(Index);
  /// Place of the layer's outputs among those of all layers, and of the outputs that the step gives on the way forward.
  static constexpr int sums_offset = Network::Sizes::outputs_before(Index);
  static constexpr int outputs_offset = Network::Sizes::outputs_before(Index + length - 1);

  /// How often the step stands here in a row, its activation included: one, two, ...
  static constexpr int count_alike() noexcept {
    if constexpr (last) {
      return 1;
    } else {
      using Next = Step<Network, Kernel, next, way>;
      if constexpr (std::is_same_v<Layer, typename Next::Layer> &&
                    std::is_same_v<Activation, typename Next::Activation>) {
        return 1 + Next::count_alike();
      } else {
        return 1;
      }
    }
  }
  /// True if the walk is at its end behind `count` of a row.
  static constexpr bool ends_with(int count) noexcept {
    const int behind = Index + count * advance;
    return behind < 0 || behind >= Network::layer_count;
  }
};

/// True if layer `Index` runs with the one before it on the way forward.
template <class Network, class Kernel, int Index>
constexpr bool runs_with_layer_before() noexcept {
  if constexpr (Index == 0) {
    return false;
  } else {
    return !runs_with_layer_before<Network, Kernel, Index - 1>() && Step<Network, Kernel, Index - 1>::fused;
  }
}

/// Takes a visitor from step to step. The visitor turns a state into the next step's, of any type:
///   template <class Step, class State> static constexpr int together;  // of Step::count_alike(), run as a loop; or 1
///   template <class Step, class State> auto visit(const State& state) const noexcept;
/// Returns the state behind the last step.
template <class Network, class Kernel, Way way, int Index, class Visitor, class State>
PINNQUAD_ALWAYS_INLINE constexpr auto walk_from(const Visitor& visitor, const State& state) noexcept {
  using Here = Step<Network, Kernel, Index, way>;
  constexpr int together = Visitor::template together<Here, State>;
  static_assert(together >= 1 && together <= Here::count_alike());
  if constexpr (Here::ends_with(together)) {
    return visitor.template visit<Here>(state);
  } else {
    return walk_from<Network, Kernel, way, Index + together * Here::advance>(visitor,
                                                                             visitor.template visit<Here>(state));
  }
}

template <class Network, class Kernel, class Visitor, class State>
PINNQUAD_ALWAYS_INLINE constexpr auto walk_forward(const Visitor& visitor, const State& state) noexcept {
  return walk_from<Network, Kernel, Way::forward, 0>(visitor, state);
}
template <class Network, class Kernel, class Visitor, class State>
PINNQUAD_ALWAYS_INLINE constexpr auto walk_back(const Visitor& visitor, const State& state) noexcept {
  return walk_from<Network, Kernel, Way::back, Network::layer_count - 1>(visitor, state);
}

/// Base of a visitor that takes one step at a time.
struct StepByStep {
  template <class Step, class State>
  static constexpr int together = 1;
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
