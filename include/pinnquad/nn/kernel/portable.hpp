// SPDX-License-Identifier: MIT
// Matrix-vector product straight from row-major weights. Every output is one chain: bias, then its inputs ascending.
// Where the target multiplies and adds in one rounding, so does this: the same bits on all such targets, at any
// optimisation level. Inputs are held in registers and two rows run side by side: few loads, whole cache lines of
// weights in the order of flash.
#pragma once

#include <cstddef>
#include <type_traits>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

/// a * b + c, in one rounding where the hardware has it, in two where it would take a library call.
PINNQUAD_ALWAYS_INLINE float multiply_add(float a, float b, float c) noexcept {
  if constexpr (detail::fuses_float) {
    return __builtin_fmaf(a, b, c);
  } else {
    const float product = a * b;
    return product + c;
  }
}

/// a b + c of doubles, in one rounding where the hardware has it.
PINNQUAD_ALWAYS_INLINE double multiply_add(double a, double b, double c) noexcept {
  if constexpr (detail::fuses_double) {
    return __builtin_fma(a, b, c);
  } else {
    const double product = a * b;
    return product + c;
  }
}

namespace detail {

/// Inputs held at a time: 25, two sums and their weights fill the 32 single-precision registers of a Cortex-M.
inline constexpr int held_inputs = 25;
/// Rows at a time: their sums don't wait for each other. A third would cost a Cortex-M 700 B of code.
inline constexpr int rows_at_once = 2;

/// No bias: each sum starts at 0.
template <class Scalar>
struct NoBias {
  PINNQUAD_ALWAYS_INLINE constexpr Scalar operator[](int) const noexcept { return Scalar(0); }
  PINNQUAD_ALWAYS_INLINE constexpr NoBias operator+(int) const noexcept { return {}; }
};

#if defined(__ARM_FEATURE_FMA) && __ARM_ARCH_PROFILE == 'M' && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__ARMEB__)
/// True where a load takes two weights, which no compiler does by itself: four of ten instructions would be loads.
template <class Scalar>
inline constexpr bool loads_pairs = std::is_same_v<Scalar, float>;

/// Two floats in one register.
using Pair [[gnu::may_alias, gnu::aligned(4)]] = double;
PINNQUAD_ALWAYS_INLINE const Pair& pair_at(const float* weights) noexcept {
  return *reinterpret_cast<const Pair*>(weights);
}

/// Adds the products of two weights of a row, the first one first, each in one rounding; of one row, or of two.
PINNQUAD_ALWAYS_INLINE void add_pair(const float* weights, float first, float second, float& sum) noexcept {
  Pair pair;
  asm("vldr.64 %P1, %2\n\tvfma.f32 %0, %3, %1\n\tvfma.f32 %0, %4, %p1"
      : "+t"(sum), "=&t"(pair)
      : "Uv"(pair_at(weights)), "t"(first), "t"(second));
}
PINNQUAD_ALWAYS_INLINE void add_pairs(const float* weights, int stride, float first, float second, float& sum,
                                      float& below) noexcept {
  Pair upper, lower;
  asm("vldr.64 %P2, %4\n\tvldr.64 %P3, %5\n\t"
      "vfma.f32 %0, %6, %2\n\tvfma.f32 %1, %6, %3\n\tvfma.f32 %0, %7, %p2\n\tvfma.f32 %1, %7, %p3"
      : "+t"(sum), "+t"(below), "=&t"(upper), "=&t"(lower)
      : "Uv"(pair_at(weights)), "Uv"(pair_at(weights + stride)), "t"(first), "t"(second));
}
#else
template <class Scalar>
inline constexpr bool loads_pairs = false;
#endif

/// y[0, Rows) = activate(start + weight x), one row or two; rows of `weight` are `stride` apart.
template <int Rows, int Columns, class Scalar, class Start, class Activate>
PINNQUAD_ALWAYS_INLINE void add_dots(const Scalar* weight, int stride, Start start,
                                     const Scalar (&x)[static_cast<std::size_t>(Columns)], Scalar* y,
                                     Activate activate) noexcept {
  static_assert(Rows == 1 || Rows == rows_at_once);
  Scalar sum = start[0];
  Scalar below = Rows == 2 ? start[Rows - 1] : Scalar(0);
  constexpr int paired = loads_pairs<Scalar> ? Columns / 2 : 0;
  if constexpr (paired > 0) {
    unroll<paired>([&](auto pair) PINNQUAD_INLINE_LAMBDA {
      if constexpr (Rows == 2) {
        add_pairs(weight + 2 * pair, stride, x[2 * pair], x[2 * pair + 1], sum, below);
      } else {
        add_pair(weight + 2 * pair, x[2 * pair], x[2 * pair + 1], sum);
      }
    });
  }
  unroll<Columns - 2 * paired>([&](auto rest) PINNQUAD_INLINE_LAMBDA {
    constexpr int column = 2 * paired + rest;
    sum = multiply_add(weight[column], x[column], sum);
    if constexpr (Rows == 2) below = multiply_add(weight[stride + column], x[column], below);
  });
  y[0] = activate(sum);
  if constexpr (Rows == 2) y[1] = activate(below);
}

/// y[0, Rows) = activate(start + weight x) for as many columns as are held. `x`: a pointer, or anything else with
/// [column].
template <int Rows, int Columns, class Scalar, class Start, class X, class Activate>
PINNQUAD_ALWAYS_INLINE void multiply_held(const Scalar* weight, int stride, Start start, X x, Scalar* y,
                                          Activate activate) noexcept {
  Scalar held[static_cast<std::size_t>(Columns)];
  unroll<Columns>([&](auto column) PINNQUAD_INLINE_LAMBDA { held[column] = x[column]; });
  if constexpr (loads_pairs<Scalar>) PINNQUAD_FORGET(weight);  // a large offset would be added anew for each pair
  // the odd rows first: behind the loop their addresses would be computed anew, each by an instruction
  constexpr int odd = Rows % rows_at_once;
  if constexpr (odd > 0) add_dots<odd, Columns>(weight, stride, start, held, y, activate);
  for (int row = odd; row < Rows; row += rows_at_once) {
    add_dots<rows_at_once, Columns>(weight + row * stride, stride, start + row, held, y + row, activate);
  }
}

}  // namespace detail

