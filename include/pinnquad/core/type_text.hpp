// SPDX-License-Identifier: MIT
// The fully qualified C++ name of a type, as the compiler prints it, at compile time.
// gcc closes two lists as "> >", clang as ">>"; otherwise both print the same.
#pragma once

#include <string_view>

namespace pinnquad {
namespace detail {

template <class T>
constexpr std::string_view signature() noexcept {
  return __PRETTY_FUNCTION__;
}

/// "pinnquad::Network<float, pinnquad::Inputs<16>, ...>". Types in anonymous namespaces and in functions have no name
/// that another translation unit could use.
template <class T>
constexpr std::string_view type_text() noexcept {
  constexpr std::string_view probe = signature<int>();
  constexpr std::string_view text = signature<T>();
  constexpr std::size_t before = probe.rfind("int");
  constexpr std::size_t after = probe.size() - before - 3;
  return text.substr(before, text.size() - before - after);
}

}  // namespace detail
}  // namespace pinnquad
