// SPDX-License-Identifier: MIT
// The fully qualified C++ name of a type as an exported header writes it: the same text from every compiler.
#pragma once

#include <string>

#include "pinnquad/core/type_text.hpp"

namespace pinnquad {

/// "pinnquad::Network<float, pinnquad::InputSize<16>, ...>" (core/type_text.hpp), lists closed as ">>".
template <class T>
std::string type_name() {
  std::string name(detail::type_text<T>());
  for (std::size_t at = name.find("> >"); at != std::string::npos; at = name.find("> >", at)) name.erase(at + 1, 1);
  return name;
}

}  // namespace pinnquad
