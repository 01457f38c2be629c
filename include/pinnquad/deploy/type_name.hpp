// SPDX-License-Identifier: MIT
// The fully qualified C++ name of a type, as gcc and clang print it: so that an exported header can name its network.
#pragma once

#include <string>
#include <string_view>

namespace pinnquad {

namespace detail {
template <class T>
constexpr std::string_view signature() noexcept {
  return __PRETTY_FUNCTION__;
}
}  // namespace detail

/// "pinnquad::Network<float, pinnquad::Inputs<16>, ...>". Types in anonymous namespaces and in functions have no name that
/// another translation unit could use. gcc closes two lists as "> >", clang as ">>": here always the latter.
template <class T>
std::string type_name() {
  constexpr std::string_view probe = detail::signature<int>();
  constexpr std::string_view text = detail::signature<T>();
  constexpr std::size_t before = probe.rfind("int");
  constexpr std::size_t after = probe.size() - before - 3;
  std::string name(text.substr(before, text.size() - before - after));
  for (std::size_t at = name.find("> >"); at != std::string::npos; at = name.find("> >", at)) name.erase(at + 1, 1);
  return name;
}

}  // namespace pinnquad