/// y = activate(W x + b), entry by entry; W is Rows x Columns, row-major (row = output, column = input). `bias`: a
/// pointer, or NoBias. y may not overlap x: a pointer, or, where all columns are held at a time, anything else with
/// [column]. Wide rows are taken in parts of equal width: sums rest in y from one part to the next.
template <int Rows, int Columns, class Scalar, class Bias, class X, class Activate = detail::Activate<void>>
PINNQUAD_ALWAYS_INLINE void multiply_row_major(const Scalar* weight, Bias bias, X x, Scalar* y,
                                               Activate activate = {}) noexcept {
  using detail::held_inputs;
  constexpr int parts = (Columns + held_inputs - 1) / held_inputs;
  constexpr int width = (Columns + parts - 1) / parts;
  constexpr int last = width * (parts - 1);
  if constexpr (parts == 1) {
    detail::multiply_held<Rows, Columns>(weight, Columns, bias, x, y, activate);
  } else {
    static_assert(std::is_pointer_v<X>, "pinnquad: inputs that are taken in parts stand in a row");
    const Scalar* const sums = y;
    if constexpr (parts == 2) {
      detail::multiply_held<Rows, width>(weight, Columns, bias, x, y, detail::Activate<void>{});
    } else {  // one copy of the code for all parts but the last
      for (int row = 0; row < Rows; ++row) y[row] = bias[row];
      for (int part = 0; part < last; part += width) {
        detail::multiply_held<Rows, width>(weight + part, Columns, sums, x + part, y, detail::Activate<void>{});
      }
    }
    detail::multiply_held<Rows, Columns - last>(weight + last, Columns, sums, x + last, y, activate);
  }
}

/// y += W x for the `Count` columns from `weight` on, at most held_inputs, of rows `stride` apart. Columns taken so in
/// their order give the bits of multiply_row_major().
template <int Rows, int Count, class Scalar>
PINNQUAD_ALWAYS_INLINE void add_columns(const Scalar* weight, int stride, const Scalar* x, Scalar* y) noexcept {
  static_assert(Count <= detail::held_inputs);
  const Scalar* const sums = y;
  detail::multiply_held<Rows, Count>(weight, stride, sums, x, y, detail::Activate<void>{});
}

}  // namespace pinnquad
