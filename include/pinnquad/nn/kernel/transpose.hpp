// SPDX-License-Identifier: MIT
// Transposes a matrix of any size, a pack of rows by four columns at a time where the pack can.
#pragma once

#include <utility>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/nn/kernel/pack.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

template <class Pack>
using FourColumnsOf =
    decltype(Pack::four_columns(std::declval<const typename Pack::Scalar*>(), 0, std::declval<Pack (&)[4]>()));

/// to[column][row] = from[row][column]; nothing else is read or written.
template <class Pack>
PINNQUAD_NOINLINE void transpose(const typename Pack::Scalar* from, int from_stride, int rows, int columns,
                                 typename Pack::Scalar* to, int to_stride) noexcept {
  int done = 0;
  if constexpr (is_detected<FourColumnsOf, Pack>) {
    if (rows >= Pack::width) {
      done = columns / 4 * 4;
      for (int next = 0; next < rows; next += Pack::width) {
        const int row = next + Pack::width <= rows ? next : rows - Pack::width;  // the last rows overlap those before
        for (int column = 0; column < done; column += 4) {
          Pack four[4];
          Pack::four_columns(from + row * from_stride + column, from_stride, four);
          unroll<4>([&](auto c) PINNQUAD_INLINE_LAMBDA { four[c].store(to + (column + c) * to_stride + row); });
        }
      }
    }
  }
  for (int column = done; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) to[column * to_stride + row] = from[row * from_stride + column];
  }
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
