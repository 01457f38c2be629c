// SPDX-License-Identifier: MIT
// The entries of a std::array as a plain pointer: its own functions are emitted out of line in an unoptimised build,
// where the linker could pick a copy compiled for another instruction set.
#pragma once

#include <type_traits>

#include "pinnquad/core/attributes.hpp"

namespace pinnquad::detail {

/// The first of an array's scalars, also of an array of arrays of them.
template <class Scalar, class Array>
PINNQUAD_ALWAYS_INLINE const Scalar* first_of(const Array& array) noexcept {
  static_assert(std::is_trivially_copyable_v<Array> && sizeof(Array) % sizeof(Scalar) == 0);
  return reinterpret_cast<const Scalar*>(&array);
}
template <class Scalar, class Array>
PINNQUAD_ALWAYS_INLINE Scalar* first_of(Array& array) noexcept {
  static_assert(std::is_trivially_copyable_v<Array> && sizeof(Array) % sizeof(Scalar) == 0);
  return reinterpret_cast<Scalar*>(&array);
}

}  // namespace pinnquad::detail
