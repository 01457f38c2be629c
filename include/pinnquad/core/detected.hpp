// SPDX-License-Identifier: MIT
// One way to ask whether a type has a member: `is_detected<Op, Args...>` is true where `Op<Args...>` names a type.
// Example: `template <class T> using NameOf = decltype(T::name);` and `is_detected<NameOf, Model>`.
#pragma once
#include <type_traits>

namespace pinnquad::detail {

template <class Void, template <class...> class Op, class... Args>
struct Detector : std::false_type {};
template <template <class...> class Op, class... Args>
struct Detector<std::void_t<Op<Args...>>, Op, Args...> : std::true_type {};

template <template <class...> class Op, class... Args>
inline constexpr bool is_detected = Detector<void, Op, Args...>::value;

}  // namespace pinnquad::detail
