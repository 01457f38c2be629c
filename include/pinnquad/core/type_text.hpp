// SPDX-License-Identifier: MIT
// The fully qualified C++ name of a type, as the compiler prints it, at compile time, without the inline namespace that
// names an instruction set: another compiler flag must not make it another name.
// gcc closes two lists as "> >", clang as ">>"; otherwise both print the same.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "pinnquad/core/instruction_set.hpp"

namespace pinnquad {
namespace detail {

template <class T>
constexpr std::string_view signature() noexcept {
  return __PRETTY_FUNCTION__;
}

template <class T>
constexpr std::string_view printed_type() noexcept {
  constexpr std::string_view probe = signature<int>();
  constexpr std::string_view text = signature<T>();
  constexpr std::size_t before = probe.rfind("int");
  constexpr std::size_t after = probe.size() - before - 3;
  return text.substr(before, text.size() - before - after);
}

template <std::size_t Size>
struct Letters {
  std::array<char, Size> letter{};
  std::size_t size = 0;
};

template <class T>
constexpr auto without_instruction_set() noexcept {
  constexpr std::string_view text = printed_type<T>();
  constexpr std::string_view set = instruction_set;  // stands between two "::"
  Letters<text.size()> kept;
  for (std::size_t i = 0; i < text.size(); ++i) {
    kept.letter[kept.size++] = text[i];
    const bool behind_scope = i > 0 && text[i - 1] == ':' && text[i] == ':';
    const bool named = text.substr(i + 1, set.size()) == set && text.substr(i + 1 + set.size(), 2) == "::";
    if (behind_scope && named) i += set.size() + 2;
  }
  return kept;
}
template <class T>
inline constexpr auto type_letters = without_instruction_set<T>();

/// "pinnquad::Network<float, pinnquad::InputSize<16>, ...>". Types in anonymous namespaces and in functions have no
/// name that another translation unit could use.
template <class T>
constexpr std::string_view type_text() noexcept {
  return {type_letters<T>.letter.data(), type_letters<T>.size};
}

}  // namespace detail
}  // namespace pinnquad
