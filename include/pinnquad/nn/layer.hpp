// SPDX-License-Identifier: MIT
// The contract of a layer. A spec (`Dense<25>`) names what is wanted; Bind<Scalar, Inputs> makes it a layer:
//   using Scalar;  static constexpr int inputs, outputs, parameter_count;
//   static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept;
// A spec may name itself for flash: `static constexpr const char* description` (model/description.hpp).
// Layers are types without data: a network owns all parameters in one flat array, as the exported header does.
// forward(), activate() and the slope are noexcept. They are asked about samples alone: where a batch is padded to whole packs,
// the padding repeats a sample or is left out (training), and what a pack gives in lanes past the last neuron, NaN too, is not
// read.
//
// A layer has no memory. One with a state (a recurrent cell) is a layer whose inputs are [what is new, state] and whose outputs
// are [what it answers, next state]; forward() stays a pure function of them, so that every pass, batch, Jacobian and self test
// keeps its meaning. Who calls the network owns the state: a feature set that holds it beside the motion (as a window holds its
// past), filled from the outputs of the call before and set to zero with it after a gap. A layer that takes only a part of what
// reaches it passes the rest on. It is trained over windows: one layer `Unrolled<Cell, Taps>` with the cell's parameters, whose
// forward() calls the cell's once per tap and whose BackwardRule goes the same way back (back-propagation through time). What is
// exported is the network of the cell, with the parameters found.
#pragma once

#include <type_traits>
#include <utility>

#include "pinnquad/core/attributes.hpp"

