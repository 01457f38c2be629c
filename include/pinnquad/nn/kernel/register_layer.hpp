// SPDX-License-Identifier: MIT
// One dense layer, batch 1, inputs and outputs in registers: a broadcast through memory would wait for the store.
// A block is one register of rows; a step takes Pack::columns inputs to all rows of a block. Several chains of sums
// per block hide the latency of the multiply-add. How rows, inputs and values lie in a register, the packs say: the
// second contract of pack_contract.hpp.
#pragma once

#include <cstddef>

#include "pinnquad/nn/kernel/pack.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

template <class Pack>
using BlocksAtOnceOf = decltype(Pack::blocks_at_once);
/// True for packs that say how a layer lies in their registers.
template <class Pack>
inline constexpr bool keeps_layers_in_registers = is_detected<BlocksAtOnceOf, Pack>;
template <class Pack>
using ColumnMetOf = decltype(Pack::column_met(0, 0));
/// True for packs in whose full registers rows meet the values in an order of their own.
template <class Pack>
inline constexpr bool meets_in_own_order = is_detected<ColumnMetOf, Pack>;

/// Outputs of a layer. One value past whole registers ("lone", 25 = 24 + 1) stands alone: a dot product is cheaper
/// than a block for one row.
template <class Pack, int Size>
struct RegisterValues {
  static constexpr int size = Size;
  static constexpr bool lone = Size > Pack::values&& Size % Pack::values == 1;
  static constexpr int in_registers = lone ? Size - 1 : Size;
  static constexpr int registers = (in_registers + Pack::values - 1) / Pack::values;
  static constexpr int in_own_order = meets_in_own_order<Pack> ? in_registers / Pack::values * Pack::values : 0;

  Pack value[static_cast<std::size_t>(registers)];
  Pack last;  ///< the lone value in the first lane; what the others hold means nothing

  /// The first of the inputs that a pair of lanes takes in a step.
  static constexpr int first_column(int step, int pair) noexcept {
    const int first = step * Pack::columns;
    if constexpr (in_own_order > 0) {
      if (first < in_own_order) {
        return first / Pack::values * Pack::values + Pack::column_met(first % Pack::values, pair);
      }
    }
    return first;
  }
  /// Inputs of one step in every row. Behind an odd count stands a 1: its weight is the bias.
  template <int Step>
  PINNQUAD_ALWAYS_INLINE Pack repeat() const noexcept {
    constexpr int first = Step * Pack::columns;
    if constexpr (lone && first == Size - 1) {
      return Pack::repeat_last(last);
    } else if constexpr (first < in_own_order) {
      return value[first / Pack::values].template meet<first % Pack::values>();
    } else {
      const Pack inputs = value[first / Pack::values].template repeat<first % Pack::values>();
      if constexpr (first + Pack::columns > Size) {
        return inputs.with_one();
      } else {
        return inputs;
      }
    }
  }
  /// Register without what its unused lanes hold, which need not be a number.
  template <int Register>
  PINNQUAD_ALWAYS_INLINE Pack used() const noexcept {
    constexpr int left = in_registers - Register * Pack::values;
    if constexpr (left < Pack::values) {
      return value[Register].template head<left>();
    } else {
      return value[Register];
    }
  }
  /// Every value through `activation`, which maps a pack to a pack.
  template <class Activation>
  PINNQUAD_ALWAYS_INLINE void apply(const Activation& activation) noexcept {
    unroll<registers>([&](auto r) PINNQUAD_INLINE_LAMBDA { value[r] = activation(value[r]); });
    if constexpr (lone) last = activation(last);
  }
  /// y[0, Size) and nothing behind.
  PINNQUAD_ALWAYS_INLINE void store(typename Pack::Scalar* y) const noexcept {
    unroll<registers>([&](auto r) PINNQUAD_INLINE_LAMBDA {
      constexpr int first = decltype(r)::value * Pack::values;
      constexpr int left = in_registers - first;
      value[r].template store_values<(left < Pack::values ? left : Pack::values)>(y + first);
    });
    if constexpr (lone) y[Size - 1] = last.first_value();
  }
};

/// Inputs in a row.
template <class Scalar>
struct InRow {
  const Scalar* x;
  PINNQUAD_ALWAYS_INLINE Scalar operator[](int i) const noexcept { return x[i]; }
  PINNQUAD_ALWAYS_INLINE const Scalar* at(int i) const noexcept { return x + i; }
  static constexpr bool adjoins_next(int) noexcept { return true; }
};

