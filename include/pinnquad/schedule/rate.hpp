// SPDX-License-Identifier: MIT
// The contract of a learning-rate policy: `double factor(double done) const noexcept`, by which the optimiser's learning
// rate is multiplied; done = share of all training steps already taken, from 0 in the first to just below 1 in the last.
#pragma once

#include <type_traits>
#include <utility>

namespace pinnquad {

namespace detail {
template <class T, class = void>
struct IsRate : std::false_type {};
template <class T>
struct IsRate<T, std::void_t<decltype(std::declval<const T&>().factor(0.5))>>
    : std::bool_constant<noexcept(std::declval<const T&>().factor(0.5)) &&
                         std::is_convertible_v<decltype(std::declval<const T&>().factor(0.5)), double>> {};
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class T>
inline constexpr bool is_rate = detail::IsRate<T>::value;

}  // namespace pinnquad
