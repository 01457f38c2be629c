// SPDX-License-Identifier: MIT
// The contract of a pack, and what is asked of one that also keeps a dense layer in registers. Both are checked where
// a kernel is built, member by member: the compiler's message names what is missing.
//
// A pack is `width` scalars that are computed with at once (`unit`: with what; `fused`: multiply_add() rounds once):
//   load(const Scalar*)  store(Scalar*)  broadcast(Scalar)  +  -  *  /  multiply_add(a, b, c) = a b + c  square_root(a)
//   positive_part(a) = a < 0 ? 0 : a, NaN stays  where_positive(gate, a) = gate > 0 ? a : 0
//   settle(): is worked out here (an empty function, or an empty `asm` that reads and writes the register)
//   tile_rows, tile_vectors: rows and packs of the tile of sums that fits the registers (tile.hpp)
//
// One that has four_columns(const Scalar* x, int stride, Pack (&column)[4]), lane `row` of column[c] =
// x[row * stride + c], transposes faster than one by one (transpose.hpp).
//
// The second contract: how a dense layer lies in registers (register_layer.hpp). A pack that states `blocks_at_once`
// takes part.
//   value: its register
//   columns: inputs that a step takes, 1 or 2; each row stands in `columns` neighbouring lanes (a "pair")
//   values: outputs that one register holds; blocks_per_register: blocks (of width / columns rows) that make it
//   blocks_at_once: blocks worked on side by side; chains: sums per block that hide the multiply-add's latency (one
//   more where fewer blocks are left)
//   lane_of_value(i): the lane where value i of a register stands
//   row_of_pair(block, pair): the row whose products stand in that pair, such that collect() puts it in its place
//   repeat<First>(): values First, ..., First + columns - 1 in every row; repeat(const Scalar*): the same from memory;
//   repeat(a, b): two of them that don't stand side by side (two columns)
//   repeat_last(v): the first lane of v in every row and, with two columns, a 1 behind it
//   with_one(): a 1 in each row's last lane (two columns)
//   from_scalar(v): v in the first lane; first_value(): the first lane
//   collect(sums): blocks_per_register blocks, the lanes of each row added, as values
//   head<Count>(): the first Count values, 0 behind; sum_of_values(): their sum in the first lane
//   store_values<Count>(y): the first Count values to y, nothing behind
//
// One whose pairs may take the values of a full register in different orders has, beside repeat(), meet<First>(): what
// each pair takes in that step, column_met(First, pair) being the first of it. Over all steps a pair meets each once.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/core/scalar_math.hpp"

