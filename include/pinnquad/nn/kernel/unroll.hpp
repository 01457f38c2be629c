// SPDX-License-Identifier: MIT
// Compile-time loop: the body is instantiated once per index, so that arrays of vectors stay in registers.
#pragma once

#include <type_traits>
#include <utility>

#include "pinnquad/core/attributes.hpp"

namespace pinnquad {

namespace detail {
template <class Body, int... Index>
PINNQUAD_ALWAYS_INLINE void unroll_indices(Body&& body, std::integer_sequence<int, Index...>) {
  (body(std::integral_constant<int, Index>{}), ...);
}
}  // namespace detail

/// body(0), body(1), ..., body(Count - 1) with compile-time indices.
template <int Count, class Body>
PINNQUAD_ALWAYS_INLINE void unroll(Body&& body) {
  detail::unroll_indices(body, std::make_integer_sequence<int, Count>{});
}

}  // namespace pinnquad
