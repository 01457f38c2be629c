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
  static_assert(is_noexcept_layer<Layer>,
                "pinnquad: a layer's forward(), activate() and slope() must be noexcept: they fly (nn/layer.hpp)");
  static_assert(!(is_detected<SlopeOf, Layer> && is_detected<SlopeFromInputOf, Layer>),
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
  static constexpr int offset(int layer) noexcept { return sum_before(layer, parameters); }
  /// Outputs of all layers before this one.
  static constexpr int outputs_before(int layer) noexcept { return sum_before(layer, outputs); }
  static constexpr int widest(int least) noexcept {
    for (int width : outputs) least = width > least ? width : least;
    return least;
  }

 private:
  static constexpr int sum_before(int layer, const std::array<int, sizeof...(Layers)>& numbers) noexcept {
    int sum = 0;
    for (int i = 0; i < layer; ++i) sum += numbers[static_cast<std::size_t>(i)];
    return sum;
  }
};

template <class Layer, class Activation>
using ForwardFusedOf = decltype(Layer::template forward_fused<Activation>(
    static_cast<const typename Layer::Scalar*>(nullptr), static_cast<const typename Layer::Scalar*>(nullptr),
    static_cast<typename Layer::Scalar*>(nullptr)));
/// True for a layer that applies an element-wise layer to its sums before it stores them.
template <class Layer, class Activation>
inline constexpr bool fuses_activation = is_detected<ForwardFusedOf, Layer, Activation>;