/// Inputs of a network, in memory: the same steps. Narrow loads, because a wide one would wait for the narrow stores
/// before it. `X`: InRow, or anything else with its members.
template <class Pack, int Size, class X>
struct MemoryValues {
  static constexpr int size = Size;
  static constexpr int registers = 0;

  X x;

  static constexpr int first_column(int step, int) noexcept { return step * Pack::columns; }
  template <int Step>
  PINNQUAD_ALWAYS_INLINE Pack repeat() const noexcept {
    constexpr int first = Step * Pack::columns;
    if constexpr (first + Pack::columns > Size) {
      return Pack::repeat_last(Pack::from_scalar(x[first]));
    } else if constexpr (Pack::columns == 1 || X::adjoins_next(first)) {
      return Pack::repeat(x.at(first));
    } else {
      return Pack::repeat(x[first], x[first + 1]);
    }
  }
};

/// W x + b; `Values` is RegisterValues or MemoryValues.
template <class Pack, int Out, class Values>
struct RegisterLayer {
  using Scalar = typename Pack::Scalar;
  static_assert(require_pack<Pack>() && require_register_layout<Pack>());
  using Result = RegisterValues<Pack, Out>;
  static constexpr int in = Values::size;
  static constexpr int steps = (in + Pack::columns - 1) / Pack::columns;
  static constexpr bool bias_in_step = in % Pack::columns != 0;
  /// The lone row as a dot product, where the inputs are in registers; else as a block of its own.
  static constexpr bool dot = Result::lone && Values::registers > 0;
  static constexpr int rows = dot ? Out - 1 : Out;
  static constexpr int rows_per_block = Pack::width / Pack::columns;
  static constexpr int row_of(int block, int pair) noexcept {
    constexpr int per_register = Pack::blocks_per_register;
    return block / per_register * Pack::values + Pack::row_of_pair(block % per_register, pair);
  }
  /// Blocks of which some row exists.
  static constexpr int blocks =
      rows / Pack::values * Pack::blocks_per_register +
      (rows % Pack::values > Pack::row_of_pair(Pack::blocks_per_register - 1, 0) ? Pack::blocks_per_register
                                                                                 : (rows % Pack::values > 0 ? 1 : 0));

  // packed: weights, block by block, step by step; biases; then of the dot product: weights, bias, the lone value's
  // weight
  static constexpr int bias_start = Pack::width * steps * blocks;
  static constexpr int dot_start = bias_start + (bias_in_step ? 0 : Pack::width * blocks);
  static constexpr int lone_start = dot_start + Pack::width * Values::registers;
  static constexpr int size = dot ? lone_start + 2 * Pack::width : dot_start;

  /// Row-major weight and bias -> packed, which is all zero before. Usable at compile time.
  static constexpr void pack(const Scalar* weight, const Scalar* bias, Scalar* packed) noexcept {
    for (int block = 0; block < blocks; ++block) {
      for (int pair = 0; pair < rows_per_block; ++pair) {
        const int row = row_of(block, pair);
        if (row >= rows) continue;
        const int lane = pair * Pack::columns;
        Scalar* const weights = packed + Pack::width * steps * block + lane;
        for (int step = 0; step < steps; ++step) {
          const int first = Values::first_column(step, pair);
          for (int column = first; column < first + Pack::columns && column < in; ++column) {
            weights[Pack::width * step + column - first] = weight[row * in + column];
          }
        }
        (bias_in_step ? weights[Pack::width * (steps - 1) + 1] : packed[bias_start + Pack::width * block + lane]) =
            bias[row];
      }
    }
    if constexpr (dot) {
      for (int column = 0; column < Values::in_registers; ++column) {
        packed[dot_start + Pack::width * (column / Pack::values) + Pack::lane_of_value(column % Pack::values)] =
            weight[rows * in + column];
      }
      packed[lone_start] = bias[rows];
      if (Values::lone) packed[lone_start + Pack::width] = weight[rows * in + in - 1];
    }
  }

