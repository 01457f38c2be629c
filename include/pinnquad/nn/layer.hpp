// SPDX-License-Identifier: MIT
// The contract of a layer. A spec (`Dense<25>`) names what is wanted; Bind<Scalar, Inputs> makes it a layer, a type
// without data: a network owns all parameters in one flat array, as the exported header does. All are static:
//   using Scalar;  constexpr int inputs, outputs, parameter_count;
//   void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept;
// Optional, each where it is needed:
//   Jacobian (nn/jacobian.hpp), one row of gradients:
//     void pull_back(const Scalar* parameters, const Scalar* x, const Scalar* by_output, Scalar* by_input) noexcept
//   training (training/backward.hpp), beside pull_back() and where it has parameters:
//     void add_gradient(const Scalar* x, const Scalar* dy, Scalar* parameter_gradient) noexcept
//   a start (training/initialization.hpp), all parameters being 0 before:
//     void initialise(Scalar* parameters, Engine&)
//   flash (model/description.hpp), of the spec:
//     constexpr const char* description
// An activation derives from ElementwiseLayer (below) and has activate(v) and slope(y) or slope_from_input(v), all
// noexcept. It is computed inside the layer before it where it has forms for a whole pack too, scaled(y, dy) or
// scaled_from_input(v, dy) among them (relu.hpp), or says that they are those of each lane: `lane_by_lane = true`
// (gelu.hpp). Packs see samples alone: a batch that is padded to whole packs repeats a sample. Their lanes behind the
// last neuron may hold anything, NaN too: they are not read.
//
// A layer has no memory. A recurrent cell is a layer from [new inputs, state] to [outputs, next state]; forward()
// stays a pure function. The caller owns the state: it feeds the outputs of one call into the next and sets them to
// zero after a gap. A layer that takes a part of its inputs passes the rest on. Training needs a layer that calls the
// cell once per instant of a window, with a BackwardRule that goes the same way back; the network of the cell is
// exported with the parameters found.
#pragma once

#include <type_traits>
#include <utility>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/instruction_set.hpp"

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

/// `Count` hidden layers of `Width` neurons.
template <int Count, int Width>
struct Hidden {};

namespace detail {
template <class Spec, class Scalar, class Size>
using BoundLayer = typename Spec::template Bind<Scalar, Size::value>;
// each names std::bool_constant<is it noexcept>
template <class Layer>
using ForwardOf = std::bool_constant<noexcept(Layer::forward(static_cast<const typename Layer::Scalar*>(nullptr),
                                                             static_cast<const typename Layer::Scalar*>(nullptr),
                                                             static_cast<typename Layer::Scalar*>(nullptr)))>;
template <class Layer, class Scalar>
using LayerMembersOf =
    std::void_t<std::enable_if_t<std::is_same_v<typename Layer::Scalar, Scalar>>, decltype(Layer::inputs),
                decltype(Layer::outputs), decltype(Layer::parameter_count), ForwardOf<Layer>>;
template <class Spec, class Scalar, class Size>
using LayerOf = LayerMembersOf<BoundLayer<Spec, Scalar, Size>, Scalar>;
template <class Layer>
using ActivateOf = std::bool_constant<noexcept(Layer::activate(std::declval<typename Layer::Scalar>()))>;
template <class Layer>
using SlopeOf = std::bool_constant<noexcept(Layer::slope(std::declval<typename Layer::Scalar>()))>;
template <class Layer>
using SlopeFromInputOf = std::bool_constant<noexcept(Layer::slope_from_input(std::declval<typename Layer::Scalar>()))>;

template <template <class...> class Function, class T>
constexpr bool is_noexcept_where_given() noexcept {
  if constexpr (is_detected<Function, T>) {
    return Function<T>::value;
  } else {
    return true;
  }
}
template <class Layer>
inline constexpr bool is_noexcept_layer =
    is_noexcept_where_given<ForwardOf, Layer>() && is_noexcept_where_given<ActivateOf, Layer>() &&
    is_noexcept_where_given<SlopeOf, Layer>() && is_noexcept_where_given<SlopeFromInputOf, Layer>();

template <class Layer>
using PullBackOf = decltype(Layer::pull_back(
    static_cast<const typename Layer::Scalar*>(nullptr), static_cast<const typename Layer::Scalar*>(nullptr),
    static_cast<const typename Layer::Scalar*>(nullptr), static_cast<typename Layer::Scalar*>(nullptr)));
/// A layer that is not element-wise and goes back over one row of gradients (nn/jacobian.hpp).
template <class Layer>
inline constexpr bool pulls_back = is_detected<PullBackOf, Layer>;

template <class Layer>
using ElementwiseOf = std::enable_if_t<Layer::elementwise>;
template <class Layer>
using LaneByLaneOf = std::enable_if_t<Layer::lane_by_lane>;
template <class Layer, class Pack>
using PackActivateOf = std::enable_if_t<std::is_same_v<decltype(Layer::activate(std::declval<Pack>())), Pack>>;
template <class Layer, class Pack>
using PackScaledOf = decltype(Layer::scaled(std::declval<Pack>(), std::declval<Pack>()));
template <class Layer, class Pack>
using PackScaledFromInputOf = decltype(Layer::scaled_from_input(std::declval<Pack>(), std::declval<Pack>()));
}  // namespace detail

