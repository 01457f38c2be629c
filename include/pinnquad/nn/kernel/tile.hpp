// SPDX-License-Identifier: MIT
// Matrix products of a mini-batch as outer-product register tiles: no horizontal sums, each loaded row of B serves a whole
// tile. One routine for the three products of back-propagation; only the strides of A differ.
#pragma once

#include "pinnquad/nn/kernel/pack.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"

namespace pinnquad {

namespace detail {

/// C[r][v] = start[v] + sum_k A(r, k) B[k][v] for one tile; A(r, k) = a[r * RowStride + k * DepthStride].
template <class Pack, int Rows, int Vectors, int RowStride, int DepthStride, int Stride>
PINNQUAD_ALWAYS_INLINE void multiply_tile(const typename Pack::Scalar* a, const typename Pack::Scalar* b, int depth,
                                          const typename Pack::Scalar* start, typename Pack::Scalar* c) noexcept {
  Pack sum[Rows][Vectors];
  unroll<Vectors>([&](auto v) PINNQUAD_INLINE_LAMBDA {
    const Pack first =
        start != nullptr ? Pack::load(start + v * Pack::width) : Pack::broadcast(typename Pack::Scalar(0));
    unroll<Rows>([&](auto r) PINNQUAD_INLINE_LAMBDA { sum[r][v] = first; });
  });
  for (int k = 0; k < depth; ++k) {
    Pack row[Vectors];
    unroll<Vectors>([&](auto v) PINNQUAD_INLINE_LAMBDA { row[v] = Pack::load(b + v * Pack::width); });
    unroll<Rows>([&](auto r) PINNQUAD_INLINE_LAMBDA {
      const Pack factor = Pack::broadcast(a[r * RowStride]);
      unroll<Vectors>([&](auto v)
                          PINNQUAD_INLINE_LAMBDA { sum[r][v] = Pack::multiply_add(factor, row[v], sum[r][v]); });
    });
    a += DepthStride;
    b += Stride;
  }
  unroll<Rows>([&](auto r) PINNQUAD_INLINE_LAMBDA {
    unroll<Vectors>([&](auto v) PINNQUAD_INLINE_LAMBDA { sum[r][v].store(c + r * Stride + v * Pack::width); });
  });
}

/// One tile of rows over all columns.
template <class Pack, int Rows, int RowStride, int DepthStride, int Stride, int Columns>
PINNQUAD_ALWAYS_INLINE void multiply_rows(const typename Pack::Scalar* a, const typename Pack::Scalar* b, int depth,
                                          const typename Pack::Scalar* start, typename Pack::Scalar* c) noexcept {
  constexpr int vectors = Columns / Pack::width;
  constexpr int block = vectors < Pack::tile_vectors ? vectors : Pack::tile_vectors;
  constexpr int blocks = vectors / block;
  constexpr int rest = vectors % block;
  unroll<blocks>([&](auto i) PINNQUAD_INLINE_LAMBDA {
    constexpr int offset = decltype(i)::value * block * Pack::width;
    multiply_tile<Pack, Rows, block, RowStride, DepthStride, Stride>(
        a, b + offset, depth, start != nullptr ? start + offset : nullptr, c + offset);
  });
  if constexpr (rest > 0) {
    constexpr int offset = blocks * block * Pack::width;
    multiply_tile<Pack, Rows, rest, RowStride, DepthStride, Stride>(
        a, b + offset, depth, start != nullptr ? start + offset : nullptr, c + offset);
  }
}

}  // namespace detail

/// C = A B (+ start in every row), a run-time count of rows: `rows` is rounded up to whole tiles, C must hold them.
/// A: rows x depth, row-major with stride AStride. B: depth x Columns, C: rows x Columns, both row-major with stride
/// Columns (a multiple of the pack).
template <class Pack, int AStride, int Columns>
void multiply_batch(const typename Pack::Scalar* a, const typename Pack::Scalar* b, int depth,
                    const typename Pack::Scalar* start, typename Pack::Scalar* c, int rows) noexcept {
  constexpr int tile = Pack::tile_rows;
  for (int row = 0; row < rows; row += tile) {
    detail::multiply_rows<Pack, tile, AStride, 1, Columns, Columns>(a + row * AStride, b, depth, start,
                                                                    c + row * Columns);
  }
}

/// C = A^T B, a compile-time count of rows (columns of A), cut into tiles of nearly equal height.
/// A: depth x Rows with stride AStride. B: depth x Columns, C: Rows x Columns, both with stride Columns.
template <class Pack, int Rows, int AStride, int Columns>
void multiply_transposed(const typename Pack::Scalar* a, const typename Pack::Scalar* b, int depth,
                         typename Pack::Scalar* c) noexcept {
  constexpr int largest = Pack::tile_rows + Pack::tile_rows / 4;
  constexpr int tiles = (Rows + largest - 1) / largest;
  constexpr int height = Rows / tiles;
  constexpr int taller = Rows % tiles;  // the first `taller` tiles have one row more
  unroll<tiles>([&](auto i) PINNQUAD_INLINE_LAMBDA {
    constexpr int index = decltype(i)::value;
    constexpr int rows = height + (index < taller ? 1 : 0);
    constexpr int first = index * height + (index < taller ? index : taller);
    detail::multiply_rows<Pack, rows, 1, AStride, Columns, Columns>(a + first, b, depth, nullptr, c + first * Columns);
  });
}

}  // namespace pinnquad
