// SPDX-License-Identifier: MIT
// A feed-forward network as a type: layers in order, sizes deduced, all parameters in one flat array.
// Mlp writes the paper's shape (Eq. (4)) in one line.
#pragma once

#include <array>
#include <tuple>

#include "pinnquad/core/first_of.hpp"
#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/nn/dense.hpp"
#include "pinnquad/nn/layer.hpp"
#include "pinnquad/nn/walk.hpp"

namespace pinnquad {

namespace detail {

template <class Scalar, int In, class... Specs>
struct Chain {
  using Layers = std::tuple<>;
};
template <class Scalar, int In, class First, class... Rest>
struct Chain<Scalar, In, First, Rest...> {
  static_assert(
      is_layer<First, Scalar, In>,
      "pinnquad: this type is not a layer; it needs Bind<Scalar, In> with sizes and forward() (nn/layer.hpp)");
  using Layer = typename First::template Bind<Scalar, In>;
  static_assert(detail::is_noexcept_layer<Layer>,
                "pinnquad: a layer's forward(), activate() and slope() must be noexcept: they fly (nn/layer.hpp)");
  static_assert(!(detail::HasSlope<Layer>::value && detail::HasSlopeFromInput<Layer>::value),
                "pinnquad: an element-wise layer gives slope(y) or slope_from_input(v), not both (nn/layer.hpp)");
  static_assert(Layer::inputs == In, "pinnquad: a layer does not take the outputs of the layer before it");
  using Layers = decltype(std::tuple_cat(std::declval<std::tuple<Layer>>(),
                                         std::declval<typename Chain<Scalar, Layer::outputs, Rest...>::Layers>()));
};

template <class Layers>
struct Sizes;
template <class... Layers>
struct Sizes<std::tuple<Layers...>> {
  static constexpr int count = sizeof...(Layers);
  static constexpr int parameter_count = (Layers::parameter_count + ... + 0);
  static constexpr std::array<int, sizeof...(Layers)> parameters = {Layers::parameter_count...};
  static constexpr std::array<int, sizeof...(Layers)> outputs = {Layers::outputs...};
  /// Index of a layer's first parameter in the flat array.
  static constexpr int offset(int layer) noexcept {
    int sum = 0;
    for (int i = 0; i < layer; ++i) sum += parameters[static_cast<std::size_t>(i)];
    return sum;
  }
  /// Outputs of all layers before this one.
  static constexpr int outputs_before(int layer) noexcept {
    int sum = 0;
    for (int i = 0; i < layer; ++i) sum += outputs[static_cast<std::size_t>(i)];
    return sum;
  }
  static constexpr int widest(int least) noexcept {
    for (int width : outputs) least = width > least ? width : least;
    return least;
  }
};

template <class Layer, class Activation, class = void>
struct FusesActivation : std::false_type {};
template <class Layer, class Activation>
struct FusesActivation<
    Layer, Activation,
    std::void_t<decltype(Layer::template forward_fused<Activation>(
        static_cast<const typename Layer::Scalar*>(nullptr), static_cast<const typename Layer::Scalar*>(nullptr),
        static_cast<typename Layer::Scalar*>(nullptr)))>> : std::true_type {};
/// True for a layer that applies an element-wise layer to its sums before it stores them.
template <class Layer, class Activation>
inline constexpr bool fuses_activation = FusesActivation<Layer, Activation>::value;

}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// The forward pass of a Network, step by step (nn/walk.hpp). Code for flash: an activation is applied to the sums of the layer
/// before it, and equal steps in a row are one loop.
template <class NetworkType>
class PortablePass {
  using Scalar = typename NetworkType::Scalar;

 public:
  /// y = network(x); out of line, so that an image holds it once.
  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    Scalar even[static_cast<std::size_t>(NetworkType::widest)];
    Scalar odd[static_cast<std::size_t>(NetworkType::widest)];
    detail::walk_forward<NetworkType, Kernel>(Visitor{y}, At{parameters, x, even, odd});
  }
  /// The same for inputs that `fill(x)` writes: into the buffer that the first step leaves alone, so that they have no place
  /// of their own on the stack. Inlined, so that the caller has none beside it.
  template <class Fill>
  static PINNQUAD_ALWAYS_INLINE void forward_of(const Scalar* parameters, const Fill& fill, Scalar* y) noexcept {
    Scalar even[static_cast<std::size_t>(NetworkType::widest)];
    Scalar odd[static_cast<std::size_t>(NetworkType::widest)];
    fill(static_cast<Scalar*>(odd));
    detail::walk_forward<NetworkType, Kernel>(Visitor{y}, At{parameters, odd, even, odd});
  }

 private:
  struct Kernel {
    template <class Layer, class Elementwise>
    static constexpr bool fuses = detail::fuses_activation<Layer, Elementwise>;
  };
  /// Parameters and inputs of a step, and the two buffers: it writes to `target`.
  struct At {
    const Scalar* own;
    const Scalar* x;
    Scalar* target;
    Scalar* other;
  };
  struct Visitor {
    Scalar* y;