inline namespace PINNQUAD_INSTRUCTION_SET {

/// The forward pass of a Network, step by step (nn/walk.hpp). Code for flash: an activation is applied to the sums of
/// the layer before it, and equal steps in a row are one loop. A last hidden layer that is wider than the kernel holds
/// is made and used in parts, and takes no place on the stack: the order of each sum, and so its bits, are the same.
template <class NetworkType>
class PortablePass {
  using Scalar = typename NetworkType::Scalar;
  struct Kernel {
    template <class Layer, class Elementwise>
    static constexpr bool fuses = fuses_activation<Layer, Elementwise>;
  };
  template <int Index>
  using StepAt = Step<NetworkType, Kernel, Index>;

  /// Parts of a layer that is made in parts. With four, a Cortex-M takes a twentieth less of instructions for 32
  /// neurons, and 16 B more of the stack.
  static constexpr int parts = 8;
  /// Neurons of a step that are made at a time; 0: all of them.
  template <class Step>
  static constexpr int neurons_at_once() noexcept {
    if constexpr (!Step::last) {
      using Next = StepAt<Step::next>;
      if constexpr (Next::last && is_dense_with_bias<typename Step::Layer> &&
                    is_dense_with_bias<typename Next::Layer>) {
        constexpr int neurons = Step::Layer::outputs;
        return neurons > held_inputs && neurons % parts == 0 ? neurons / parts : 0;
      }
    }
    return 0;
  }
  /// Largest output of the steps from this one on: in the buffer that it writes to (`own`), or in the other one.
  template <class Step>
  static constexpr int entries(bool own) noexcept {
    if constexpr (Step::last) {
      return 1;
    } else {
      constexpr int some = neurons_at_once<Step>();
      const int here = some > 0 ? some : Step::Layer::outputs, later = entries<StepAt<Step::next>>(!own);
      return own && here > later ? here : later;
    }
  }
  static constexpr int even_size = entries<StepAt<0>>(true);
  static constexpr int odd_size = entries<StepAt<0>>(false);
  /// True where the first layer takes inputs from anywhere: it is a Dense, and the kernel holds them all.
  static constexpr bool takes_any = is_dense_with_bias<typename StepAt<0>::Layer> && NetworkType::inputs <= held_inputs;

 public:
  /// Stack that forward() needs for activations.
  static constexpr std::size_t workspace_bytes = sizeof(Scalar) * static_cast<std::size_t>(even_size + odd_size);

  /// y = network(x); out of line, so that an image holds it once.
  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept { run(parameters, x, y); }
  /// The same for inputs that stand anywhere, `x[i]` the i-th of them: they have no place of their own on the stack.
  /// Inlined, so that the caller has none beside it.
  template <class X>
  static PINNQUAD_ALWAYS_INLINE void forward_of(const Scalar* parameters, const X& x, Scalar* y) noexcept {
    if constexpr (takes_any) {
      run(parameters, x, y);
    } else {
      Scalar seen[static_cast<std::size_t>(NetworkType::inputs)];
      for (int i = 0; i < NetworkType::inputs; ++i) seen[i] = x[i];
      run(parameters, static_cast<const Scalar*>(seen), y);
    }
  }

 private:
  /// Parameters and inputs of a step, and the two buffers: it writes to `target`.
  template <class X>
  struct At {
    const Scalar* own;
    X x;
    Scalar* target;
    Scalar* other;
  };

  template <class X>
  static PINNQUAD_ALWAYS_INLINE void run(const Scalar* parameters, const X& x, Scalar* y) noexcept {
    Scalar even[static_cast<std::size_t>(even_size)];
    Scalar odd[static_cast<std::size_t>(odd_size)];
    walk_forward<NetworkType, Kernel>(Visitor{y}, At<X>{parameters, x, even, odd});
  }

  /// Behind a step that made the network's outputs together with the last one.
  struct Made {};

  struct Visitor {
    Scalar* y;

    /// Number of equal steps that run as a loop: without the last one, which writes the network's outputs elsewhere,
    /// and without one before it that is made in parts.
    template <class Step>
    static constexpr int count_loop() noexcept {
      constexpr int all = Step::count_alike();
      constexpr int stored = all - (Step::ends_with(all) ? 1 : 0);
      constexpr int before = stored > 1 ? stored - 1 : 0;
      using Final = StepAt<Step::index + before * Step::advance>;
      constexpr int count = neurons_at_once<Final>() > 0 ? before : stored;
      return count > 1 ? count : 1;
    }
    /// Inputs from anywhere have another type than what the loop goes on with.
    template <class Step, class State>
    static constexpr int together = std::is_same_v<State, At<const Scalar*>> ? count_loop<Step>() : 1;

    template <class Step>
    PINNQUAD_ALWAYS_INLINE Made visit(Made) const noexcept {
      return {};
    }
    template <class Step, class X>
    PINNQUAD_ALWAYS_INLINE auto visit(const At<X>& at) const noexcept {
      if constexpr (Step::last) {
        apply<Step>(at.own, at.x, y);
        return Made{};
      } else if constexpr (neurons_at_once<Step>() > 0) {
        make_in_parts<Step, StepAt<Step::next>>(at);
        return Made{};
      } else {
        constexpr int stride = NetworkType::Sizes::offset(Step::next) - NetworkType::Sizes::offset(Step::index);
        const auto go_on = [](const auto& from) PINNQUAD_INLINE_LAMBDA {
          apply<Step>(from.own, from.x, from.target);
          return At<const Scalar*>{from.own + stride, from.target, from.other, from.target};
        };
        if constexpr (std::is_pointer_v<X>) {
          At<const Scalar*> next = at;
          for (int i = 0; i < together<Step, At<X>>; ++i) next = go_on(next);
          return next;
        } else {
          return go_on(at);
        }
      }
    }

   private:
    template <class Step, class Last, class X>
    PINNQUAD_ALWAYS_INLINE void make_in_parts(const At<X>& at) const noexcept {
      using Hidden = typename Step::Layer;
      using Outputs = typename Last::Layer;
      constexpr int part = neurons_at_once<Step>();
      X x = at.x;
      const Scalar* const weights = at.own + Last::parameters_offset - Step::parameters_offset;
      for (int i = 0; i < Outputs::outputs; ++i) y[i] = weights[Outputs::weight_count + i];
      for (int first = 0; first < Hidden::outputs; first += part) {
        // otherwise the compiler keeps the first of them on the stack from part to part
        if constexpr (std::is_pointer_v<X>) PINNQUAD_FORGET(x);
        Hidden::template forward_some<part>(at.own, first, x, at.target, Activate<typename Step::Activation>{});
        Outputs::template add_some<part>(weights, first, at.target, y);
      }
      if constexpr (Last::fused) {
        for (int i = 0; i < Outputs::outputs; ++i) y[i] = Last::Activation::activate(y[i]);
      }
    }
  };

  template <class Step, class X>
  static PINNQUAD_ALWAYS_INLINE void apply(const Scalar* own, const X& x, Scalar* y) noexcept {
    if constexpr (Step::fused || !std::is_pointer_v<X>) {
      Step::Layer::template forward_fused<typename Step::Activation>(own, x, y);
    } else {
      Step::Layer::forward(own, x, y);
    }
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

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
  static constexpr std::size_t workspace_bytes = detail::PortablePass<Network>::workspace_bytes;
  using Parameters = std::array<Scalar, static_cast<std::size_t>(parameter_count)>;

  Parameters parameters{};

  /// y = network(x) with these parameters, by the portable kernel. x has `inputs`, y `outputs` entries.
  PINNQUAD_ALWAYS_INLINE void forward(const Scalar* x, Scalar* y) const noexcept {
    forward(detail::first_of<Scalar>(parameters), x, y);
  }

  /// The same for parameters that live elsewhere (flash).
  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    detail::PortablePass<Network>::forward(parameters, x, y);
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
/// A hidden layer is `DenseOf<Width>` and what stands `Behind` it.
template <class Scalar, class InputSize, class HiddenLayers, class OutputSize, template <int> class DenseOf,
          class... Behind>
struct Mlp;
template <class Scalar, class InputSize, int Count, int Width, class OutputSize, template <int> class DenseOf,
          class... Behind>
struct Mlp<Scalar, InputSize, Hidden<Count, Width>, OutputSize, DenseOf, Behind...>
    : Stack<Scalar, InputSize, Count, SpecList<DenseOf<Width>, Behind...>, Dense<OutputSize::size>> {};
}  // namespace detail

template <class T>
inline constexpr bool is_network = false;
template <class Scalar, class InputSize, class... Specs>
inline constexpr bool is_network<Network<Scalar, InputSize, Specs...>> = true;

/// Eq. (4): `Mlp<float, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>`.
template <class Scalar, class InputSize, class HiddenLayers, class OutputSize, class Activation>
using Mlp = typename detail::Mlp<Scalar, InputSize, HiddenLayers, OutputSize, Dense, Activation>::type;

}  // namespace pinnquad