/// True for a spec (`Dense<25>`) that fulfils the contract at the head of this file.
template <class Spec, class Scalar = double, int In = 3>
inline constexpr bool is_layer = is_detected<detail::LayerOf, Spec, Scalar, std::integral_constant<int, In>>;

/// A layer with `static constexpr bool elementwise = true` and `activate(v)`: y_i = activate(x_i). It works in place.
template <class Layer>
inline constexpr bool is_elementwise = is_detected<detail::ElementwiseOf, Layer>;

/// An element-wise layer with `static constexpr bool lane_by_lane = true`: a pack goes through activate() and the slope
/// lane by lane, as it must for functions of the C library.
template <class Layer>
inline constexpr bool is_lane_by_lane = is_detected<detail::LaneByLaneOf, Layer>;

/// An element-wise layer whose activate() also takes a whole pack, or is_lane_by_lane: it is fused into the layer
/// before it.
template <class Layer, class Pack>
inline constexpr bool activates_pack = is_lane_by_lane<Layer> || is_detected<detail::PackActivateOf, Layer, Pack>;

/// An element-wise layer with a derivative d activate / d v: `slope(y)` from its output, or `slope_from_input(v)`
/// where two inputs have the same output or the output is costly to invert.
template <class Layer>
inline constexpr bool has_slope = is_detected<detail::SlopeOf, Layer> || is_detected<detail::SlopeFromInputOf, Layer>;

/// True for a layer with slope_from_input(): its input is kept until the slope is needed.
template <class Layer>
inline constexpr bool slopes_from_input = is_detected<detail::SlopeFromInputOf, Layer>;

/// One that also gives `scaled(Pack y, Pack dy)` = slope(y) dy, or `scaled_from_input(Pack v, Pack dy)`, for a whole
/// pack; or is_lane_by_lane.
template <class Layer, class Pack>
inline constexpr bool scales_pack = is_lane_by_lane<Layer> ||
                                    (slopes_from_input<Layer> ? is_detected<detail::PackScaledFromInputOf, Layer, Pack>
                                                              : is_detected<detail::PackScaledOf, Layer, Pack>);

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// function(lane) for every lane of `v`: the same numbers as scalar by scalar, on every instruction set.
template <class Pack, class Function>
PINNQUAD_ALWAYS_INLINE Pack each_lane(const Pack& v, const Function& function) noexcept {
  alignas(64) typename Pack::Scalar lane[Pack::width];
  v.store(lane);
  for (auto& value : lane) value = function(value);
  return Pack::load(lane);
}

/// The activation of a step as a function of a scalar or a pack; of `void`, the sums as they are.
template <class Layer>
struct Activate {
  template <class Value>
  PINNQUAD_ALWAYS_INLINE Value operator()(const Value& v) const noexcept {
    if constexpr (std::is_same_v<Value, typename Layer::Scalar> || is_detected<PackActivateOf, Layer, Value>) {
      return Layer::activate(v);
    } else {
      const Value own = v;  // copied first: gcc keeps more of a GenericPack in registers
      return each_lane(own, [](auto lane) PINNQUAD_INLINE_LAMBDA { return Layer::activate(lane); });
    }
  }
};

template <>
struct Activate<void> {
  template <class Value>
  PINNQUAD_ALWAYS_INLINE Value operator()(Value v) const noexcept {
    return v;
  }
};

/// d activate / d v. `seen` is the input of a layer that slopes_from_input, else the output.
template <class Layer, class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar slope_at(Scalar seen) noexcept {
  if constexpr (slopes_from_input<Layer>) {
    return Layer::slope_from_input(seen);
  } else {
    return Layer::slope(seen);
  }
}
/// dy times the slope, for a scalar or a pack.
template <class Layer, class Value>
PINNQUAD_ALWAYS_INLINE Value scaled_by_slope(const Value& seen, const Value& dy) noexcept {
  if constexpr (std::is_same_v<Value, typename Layer::Scalar>) {
    return dy * slope_at<Layer>(seen);
  } else if constexpr (is_detected<PackScaledFromInputOf, Layer, Value>) {
    return Layer::scaled_from_input(seen, dy);
  } else if constexpr (is_detected<PackScaledOf, Layer, Value>) {
    return Layer::scaled(seen, dy);
  } else {
    const Value by_output = dy, own = seen;  // copied first, as above
    return by_output * each_lane(own, [](auto lane) PINNQUAD_INLINE_LAMBDA { return slope_at<Layer>(lane); });
  }
}
}  // namespace PINNQUAD_INSTRUCTION_SET
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