  /// `activation` maps a pack to a pack.
  template <class Activation>
  static PINNQUAD_ALWAYS_INLINE Result multiply(const Scalar* packed, const Values& x,
                                                const Activation& activation) noexcept {
    Result result;
    if constexpr (dot) result.last = activation(lone_row(packed, x));  // first: it takes longest
    constexpr int at_once = Pack::blocks_at_once;
    unroll<(blocks + at_once - 1) / at_once>([&](auto group) PINNQUAD_INLINE_LAMBDA {
      constexpr int first = decltype(group)::value * at_once;
      multiply_blocks<first, (blocks - first < at_once ? blocks - first : at_once)>(packed, x, activation, result);
    });
    return result;
  }

 private:
  /// Blocks First, ..., First + Count - 1, step by step.
  template <int First, int Count, class Activation>
  static PINNQUAD_ALWAYS_INLINE void multiply_blocks(const Scalar* packed, const Values& x,
                                                     const Activation& activation, Result& result) noexcept {
    constexpr int most = Pack::chains + (Count < Pack::blocks_at_once ? 1 : 0);
    constexpr int chains = most < steps ? most : steps;
    Pack sum[static_cast<std::size_t>(chains)][static_cast<std::size_t>(Count)];
    unroll<steps>([&](auto s) PINNQUAD_INLINE_LAMBDA {
      constexpr int step = decltype(s)::value;
      const Pack inputs = x.template repeat<step>();
      unroll<Count>([&](auto b) PINNQUAD_INLINE_LAMBDA {
        constexpr int block = First + decltype(b)::value;
        const Pack weights = Pack::load(packed + Pack::width * (steps * block + step));
        if constexpr (step == 0 && !bias_in_step) {
          const Pack bias = Pack::load(packed + bias_start + Pack::width * block);
          sum[0][b] = Pack::multiply_add(inputs, weights, bias);
        } else if constexpr (step < chains) {
          sum[step][b] = inputs * weights;
        } else {
          sum[step % chains][b] = Pack::multiply_add(inputs, weights, sum[step % chains][b]);
        }
        // left to itself, gcc works out one block after the other and spills the inputs
        if constexpr (Pack::blocks_at_once > 1) sum[step % chains][b].settle();
      });
    });
    unroll<Count>([&](auto b) PINNQUAD_INLINE_LAMBDA { add_chains<chains, Count, b>(sum); });
    constexpr int per_register = Pack::blocks_per_register;
    unroll<(Count + per_register - 1) / per_register>([&](auto r) PINNQUAD_INLINE_LAMBDA {
      constexpr int block = decltype(r)::value * per_register;
      Pack together[static_cast<std::size_t>(per_register)];
      unroll<per_register>(
          [&](auto i) PINNQUAD_INLINE_LAMBDA { together[i] = sum[0][block + i < Count ? block + i : Count - 1]; });
      const Pack values = activation(Pack::collect(together));
      constexpr int target = First / per_register + decltype(r)::value;
      // registers are assigned, not packs: gcc takes those through memory
      if constexpr (target < Result::registers) {
        result.value[target].value = values.value;
      } else {
        result.last.value = values.value;
      }
    });
  }

  /// sum[0][block] += the other chains, in pairs.
  template <int Chains, int Count, int Block>
  static PINNQUAD_ALWAYS_INLINE void add_chains(
      Pack (&sum)[static_cast<std::size_t>(Chains)][static_cast<std::size_t>(Count)]) noexcept {
    unroll<Chains / 2>([&](auto c)
                           PINNQUAD_INLINE_LAMBDA { sum[2 * c][Block] = sum[2 * c][Block] + sum[2 * c + 1][Block]; });
    unroll<(Chains - 1) / 2>([&](auto c)
                                 PINNQUAD_INLINE_LAMBDA { sum[0][Block] = sum[0][Block] + sum[2 * c + 2][Block]; });
  }

  static PINNQUAD_ALWAYS_INLINE Pack lone_row(const Scalar* packed, const Values& x) noexcept {
    Pack sum = x.template used<0>() * Pack::load(packed + dot_start);
    unroll<Values::registers - 1>([&](auto r) PINNQUAD_INLINE_LAMBDA {
      constexpr int next = decltype(r)::value + 1;
      sum = Pack::multiply_add(x.template used<next>(), Pack::load(packed + dot_start + Pack::width * next), sum);
    });
    Pack rest = Pack::load(packed + lone_start);
    if constexpr (Values::lone) rest = Pack::multiply_add(x.last, Pack::load(packed + lone_start + Pack::width), rest);
    return sum.sum_of_values() + rest;
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
