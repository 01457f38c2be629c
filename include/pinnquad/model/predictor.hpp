// SPDX-License-Identifier: MIT
// What answers in a model, between its scalers: a Network, or anything else with features in and outputs out
// (model/composition.hpp). All parameters in one flat array, sizes known to the compiler.
// Contract: `Scalar`, `inputs`, `outputs`, `parameter_count`, `Parameters` and a member `parameters`;
//   static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept
//   static void jacobian(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* by_x) noexcept    outputs x inputs,
//     row-major; a Network's is JacobianPass (nn/jacobian.hpp)
// and a Description (model/description.hpp). A Network runs on the vector unit, any other answer as it is written.
#pragma once

#include <array>
#include <type_traits>

#include "pinnquad/nn/network.hpp"

namespace pinnquad {

namespace detail {
template <class T, class = void>
struct IsPredictor : std::false_type {};
template <class T>
struct IsPredictor<T, std::void_t<typename T::Scalar, typename T::Parameters, decltype(T::inputs), decltype(T::outputs),
                               decltype(T::parameter_count), decltype(std::declval<T&>().parameters)>>
    : std::bool_constant<noexcept(T::forward(static_cast<const typename T::Scalar*>(nullptr),
                                             static_cast<const typename T::Scalar*>(nullptr),
                                             static_cast<typename T::Scalar*>(nullptr)))> {};
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file, but for its Jacobian.
template <class T>
inline constexpr bool is_predictor = detail::IsPredictor<T>::value;

}  // namespace pinnquad
