// SPDX-License-Identifier: MIT
// The contract of a layer's backward pass: a specialisation `BackwardRule<Layer>` for one sample,
//   static void backward(const Scalar* parameters, const Scalar* x, const Scalar* y, const Scalar* dy, Scalar* dx,
//                        Scalar* parameter_gradient) noexcept;
// dx is set, parameter_gradient is added to. An element-wise layer needs none: it has its slope (nn/layer.hpp).
#pragma once

#include <type_traits>
#include <utility>

#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

template <class Layer>
struct BackwardRule;

namespace detail {
template <class Layer, class = void>
struct HasSampleRule : std::false_type {
  static constexpr bool is_noexcept = true;
};
template <class Layer>
struct HasSampleRule<Layer,
                     std::void_t<decltype(BackwardRule<Layer>::backward(
                         std::declval<const typename Layer::Scalar*>(), std::declval<const typename Layer::Scalar*>(),
                         std::declval<const typename Layer::Scalar*>(), std::declval<const typename Layer::Scalar*>(),
                         std::declval<typename Layer::Scalar*>(), std::declval<typename Layer::Scalar*>()))>>
    : std::true_type {
  static constexpr bool is_noexcept = noexcept(BackwardRule<Layer>::backward(
      std::declval<const typename Layer::Scalar*>(), std::declval<const typename Layer::Scalar*>(),
      std::declval<const typename Layer::Scalar*>(), std::declval<const typename Layer::Scalar*>(),
      std::declval<typename Layer::Scalar*>(), std::declval<typename Layer::Scalar*>()));
};
}  // namespace detail

/// True for a bound layer that can be trained, but for `noexcept`.
template <class Layer>
inline constexpr bool is_trainable = is_elementwise<Layer> ? has_slope<Layer> : detail::HasSampleRule<Layer>::value;

/// True if the layer's BackwardRule, where it has one, is noexcept: the Trainer's backward pass is.
template <class Layer>
inline constexpr bool is_noexcept_backward = detail::HasSampleRule<Layer>::is_noexcept;

}  // namespace pinnquad
