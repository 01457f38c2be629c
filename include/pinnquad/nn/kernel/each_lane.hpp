// SPDX-License-Identifier: MIT
// A function of the C library over a pack, lane by lane: the same numbers as scalar by scalar, on every instruction
// set.
#pragma once

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/instruction_set.hpp"

namespace pinnquad {
namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// function(lane) for every lane of `v`.
template <class Pack, class Function>
PINNQUAD_ALWAYS_INLINE Pack each_lane(const Pack& v, const Function& function) noexcept {
  alignas(64) typename Pack::Scalar lane[Pack::width];
  v.store(lane);
  for (auto& value : lane) value = function(value);
  return Pack::load(lane);
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail
}  // namespace pinnquad
