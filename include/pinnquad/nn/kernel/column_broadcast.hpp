// SPDX-License-Identifier: MIT
// Matrix-vector product for batch 1: each input is broadcast and multiplies its column, several accumulator chains
// hide the multiply-add latency. Weights are packed as they are read, so that a processor can fetch ahead what lies
// beyond its nearest cache: by groups of packs of rows, in a group column by column, the bias as last column.
#pragma once

#include <cstddef>

#include "pinnquad/nn/kernel/pack.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Scalars of a packed Rows x Columns matrix with bias.
template <class Pack, int Rows, int Columns>
inline constexpr int packed_size = padded<Pack>(Rows) * (Columns + 1);

/// Packs of rows that are worked on at once; what is left of them is a smaller group.
inline constexpr int packs_in_group = 4;

/// Row-major weight and bias -> packed, which is all zero before. Usable at compile time.
template <class Pack, int Rows, int Columns, class Scalar>
constexpr void pack_columns(const Scalar* weight, const Scalar* bias, Scalar* packed) noexcept {
  constexpr int group = packs_in_group * Pack::width, padded_rows = padded<Pack>(Rows);
  for (int row = 0; row < Rows; ++row) {
    const int first = row / group * group;
    const int stride = padded_rows - first < group ? padded_rows - first : group;
    Scalar* const to = packed + first * (Columns + 1) + (row - first);
    for (int column = 0; column < Columns; ++column) to[column * stride] = weight[row * Columns + column];
    to[Columns * stride] = bias[row];
  }
}

/// A group of `Count` packs of rows over all columns.
template <class Pack, int Columns, int Count, class Activation>
PINNQUAD_ALWAYS_INLINE void multiply_packed_rows(const typename Pack::Scalar* packed, const typename Pack::Scalar* x,
                                                 typename Pack::Scalar* y, const Activation& activation) noexcept {
  constexpr int stride = Count * Pack::width;
  constexpr int chains = Count >= 4 ? 2 : 4;
  Pack sum[static_cast<std::size_t>(chains)][static_cast<std::size_t>(Count)];
  unroll<Count>([&](auto v) PINNQUAD_INLINE_LAMBDA {
    sum[0][v] = Pack::load(packed + Columns * stride + v * Pack::width);
    unroll<chains - 1>([&](auto c)
                           PINNQUAD_INLINE_LAMBDA { sum[c + 1][v] = Pack::broadcast(typename Pack::Scalar(0)); });
  });
  const auto add_column = [&](int column, auto chain) PINNQUAD_INLINE_LAMBDA {
    const Pack input = Pack::broadcast(x[column]);
    unroll<Count>([&](auto v) PINNQUAD_INLINE_LAMBDA {
      sum[chain][v] = Pack::multiply_add(input, Pack::load(packed + column * stride + v * Pack::width), sum[chain][v]);
    });
  };
  for (int column = 0; column + chains <= Columns; column += chains) {
    unroll<chains>([&](auto c) PINNQUAD_INLINE_LAMBDA { add_column(column + c, c); });
  }
  unroll<Columns % chains>([&](auto c) PINNQUAD_INLINE_LAMBDA { add_column(Columns / chains * chains + c, c); });
  unroll<Count>([&](auto v) PINNQUAD_INLINE_LAMBDA {
    Pack total = sum[0][v] + sum[1][v];
    if constexpr (chains == 4) total = total + (sum[2][v] + sum[3][v]);
    activation(total).store(y + v * Pack::width);
  });
}
/// y[0, padded rows) = activation(W x + b). `activation` maps a pack to a pack.
template <class Pack, int Rows, int Columns, class Activation>
PINNQUAD_ALWAYS_INLINE void multiply_packed(const typename Pack::Scalar* packed, const typename Pack::Scalar* x,
                                            typename Pack::Scalar* y, const Activation& activation) noexcept {
  static_assert(require_pack<Pack>());
  constexpr int vectors = padded<Pack>(Rows) / Pack::width;
  constexpr int whole = vectors / packs_in_group * packs_in_group;
  for (int row = 0; row < whole * Pack::width; row += packs_in_group * Pack::width) {
    multiply_packed_rows<Pack, Columns, packs_in_group>(packed + row * (Columns + 1), x, y + row, activation);
  }
  if constexpr (vectors > whole) {
    constexpr int row = whole * Pack::width;
    multiply_packed_rows<Pack, Columns, vectors - whole>(packed + row * (Columns + 1), x, y + row, activation);
  }
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