namespace pinnquad::detail {

// clang-format off
template <class P> using MemoryOf = std::void_t<
    decltype(P::load(std::declval<const typename P::Scalar*>())),
    decltype(P::broadcast(std::declval<typename P::Scalar>())),
    decltype(std::declval<const P&>().store(std::declval<typename P::Scalar*>()))>;
template <class P> using OperatorsOf = std::void_t<
    decltype(std::declval<P>() + std::declval<P>()), decltype(std::declval<P>() - std::declval<P>()),
    decltype(std::declval<P>() * std::declval<P>()), decltype(std::declval<P>() / std::declval<P>())>;
template <class P> using MultiplyAddOf =
    decltype(P::multiply_add(std::declval<P>(), std::declval<P>(), std::declval<P>()));
template <class P> using FunctionsOf = std::void_t<
    decltype(P::square_root(std::declval<P>())), decltype(P::positive_part(std::declval<P>())),
    decltype(P::where_positive(std::declval<P>(), std::declval<P>()))>;
template <class P> using SettleOf = decltype(std::declval<P&>().settle());
template <class P> using TileOf = std::enable_if_t<(P::tile_rows > 0 && P::tile_vectors > 0)>;
template <class P> using ArithmeticOf =
    std::enable_if_t<(P::width > 0 && (P::fused || true) && P::unit >= VectorUnit::none)>;

template <class P> using ColumnsOf =
    std::enable_if_t<(P::columns == 1 || P::columns == 2) && P::width % P::columns == 0>;
template <class P> using ValuesOf =
    std::enable_if_t<P::values == P::blocks_per_register * (P::width / P::columns)>;
template <class P> using ChainsOf = std::enable_if_t<(P::blocks_at_once > 0 && P::chains > 0)>;
template <class P> using PlacesOf = std::enable_if_t<(P::lane_of_value(0) == 0 && P::row_of_pair(0, 0) == 0)>;
template <class P> using RepeatOf = std::void_t<
    decltype(std::declval<const P&>().template repeat<0>()), decltype(P::repeat_last(std::declval<P>())),
    decltype(P::repeat(std::declval<const typename P::Scalar*>()))>;
template <class P> using OfTwoColumns = std::void_t<
    decltype(std::declval<const P&>().with_one()),
    decltype(P::repeat(std::declval<typename P::Scalar>(), std::declval<typename P::Scalar>()))>;
template <class P> using FirstValueOf = std::void_t<
    decltype(P::from_scalar(std::declval<typename P::Scalar>())), decltype(std::declval<const P&>().first_value())>;
template <class P> using CollectOf = decltype(P::collect(std::declval<const P*>()));
template <class P> using OfValuesOf = std::void_t<
    decltype(std::declval<const P&>().template head<1>()), decltype(std::declval<const P&>().sum_of_values()),
    decltype(std::declval<const P&>().template store_values<1>(std::declval<typename P::Scalar*>()))>;
// clang-format on

/// Compiles if `Pack` fulfils the contract at the head of this file; else the message says what it lacks.
template <class Pack>
constexpr bool require_pack() noexcept {
  static_assert(is_detected<ArithmeticOf, Pack>, "pinnquad: a pack states unit, fused and width (pack_contract.hpp)");
  static_assert(
      is_detected<MemoryOf, Pack>,
      "pinnquad: this pack lacks load(const Scalar*), store(Scalar*) or broadcast(Scalar) (pack_contract.hpp)");
  static_assert(is_detected<OperatorsOf, Pack>, "pinnquad: this pack lacks one of + - * / (pack_contract.hpp)");
  static_assert(is_detected<MultiplyAddOf, Pack>,
                "pinnquad: this pack lacks multiply_add(a, b, c) (pack_contract.hpp)");
  static_assert(is_detected<FunctionsOf, Pack>,
                "pinnquad: this pack lacks square_root(a), positive_part(a) or where_positive(gate, a) "
                "(pack_contract.hpp)");
  static_assert(is_detected<SettleOf, Pack>, "pinnquad: this pack lacks settle() (pack_contract.hpp)");
  static_assert(is_detected<TileOf, Pack>, "pinnquad: this pack lacks tile_rows or tile_vectors (pack_contract.hpp)");
  return true;
}

/// The same for the second contract.
template <class Pack>
constexpr bool require_register_layout() noexcept {
  static_assert(is_detected<ColumnsOf, Pack>, "pinnquad: this pack's columns are not 1 or 2 (pack_contract.hpp)");
  static_assert(is_detected<ValuesOf, Pack>,
                "pinnquad: this pack's values are not blocks_per_register * width / columns (pack_contract.hpp)");
  static_assert(is_detected<ChainsOf, Pack>, "pinnquad: this pack lacks blocks_at_once or chains (pack_contract.hpp)");
  static_assert(is_detected<PlacesOf, Pack>,
                "pinnquad: this pack lacks lane_of_value(i) or row_of_pair(block, pair) (pack_contract.hpp)");
  static_assert(is_detected<RepeatOf, Pack>,
                "pinnquad: this pack lacks repeat<First>(), repeat(const Scalar*) or repeat_last(v) "
                "(pack_contract.hpp)");
  static_assert(is_detected<OfTwoColumns, Pack> || Pack::columns == 1,
                "pinnquad: this pack lacks with_one() or repeat(a, b) (pack_contract.hpp)");
  static_assert(is_detected<FirstValueOf, Pack>,
                "pinnquad: this pack lacks from_scalar(v) or first_value() (pack_contract.hpp)");
  static_assert(is_detected<CollectOf, Pack>, "pinnquad: this pack lacks collect(const Pack*) (pack_contract.hpp)");
  static_assert(is_detected<OfValuesOf, Pack>,
                "pinnquad: this pack lacks head<Count>(), sum_of_values() or store_values<Count>(y) "
                "(pack_contract.hpp)");
  return true;
}

inline namespace PINNQUAD_INSTRUCTION_SET {

/// + - * / of a pack that is one register, `value`: the compiler's own operators are the instructions.
template <class Pack>
using RegisterOf = std::enable_if_t<Pack::unit != VectorUnit::none, decltype(Pack::value)>;
template <class Pack, class = RegisterOf<Pack>>
PINNQUAD_ALWAYS_INLINE Pack operator+(Pack a, Pack b) noexcept {
  return {a.value + b.value};
}
template <class Pack, class = RegisterOf<Pack>>
PINNQUAD_ALWAYS_INLINE Pack operator-(Pack a, Pack b) noexcept {
  return {a.value - b.value};
}
template <class Pack, class = RegisterOf<Pack>>
PINNQUAD_ALWAYS_INLINE Pack operator*(Pack a, Pack b) noexcept {
  return {a.value * b.value};
}
template <class Pack, class = RegisterOf<Pack>>
PINNQUAD_ALWAYS_INLINE Pack operator/(Pack a, Pack b) noexcept {
  return {a.value / b.value};
}

/// positive_part() where the compiler may assume that there is no NaN: it may swap the operands of a maximum, the bits
/// it may not.
template <class Pack>
PINNQUAD_ALWAYS_INLINE Pack positive_part_by_bits(const Pack& a) noexcept {
  constexpr bool of_floats = sizeof(typename Pack::Scalar) == sizeof(above_negatives);
  using Integer = std::conditional_t<of_floats, int, long long>;
  using Bits __attribute__((vector_size(sizeof(Pack)))) = Integer;
  const auto bits = reinterpret_cast<Bits>(a.value);
  const Bits bound = Bits{} + static_cast<Integer>(of_floats ? above_negatives : above_negatives_double);
  return {reinterpret_cast<decltype(Pack::value)>(bits & (bits >= bound))};
}

/// The register of a pack with a row in each lane, which takes one input per step; the second contract but for
/// repeat<First>(), head<Count>() and sum_of_values().
template <class Pack, class ScalarType, int Width>
struct OneColumn {
  using Scalar = ScalarType;
  using Register __attribute__((vector_size(Width * sizeof(Scalar)))) = Scalar;
  static constexpr int width = Width;
  static constexpr int columns = 1;
  static constexpr int values = Width;
  static constexpr int blocks_per_register = 1;

  Register value;

  OneColumn() = default;
  PINNQUAD_ALWAYS_INLINE OneColumn(Register v) noexcept : value(v) {}

  static constexpr int lane_of_value(int i) noexcept { return i; }
  static constexpr int row_of_pair(int, int pair) noexcept { return pair; }

  static PINNQUAD_ALWAYS_INLINE Pack repeat(const Scalar* x) noexcept { return Pack::broadcast(*x); }
  static PINNQUAD_ALWAYS_INLINE Pack repeat_last(const Pack& v) noexcept { return v.template repeat<0>(); }
  static PINNQUAD_ALWAYS_INLINE Pack from_scalar(Scalar v) noexcept { return Pack::broadcast(v); }
  static PINNQUAD_ALWAYS_INLINE Pack collect(const Pack* sum) noexcept { return *sum; }
  PINNQUAD_ALWAYS_INLINE Scalar first_value() const noexcept { return value[0]; }
  template <int Count>
  PINNQUAD_ALWAYS_INLINE void store_values(Scalar* y) const noexcept {
    if constexpr (Count == width) {
      static_cast<const Pack*>(this)->store(y);
    } else if constexpr (Count == 1) {
      *y = first_value();
    } else {
      alignas(sizeof(Pack)) Scalar lane[static_cast<std::size_t>(width)];
      static_cast<const Pack*>(this)->store(lane);
      for (int i = 0; i < Count; ++i) y[i] = lane[i];
    }
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
