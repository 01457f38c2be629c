// SPDX-License-Identifier: MIT
// One row of a dense layer for many motions side by side, a lane each. Every lane is the chain of the portable kernel:
// bias, then its inputs ascending. The same bits.
#pragma once

#include <array>
#include <cstddef>

#include "pinnquad/nn/kernel/pack.hpp"
#include "pinnquad/nn/kernel/portable.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// sum[lane] += sum over the columns of weights[column] x[column][lane].
template <class Scalar, std::size_t Lanes>
PINNQUAD_ALWAYS_INLINE void add_lane_row(const Scalar* weights, int columns, const std::array<Scalar, Lanes>* x,
                                         std::array<Scalar, Lanes>& sum) noexcept {
  if constexpr (has_vector_unit<Scalar>) {
    using Pack = pinnquad::NativePack<Scalar>;
    constexpr int packs = static_cast<int>(Lanes) / Pack::width;
    static_assert(packs * Pack::width == static_cast<int>(Lanes));
    Pack sums[packs];
    unroll<packs>([&](auto p) PINNQUAD_INLINE_LAMBDA { sums[p] = Pack::load(sum.data() + p * Pack::width); });
    for (int column = 0; column < columns; ++column) {
      const Pack weight = Pack::broadcast(weights[column]);
      const Scalar* const values = x[column].data();
      unroll<packs>([&](auto p) PINNQUAD_INLINE_LAMBDA {
        sums[p] = Pack::multiply_add(weight, Pack::load(values + p * Pack::width), sums[p]);
      });
    }
    unroll<packs>([&](auto p) PINNQUAD_INLINE_LAMBDA { sums[p].store(sum.data() + p * Pack::width); });
  } else {
    for (int column = 0; column < columns; ++column) {
      for (std::size_t lane = 0; lane < Lanes; ++lane) {
        sum[lane] = multiply_add(weights[column], x[column][lane], sum[lane]);
      }
    }
  }
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
