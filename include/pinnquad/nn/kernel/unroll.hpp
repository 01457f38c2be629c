// SPDX-License-Identifier: MIT
// Compile-time loop: the body is instantiated once per index, so that arrays of vectors stay in registers.
#pragma once

#include <utility>

#include "pinnquad/core/attributes.hpp"

namespace pinnquad {

/// A compile-time index. std::integral_constant's conversion would be a function of its own in unoptimised code.
template <int Value>
struct Index {
  static constexpr int value = Value;
  PINNQUAD_ALWAYS_INLINE constexpr operator int() const noexcept { return Value; }
};

namespace detail {
template <class Body, int... Each>
PINNQUAD_ALWAYS_INLINE void unroll_indices(const Body& body, std::integer_sequence<int, Each...>) {
  (body(Index<Each>{}), ...);
}
}  // namespace detail

/// body(0), body(1), ..., body(Count - 1) with compile-time indices.
template <int Count, class Body>
PINNQUAD_ALWAYS_INLINE void unroll(const Body& body) {
  detail::unroll_indices(body, std::make_integer_sequence<int, Count>{});
}

}  // namespace pinnquad
