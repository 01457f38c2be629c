// SPDX-License-Identifier: MIT
// Detection: is_detected<Op, Args...> is true where Op<Args...> is a type.
#pragma once

#include <type_traits>

namespace pinnquad {

namespace detail {
template <class, template <class...> class Op, class... Args>
struct Detector : std::false_type {};
template <template <class...> class Op, class... Args>
struct Detector<std::void_t<Op<Args...>>, Op, Args...> : std::true_type {};
}  // namespace detail

template <template <class...> class Op, class... Args>
inline constexpr bool is_detected = detail::Detector<void, Op, Args...>::value;

}  // namespace pinnquad
