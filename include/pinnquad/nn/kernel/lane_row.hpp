// SPDX-License-Identifier: MIT
// Rows of a dense layer for many motions side by side, a lane each, or for one; of one motion also from weights column
// by column, a row in each lane. Every lane is the chain of the portable kernel: bias, then its inputs ascending. The
// same bits: rows that run together hide each other's latency.
#pragma once

#include <array>
#include <cstddef>

#include "pinnquad/nn/kernel/pack.hpp"
#include "pinnquad/nn/kernel/portable.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// True for lanes that fill packs.
template <class Number, std::size_t Lanes>
inline constexpr bool lanes_fill_packs = Lanes > 1 && has_vector_unit<Number>&& Lanes %
                                                              std::size_t(pinnquad::NativePack<Number>::width) ==
                                                          0;

/// Rows whose sums run side by side: eight chains, of packs or of numbers.
template <class Number, std::size_t Lanes>
constexpr int rows_together() noexcept {
  constexpr int chains = 8;
  if constexpr (lanes_fill_packs<Number, Lanes>) {
    constexpr int packs = static_cast<int>(Lanes) / pinnquad::NativePack<Number>::width;
    return packs < chains ? chains / packs : 1;
  } else {
    return Lanes == 1 ? chains : 1;
  }
}

/// sum[row][lane] += sum over the columns of weights[row * columns + column] x[column][lane], `Rows` of them.
template <int Rows, class Scalar, class Number, std::size_t Lanes>
PINNQUAD_ALWAYS_INLINE void add_rows_together(const Scalar* weights, int columns, const std::array<Number, Lanes>* x,
                                              std::array<Number, Lanes>* sum) noexcept {
  if constexpr (lanes_fill_packs<Number, Lanes>) {
    using Pack = pinnquad::NativePack<Number>;
    constexpr int packs = static_cast<int>(Lanes) / Pack::width;
    Pack sums[static_cast<std::size_t>(Rows)][static_cast<std::size_t>(packs)];
    const auto each = [](const auto& body) PINNQUAD_INLINE_LAMBDA {
      unroll<Rows>([&](auto r)
                       PINNQUAD_INLINE_LAMBDA { unroll<packs>([&](auto p) PINNQUAD_INLINE_LAMBDA { body(r, p); }); });
    };
    each([&](auto r, auto p) PINNQUAD_INLINE_LAMBDA { sums[r][p] = Pack::load(sum[r].data() + p * Pack::width); });
    for (int column = 0; column < columns; ++column) {
      Pack values[static_cast<std::size_t>(packs)];
      unroll<packs>([&](auto p) PINNQUAD_INLINE_LAMBDA { values[p] = Pack::load(x[column].data() + p * Pack::width); });
      unroll<Rows>([&](auto r) PINNQUAD_INLINE_LAMBDA {
        const Pack weight = Pack::broadcast(static_cast<Number>(weights[r * columns + column]));
        unroll<packs>([&](auto p)
                          PINNQUAD_INLINE_LAMBDA { sums[r][p] = Pack::multiply_add(weight, values[p], sums[r][p]); });
      });
    }
    each([&](auto r, auto p) PINNQUAD_INLINE_LAMBDA { sums[r][p].store(sum[r].data() + p * Pack::width); });
  } else {
    std::array<Number, Lanes> sums[static_cast<std::size_t>(Rows)];
    unroll<Rows>([&](auto r) PINNQUAD_INLINE_LAMBDA { sums[r] = sum[r]; });
    for (int column = 0; column < columns; ++column) {
      unroll<Rows>([&](auto r) PINNQUAD_INLINE_LAMBDA {
        const auto weight = static_cast<Number>(weights[r * columns + column]);
        for (std::size_t lane = 0; lane < Lanes; ++lane) {
          sums[r][lane] = multiply_add(weight, x[column][lane], sums[r][lane]);
        }
      });
    }
    unroll<Rows>([&](auto r) PINNQUAD_INLINE_LAMBDA { sum[r] = sums[r]; });
  }
}

/// The same for any number of rows.
template <class Scalar, class Number, std::size_t Lanes>
PINNQUAD_ALWAYS_INLINE void add_lane_rows(const Scalar* weights, int rows, int columns,
                                          const std::array<Number, Lanes>* x, std::array<Number, Lanes>* sum) noexcept {
  constexpr int together = rows_together<Number, Lanes>();
  int row = 0;
  for (; row + together <= rows; row += together) {
    add_rows_together<together>(weights + row * columns, columns, x, sum + row);
  }
  for (; row < rows; ++row) add_rows_together<1>(weights + row * columns, columns, x, sum + row);
}

/// sum[row] = bias[row] + sum over the columns of weights[column * stride + row] x[column], of as many rows as `Packs`
/// hold.
template <int Packs, class Number>
PINNQUAD_ALWAYS_INLINE void sum_packs_of_rows(const Number* weights, int stride, int columns, const Number* bias,
                                              const Number* x, Number* sum) noexcept {
  using Pack = pinnquad::NativePack<Number>;
  Pack sums[static_cast<std::size_t>(Packs)];
  unroll<Packs>([&](auto p) PINNQUAD_INLINE_LAMBDA { sums[p] = Pack::load(bias + p * Pack::width); });
  for (int column = 0; column < columns; ++column) {
    const Pack value = Pack::broadcast(x[column]);
    const Number* const weight = weights + column * stride;
    unroll<Packs>([&](auto p) PINNQUAD_INLINE_LAMBDA {
      sums[p] = Pack::multiply_add(Pack::load(weight + p * Pack::width), value, sums[p]);
    });
  }
  unroll<Packs>([&](auto p) PINNQUAD_INLINE_LAMBDA { sums[p].store(sum + p * Pack::width); });
}

/// The same of `rows` that fill packs: the most at once first, then what is left.
template <int Packs = 8, class Number>
PINNQUAD_ALWAYS_INLINE void sum_turned_rows(const Number* weights, int stride, int rows, int columns,
                                            const Number* bias, const Number* x, Number* sum) noexcept {
  constexpr int together = Packs * pinnquad::NativePack<Number>::width;
  int row = 0;
  for (; row + together <= rows; row += together) {
    sum_packs_of_rows<Packs>(weights + row, stride, columns, bias + row, x, sum + row);
  }
  if constexpr (Packs > 1) {
    if (row < rows) {
      sum_turned_rows<Packs - 1>(weights + row, stride, rows - row, columns, bias + row, x, sum + row);
    }
  }
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
