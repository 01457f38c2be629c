// SPDX-License-Identifier: MIT
// Matrix products of many samples as outer-product register tiles: no horizontal sums, each loaded row of B serves a
// whole tile. One routine for the three products of back-propagation; only the strides of A differ.
#pragma once

#include <cstddef>

#include "pinnquad/nn/kernel/pack.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"

namespace pinnquad {

namespace detail {

/// The columns of a tile: packs [First, First + Vectors), side by side.
template <class PackType, int Vectors, int First = 0>
struct Consecutive {
  using Pack = PackType;
  static constexpr int vectors = Vectors;
  static constexpr int offset(int vector) noexcept { return (First + vector) * Pack::width; }
};

/// Packs [First, First + Vectors) of `Columns` columns without padding: the last pack ends at the last column and may
/// overlap the one before, so that nothing behind a row is read or written.
template <class PackType, int Vectors, int First, int Columns>
struct Overlapping {
  using Pack = PackType;
  static_assert(Pack::width <= Columns, "pinnquad: a pack is wider than the matrix");
  static constexpr int vectors = Vectors;
  static constexpr int offset(int vector) noexcept {
    const int begin = (First + vector) * Pack::width;
    return begin + Pack::width > Columns ? Columns - Pack::width : begin;
  }
};

/// C[r][v] = finish(r, v, start(r, v) + sum_k A(r, k) B[k][v]) for one tile; A(r, k) = a[r * RowStride + k *
/// DepthStride].
template <class Columns, int Rows, int RowStride, int DepthStride, class Scalar, class Start, class Finish>
PINNQUAD_ALWAYS_INLINE void multiply_tile(const Scalar* a, const Scalar* b, int b_stride, int depth, const Start& start,
                                          const Finish& finish, Scalar* c, int c_stride) noexcept {
  using Pack = typename Columns::Pack;
  static_assert(require_pack<Pack>());
  constexpr int vectors = Columns::vectors;
  Pack sum[static_cast<std::size_t>(Rows)][static_cast<std::size_t>(vectors)];
  unroll<Rows>([&](auto r) PINNQUAD_INLINE_LAMBDA {
    unroll<vectors>([&](auto v) PINNQUAD_INLINE_LAMBDA { sum[r][v] = start(r, v); });
  });
  for (int k = 0; k < depth; ++k) {
    Pack row[static_cast<std::size_t>(vectors)];
    unroll<vectors>([&](auto v) PINNQUAD_INLINE_LAMBDA {
      row[v] = Pack::load(b + Columns::offset(v));
      row[v].settle();
    });
    unroll<Rows>([&](auto r) PINNQUAD_INLINE_LAMBDA {
      const Pack factor = Pack::broadcast(a[r * RowStride]);
      unroll<vectors>([&](auto v)
                          PINNQUAD_INLINE_LAMBDA { sum[r][v] = Pack::multiply_add(factor, row[v], sum[r][v]); });
    });
    a += DepthStride;
    b += b_stride;
  }
  unroll<Rows>([&](auto r) PINNQUAD_INLINE_LAMBDA {
    unroll<vectors>(
        [&](auto v) PINNQUAD_INLINE_LAMBDA { finish(r, v, sum[r][v]).store(c + r * c_stride + Columns::offset(v)); });
  });
}

/// Cuts `Rows` into tiles of nearly equal height, at most `Largest`: body(first, rows), `rows` an Index.
template <int Rows, int Largest, class Body>
PINNQUAD_ALWAYS_INLINE void in_even_tiles(const Body& body) noexcept {
  constexpr int tiles = (Rows + Largest - 1) / Largest;
  constexpr int height = Rows / tiles;
  constexpr int taller = Rows % tiles;  // the first `taller` tiles have one row more
  if constexpr (taller > 0) {
    for (int first = 0; first < taller * (height + 1); first += height + 1) body(first, Index<height + 1>{});
  }
  for (int first = taller * (height + 1); first < Rows; first += height) body(first, Index<height>{});
}

/// The same into tiles of `Height`, and one of what is left.
template <int Rows, int Height, class Body>
PINNQUAD_ALWAYS_INLINE void in_full_tiles(const Body& body) noexcept {
  for (int first = 0; first + Height <= Rows; first += Height) body(first, Index<Height>{});
  if constexpr (Rows % Height > 0) {
    body(Index<Rows - Rows % Height>{}, Index<Rows % Height>{});
  }
}

/// C[r][v] = finish(r, v, start(r) + sum_k A(r, k) B[k][v]) over `Vectors` packs of samples, a sample per lane; A as in
/// multiply_tile(). Twelve sums (six rows of two packs) hide the latency of the multiply-add; with many more the
/// processor cannot overlap one tile with the next. Sixteen registers hold twelve sums; with 32, a tile may be one row
/// taller to save another.
template <class Pack, int Vectors, int Rows, int RowStride, int DepthStride, class Scalar, class Start, class Finish>
PINNQUAD_ALWAYS_INLINE void multiply_lanes(const Scalar* a, const Scalar* b, int b_stride, int depth,
                                           const Start& start, const Finish& finish, Scalar* c, int c_stride) noexcept {
  const auto tile = [&](auto first, auto rows) PINNQUAD_INLINE_LAMBDA {
    multiply_tile<Consecutive<Pack, Vectors>, decltype(rows)::value, RowStride, DepthStride>(
        a + first * RowStride, b, b_stride, depth,
        [&](auto r, auto) PINNQUAD_INLINE_LAMBDA { return start(first + r); },
        [&](auto r, auto v, Pack sum) PINNQUAD_INLINE_LAMBDA { return finish(first + r, v, sum); },
        c + first * c_stride, c_stride);
  };
  if constexpr (has_32_registers) {
    in_even_tiles<Rows, 7>(tile);
  } else {
    in_full_tiles<Rows, 6>(tile);
  }
}

/// One tile of rows over all columns.
template <class Pack, int Rows, int AStride, int Columns, int CStride>
PINNQUAD_ALWAYS_INLINE void multiply_rows(const typename Pack::Scalar* a, const typename Pack::Scalar* b, int depth,
                                          typename Pack::Scalar* c) noexcept {
  constexpr int vectors = Columns / Pack::width;
  constexpr int block = vectors <= Pack::tile_vectors + 1 ? vectors : Pack::tile_vectors;
  constexpr int blocks = vectors / block;
  constexpr int rest = vectors % block;
  const auto tile = [&](auto count, int offset) PINNQUAD_INLINE_LAMBDA {
    multiply_tile<Consecutive<Pack, decltype(count)::value>, Rows, AStride, 1>(
        a, b + offset, Columns, depth,
        [](auto, auto) PINNQUAD_INLINE_LAMBDA { return Pack::broadcast(typename Pack::Scalar(0)); },
        [](auto, auto, Pack sum) PINNQUAD_INLINE_LAMBDA { return sum; }, c + offset, CStride);
  };
  for (int i = 0; i < blocks; ++i) tile(Index<block>{}, i * block * Pack::width);
  if constexpr (rest > 0) tile(Index<rest>{}, blocks * block * Pack::width);
}

/// C = A B, cut into tiles of nearly equal height. A: Rows x depth, row-major with stride AStride. B: depth x Columns,
/// C: Rows x Columns with strides Columns (a multiple of the pack) and CStride. Three packs of columns make one tile.
template <class Pack, int Rows, int AStride, int Columns, int CStride = Columns>
PINNQUAD_ALWAYS_INLINE void multiply_matrices(const typename Pack::Scalar* a, const typename Pack::Scalar* b, int depth,
                                              typename Pack::Scalar* c) noexcept {
  constexpr bool as_one = Columns / Pack::width == Pack::tile_vectors + 1;
  constexpr int largest = Pack::tile_rows + (as_one ? 0 : Pack::tile_rows / 4);
  in_even_tiles<Rows, largest>([&](auto first, auto rows) PINNQUAD_INLINE_LAMBDA {
    multiply_rows<Pack, decltype(rows)::value, AStride, Columns, CStride>(a + first * AStride, b, depth,
                                                                          c + first * CStride);
  });
}

}  // namespace detail

}  // namespace pinnquad
