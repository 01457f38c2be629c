// SPDX-License-Identifier: MIT
// The contract of a schedule, the weight of a loss term over the epochs: `double weight(int epoch, int epochs) const noexcept`,
// epochs counted from 0.
#pragma once

#include <type_traits>
#include <utility>

namespace pinnquad {

namespace detail {
template <class T, class = void>
struct IsSchedule : std::false_type {};
template <class T>
struct IsSchedule<T, std::void_t<decltype(std::declval<const T&>().weight(0, 1))>>
    : std::bool_constant<noexcept(std::declval<const T&>().weight(0, 1)) &&
                         std::is_convertible_v<decltype(std::declval<const T&>().weight(0, 1)), double>> {};
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class T>
inline constexpr bool is_schedule = detail::IsSchedule<T>::value;

}  // namespace pinnquad
