// SPDX-License-Identifier: MIT
// The contract of a layer. A spec (`Dense<25>`) names what is wanted; Bind<Scalar, Inputs> makes it a layer:
//   using Scalar;  static constexpr int inputs, outputs, parameter_count;
//   static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept;
// Layers are types without data: a network owns all parameters in one flat array, as the exported header does.
// forward(), activate() and slope() are noexcept. They are asked about samples alone: where a batch is padded to whole packs, the
// padding repeats a sample or is left out (training), and what a pack gives in lanes past the last neuron, NaN too, is not read.
#pragma once

#include <type_traits>
#include <utility>

#include "pinnquad/core/attributes.hpp"

namespace pinnquad {

/// Size of a network's input.
template <int Size>
struct Inputs {
  static constexpr int size = Size;
};

/// Size of a network's output.
template <int Size>
struct Outputs {
  static constexpr int size = Size;
};

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
template <class Layer>
inline constexpr bool is_noexcept_layer =
    ForwardIsNoexcept<Layer>::value && !ActivateMayThrow<Layer>::value && !SlopeMayThrow<Layer>::value;

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

/// An element-wise layer that can be differentiated gives `slope(y)` = d activate / d v, from its output.
template <class Layer>
inline constexpr bool has_slope = detail::HasSlope<Layer>::value;

/// One that also gives `scaled(Pack y, Pack dy)` = slope(y) dy for a whole pack.
template <class Layer, class Pack>
inline constexpr bool scales_pack = detail::ScalesPack<Layer, Pack>::value;

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
