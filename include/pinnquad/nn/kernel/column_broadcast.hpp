// SPDX-License-Identifier: MIT
// Matrix-vector product for batch 1: each input is broadcast and multiplies its column, several accumulator chains
// hide the multiply-add latency. Weights are packed: column by column, each padded to whole packs, the bias as last
// column.
#pragma once

#include "pinnquad/nn/kernel/pack.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Scalars of a packed Rows x Columns matrix with bias.
template <class Pack, int Rows, int Columns>
inline constexpr int packed_size = padded<Pack>(Rows) * (Columns + 1);

/// Row-major weight and bias -> packed, which is all zero before. Usable at compile time.
template <class Pack, int Rows, int Columns, class Scalar>
constexpr void pack_columns(const Scalar* weight, const Scalar* bias, Scalar* packed) noexcept {
  constexpr int stride = padded<Pack>(Rows);
  for (int row = 0; row < Rows; ++row) {
    for (int column = 0; column < Columns; ++column) packed[column * stride + row] = weight[row * Columns + column];
    packed[Columns * stride + row] = bias[row];
  }
}

/// `Count` packs of rows over all columns; `stride` scalars from column to column.
template <class Pack, int Columns, int Count, class Activation>
PINNQUAD_ALWAYS_INLINE void multiply_packed_rows(const typename Pack::Scalar* packed, int stride,
                                                 const typename Pack::Scalar* x, typename Pack::Scalar* y,
                                                 const Activation& activation) noexcept {
  constexpr int chains = Count >= 4 ? 2 : 4;
  Pack sum[chains][Count];
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
  constexpr int stride = padded<Pack>(Rows);
  constexpr int vectors = stride / Pack::width;
  constexpr int whole = vectors / 4 * 4;  // four packs of rows at once
  for (int v = 0; v < whole; v += 4) {
    multiply_packed_rows<Pack, Columns, 4>(packed + v * Pack::width, stride, x, y + v * Pack::width, activation);
  }
  if constexpr (vectors > whole) {
    multiply_packed_rows<Pack, Columns, vectors - whole>(packed + whole * Pack::width, stride, x,
                                                         y + whole * Pack::width, activation);
  }
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
