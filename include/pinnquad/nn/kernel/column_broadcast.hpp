// SPDX-License-Identifier: MIT
// Matrix-vector product for batch 1: each input is broadcast and multiplies its column, several accumulator chains hide the
// multiply-add latency. Weights are packed: column by column, each padded to whole packs, the bias as last column.
#pragma once

#include "pinnquad/nn/kernel/pack.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"

namespace pinnquad {

/// Scalars of a packed Rows x Columns matrix with bias.
template <class Pack, int Rows, int Columns>
inline constexpr int packed_size = padded<Pack>(Rows) * (Columns + 1);

/// Row-major weight and bias -> packed; padding is zero. Usable at compile time.
template <class Pack, int Rows, int Columns, class Scalar>
constexpr void pack_columns(const Scalar* weight, const Scalar* bias, Scalar* packed) noexcept {
  constexpr int stride = padded<Pack>(Rows);
  for (int i = 0; i < packed_size<Pack, Rows, Columns>; ++i) packed[i] = Scalar(0);
  for (int row = 0; row < Rows; ++row) {
    for (int column = 0; column < Columns; ++column) packed[column * stride + row] = weight[row * Columns + column];
    packed[Columns * stride + row] = bias[row];
  }
}

/// y[0, padded rows) = activation(W x + b). `activation` maps a pack to a pack.
template <class Pack, int Rows, int Columns, class Activation>
PINNQUAD_ALWAYS_INLINE void multiply_packed(const typename Pack::Scalar* packed, const typename Pack::Scalar* x,
                                            typename Pack::Scalar* y, const Activation& activation) noexcept {
  constexpr int stride = padded<Pack>(Rows);
  constexpr int vectors = stride / Pack::width;
  constexpr int chains = vectors >= 4 ? 2 : 4;
  unroll<(vectors + 3) / 4>([&](auto block) PINNQUAD_INLINE_LAMBDA {
    constexpr int first = decltype(block)::value * 4;
    constexpr int count = vectors - first < 4 ? vectors - first : 4;
    Pack sum[chains][count];
    unroll<count>([&](auto v) PINNQUAD_INLINE_LAMBDA {
      sum[0][v] = Pack::load(packed + Columns * stride + (first + v) * Pack::width);
    });
    unroll<Columns>([&](auto column) PINNQUAD_INLINE_LAMBDA {
      constexpr int k = decltype(column)::value;
      constexpr int chain = k % chains;
      const Pack input = Pack::broadcast(x[k]);
      unroll<count>([&](auto v) PINNQUAD_INLINE_LAMBDA {
        const Pack weight = Pack::load(packed + k * stride + (first + v) * Pack::width);
        sum[chain][v] = k > 0 && k < chains ? input * weight : Pack::multiply_add(input, weight, sum[chain][v]);
      });
    });
    unroll<count>([&](auto v) PINNQUAD_INLINE_LAMBDA {
      Pack total = sum[0][v];
      if constexpr (Columns >= 4 && chains == 4) {
        total = (sum[0][v] + sum[1][v]) + (sum[2][v] + sum[3][v]);
      } else {
        unroll<(chains < Columns ? chains : Columns) - 1>(
            [&](auto c) PINNQUAD_INLINE_LAMBDA { total = total + sum[c + 1][v]; });
      }
      activation(total).store(y + (first + v) * Pack::width);
    });
  });
}

}  // namespace pinnquad