    /// All that are alike but the one that makes the network's outputs: it writes elsewhere.
    template <class Step, class>
    static constexpr int together = Step::last ? 1
                                               : Step::count_alike() - (Step::ends_with(Step::count_alike()) ? 1 : 0);

    template <class Step>
    PINNQUAD_ALWAYS_INLINE At visit(At at) const noexcept {
      if constexpr (Step::last) {
        apply<Step>(at.own, at.x, y);
      } else {
        constexpr int stride = NetworkType::Sizes::offset(Step::next) - NetworkType::Sizes::offset(Step::index);
        for (int i = 0; i < together<Step, At>; ++i) {
          Scalar* const made = at.target;
          apply<Step>(at.own, at.x, made);
          at.own += stride;
          at.x = made;
          at.target = at.other;
          at.other = made;
        }
      }
      return at;
    }
  };

  template <class Step>
  static PINNQUAD_ALWAYS_INLINE void apply(const Scalar* own, const Scalar* x, Scalar* y) noexcept {
    if constexpr (Step::fused) {
      Step::Layer::template forward_fused<typename Step::Activation>(own, x, y);
    } else {
      Step::Layer::forward(own, x, y);
    }
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

/// Layers in order behind `InputSize`; a value that owns its parameters.
template <class ScalarType, class InputSize, class... Specs>
class Network {
 public:
  using Scalar = ScalarType;
  using Layers = typename detail::Chain<Scalar, InputSize::size, Specs...>::Layers;
  using Sizes = detail::Sizes<Layers>;
  template <int Index>
  using Layer = std::tuple_element_t<static_cast<std::size_t>(Index), Layers>;
  template <class OtherScalar>
  using Rebind = Network<OtherScalar, InputSize, Specs...>;

  static_assert(sizeof...(Specs) > 0, "pinnquad: a network needs at least one layer");
  static constexpr int layer_count = Sizes::count;
  static constexpr int inputs = InputSize::size;
  static constexpr int outputs = Layer<layer_count - 1>::outputs;
  static constexpr int parameter_count = Sizes::parameter_count;
  static constexpr int widest = Sizes::widest(inputs);
  /// Stack that the portable forward pass needs for activations.
  static constexpr std::size_t workspace_bytes = 2 * sizeof(Scalar) * static_cast<std::size_t>(widest);
  using Parameters = std::array<Scalar, static_cast<std::size_t>(parameter_count)>;

  Parameters parameters{};

  /// y = network(x) with these parameters, by the portable kernel. x has `inputs`, y `outputs` entries.
  PINNQUAD_ALWAYS_INLINE void forward(const Scalar* x, Scalar* y) const noexcept {
    forward(detail::first_of<Scalar>(parameters), x, y);
  }

  /// The same for parameters that live elsewhere (flash).
  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    PortablePass<Network>::forward(parameters, x, y);
  }
};

namespace detail {
template <class... Specs>
struct SpecList {};

/// `Hidden` specs `Count` times over, then `Last`.
template <class Scalar, class InputSize, int Count, class Hidden, class Last, class... Specs>
struct Stack;
template <class Scalar, class InputSize, int Count, class... Hidden, class Last, class... Specs>
struct Stack<Scalar, InputSize, Count, SpecList<Hidden...>, Last, Specs...>
    : Stack<Scalar, InputSize, Count - 1, SpecList<Hidden...>, Last, Specs..., Hidden...> {};
template <class Scalar, class InputSize, class... Hidden, class Last, class... Specs>
struct Stack<Scalar, InputSize, 0, SpecList<Hidden...>, Last, Specs...> {
  using type = Network<Scalar, InputSize, Specs..., Last>;
};
template <class Scalar, class InputSize, class HiddenLayers, class OutputSize, class Activation>
struct Mlp;
template <class Scalar, class InputSize, int Count, int Width, class OutputSize, class Activation>
struct Mlp<Scalar, InputSize, Hidden<Count, Width>, OutputSize, Activation>
    : Stack<Scalar, InputSize, Count, SpecList<Dense<Width>, Activation>, Dense<OutputSize::size>> {};
template <class T>
struct IsNetwork : std::false_type {};
template <class Scalar, class InputSize, class... Specs>
struct IsNetwork<Network<Scalar, InputSize, Specs...>> : std::true_type {};
}  // namespace detail

template <class T>
inline constexpr bool is_network = detail::IsNetwork<T>::value;

/// Eq. (4): `Mlp<float, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>`.
template <class Scalar, class InputSize, class HiddenLayers, class OutputSize, class Activation>
using Mlp = typename detail::Mlp<Scalar, InputSize, HiddenLayers, OutputSize, Activation>::type;

}  // namespace pinnquad