namespace pinnquad {

/// Size of a network's input.
template <int Size>
struct InputSize {
  static constexpr int size = Size;
};

/// Size of a network's output.
template <int Size>
struct OutputSize {
  static constexpr int size = Size;
};

/// As headers of formats 1 and 2 call it.
template <int Size>
using Inputs = InputSize<Size>;

/// `Count` hidden layers of `Width` neurons.
template <int Count, int Width>
struct Hidden {};

namespace detail {
template <class Layer, class Scalar, class = void>
struct IsBoundLayer : std::false_type {};
template <class Layer, class Scalar>
struct IsBoundLayer<
    Layer, Scalar,
    std::void_t<typename Layer::Scalar, decltype(Layer::inputs), decltype(Layer::outputs),
                decltype(Layer::parameter_count),
                decltype(Layer::forward(static_cast<const Scalar*>(nullptr), static_cast<const Scalar*>(nullptr),
                                        static_cast<Scalar*>(nullptr)))>> : std::true_type {};
template <class Spec, class Scalar, int In, class = void>
struct IsLayer : std::false_type {};
template <class Spec, class Scalar, int In>
struct IsLayer<Spec, Scalar, In, std::void_t<typename Spec::template Bind<Scalar, In>>>
    : IsBoundLayer<typename Spec::template Bind<Scalar, In>, Scalar> {};
/// True for what a bound layer has of forward(), activate() and slope().
template <class Layer, class = void>
struct ForwardIsNoexcept : std::false_type {};
template <class Layer>
struct ForwardIsNoexcept<Layer,
                         std::enable_if_t<noexcept(Layer::forward(static_cast<const typename Layer::Scalar*>(nullptr),
                                                                  static_cast<const typename Layer::Scalar*>(nullptr),
                                                                  static_cast<typename Layer::Scalar*>(nullptr)))>>
    : std::true_type {};
template <class Layer, class = void>
struct ActivateMayThrow : std::false_type {};
template <class Layer>
struct ActivateMayThrow<Layer, std::void_t<decltype(Layer::activate(std::declval<typename Layer::Scalar>()))>>
    : std::bool_constant<!noexcept(Layer::activate(std::declval<typename Layer::Scalar>()))> {};
template <class Layer, class = void>
struct SlopeMayThrow : std::false_type {};
template <class Layer>
struct SlopeMayThrow<Layer, std::void_t<decltype(Layer::slope(std::declval<typename Layer::Scalar>()))>>
    : std::bool_constant<!noexcept(Layer::slope(std::declval<typename Layer::Scalar>()))> {};
template <class Layer, class = void>
struct HasSlopeFromInput : std::false_type {};
template <class Layer>
struct HasSlopeFromInput<Layer, std::void_t<decltype(Layer::slope_from_input(std::declval<typename Layer::Scalar>()))>>
    : std::true_type {
  static constexpr bool may_throw = !noexcept(Layer::slope_from_input(std::declval<typename Layer::Scalar>()));
};
template <class Layer>
constexpr bool slope_from_input_may_throw() noexcept {
  if constexpr (HasSlopeFromInput<Layer>::value) {
    return HasSlopeFromInput<Layer>::may_throw;
  } else {
    return false;
  }
}
template <class Layer>
inline constexpr bool is_noexcept_layer = ForwardIsNoexcept<Layer>::value && !ActivateMayThrow<Layer>::value &&
                                          !SlopeMayThrow<Layer>::value && !slope_from_input_may_throw<Layer>();

template <class Layer, class Pack, class = void>
struct ActivatesPack : std::false_type {};
template <class Layer, class Pack>
struct ActivatesPack<Layer, Pack, std::void_t<decltype(Layer::activate(std::declval<Pack>()))>>
    : std::is_same<decltype(Layer::activate(std::declval<Pack>())), Pack> {};
template <class Layer, class = void>
struct IsElementwise : std::false_type {};
template <class Layer>
struct IsElementwise<Layer, std::enable_if_t<Layer::elementwise>> : std::true_type {};
template <class Layer, class = void>
struct HasSlope : std::false_type {};
template <class Layer>
struct HasSlope<Layer, std::void_t<decltype(Layer::slope(std::declval<typename Layer::Scalar>()))>> : std::true_type {};
template <class Layer, class Pack, class = void>
struct ScalesPack : std::false_type {};
template <class Layer, class Pack>
struct ScalesPack<Layer, Pack, std::void_t<decltype(Layer::scaled(std::declval<Pack>(), std::declval<Pack>()))>>
    : std::true_type {};
template <class Layer, class Pack, class = void>
struct ScalesPackFromInput : std::false_type {};
template <class Layer, class Pack>
struct ScalesPackFromInput<Layer, Pack,
                           std::void_t<decltype(Layer::scaled_from_input(std::declval<Pack>(), std::declval<Pack>()))>>
    : std::true_type {};
}  // namespace detail

/// True for a spec that fulfils the contract at the head of this file.
template <class Spec, class Scalar = double, int In = 3>
inline constexpr bool is_layer = detail::IsLayer<Spec, Scalar, In>::value;

/// A layer with `static constexpr bool elementwise = true` and `activate(v)`: y_i = activate(x_i). It works in place.
template <class Layer>
inline constexpr bool is_elementwise = detail::IsElementwise<Layer>::value;

/// An element-wise layer whose activate() also takes a whole pack: it is fused into the layer before it.
template <class Layer, class Pack>
inline constexpr bool activates_pack = detail::ActivatesPack<Layer, Pack>::value;

/// An element-wise layer that can be differentiated gives d activate / d v: `slope(y)` from its output or, where the output does
/// not tell (two inputs have it, or it takes more to invert than to keep the input), `slope_from_input(v)`.
template <class Layer>
inline constexpr bool has_slope = detail::HasSlope<Layer>::value || detail::HasSlopeFromInput<Layer>::value;

/// True for a layer whose slope is asked with its input: what it was given is kept until then.
template <class Layer>
inline constexpr bool slopes_from_input = detail::HasSlopeFromInput<Layer>::value;

/// One that also gives `scaled(Pack y, Pack dy)` = slope(y) dy, or `scaled_from_input(Pack v, Pack dy)`, for a whole pack.
template <class Layer, class Pack>
inline constexpr bool scales_pack =
    slopes_from_input<Layer> ? detail::ScalesPackFromInput<Layer, Pack>::value : detail::ScalesPack<Layer, Pack>::value;

namespace detail {
/// dy times the layer's slope, for a scalar or a pack. `seen` is the input of a layer that slopes_from_input, else the output.
template <class Layer, class Value>
PINNQUAD_ALWAYS_INLINE Value scaled_by_slope(const Value& seen, const Value& dy) noexcept {
  if constexpr (std::is_same_v<Value, typename Layer::Scalar>) {
    if constexpr (slopes_from_input<Layer>) {
      return dy * Layer::slope_from_input(seen);
    } else {
      return dy * Layer::slope(seen);
    }
  } else if constexpr (slopes_from_input<Layer>) {
    return Layer::scaled_from_input(seen, dy);
  } else {
    return Layer::scaled(seen, dy);
  }
}
}  // namespace detail

/// Base of element-wise layers: the sizes and a forward pass from `Derived::activate`.
template <class Derived, class ScalarType, int Size>
struct ElementwiseLayer {
  using Scalar = ScalarType;
  static constexpr int inputs = Size;
  static constexpr int outputs = Size;
  static constexpr int parameter_count = 0;
  static constexpr bool elementwise = true;

  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar*, const Scalar* x, Scalar* y) noexcept {
    for (int i = 0; i < Size; ++i) y[i] = Derived::activate(x[i]);
  }
};

}  // namespace pinnquad
