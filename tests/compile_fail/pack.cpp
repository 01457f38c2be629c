// SPDX-License-Identifier: MIT
#include <cmath>

#include "pinnquad/nn/packed_network.hpp"
#include "pinnquad/nn/relu.hpp"

/// Two floats, with a layout of registers.
struct TwoFloats {
  using Scalar = float;
  static constexpr pinnquad::VectorUnit unit = pinnquad::VectorUnit::none;
  static constexpr bool fused = false;
  static constexpr int width = 2;
#ifndef PACK_WITHOUT_TILE
  static constexpr int tile_rows = 2, tile_vectors = 1;
#endif
  struct {
    float a, b;
  } value;

  static TwoFloats load(const float* p) noexcept { return {{p[0], p[1]}}; }
  static TwoFloats broadcast(float v) noexcept { return {{v, v}}; }
  void store(float* p) const noexcept { p[0] = value.a, p[1] = value.b; }
#ifndef PACK_WITHOUT_MULTIPLY_ADD
  static TwoFloats multiply_add(TwoFloats x, TwoFloats y, TwoFloats z) noexcept { return x * y + z; }
#endif
  friend TwoFloats operator+(TwoFloats x, TwoFloats y) noexcept {
    return {{x.value.a + y.value.a, x.value.b + y.value.b}};
  }
  friend TwoFloats operator-(TwoFloats x, TwoFloats y) noexcept {
    return {{x.value.a - y.value.a, x.value.b - y.value.b}};
  }
  friend TwoFloats operator*(TwoFloats x, TwoFloats y) noexcept {
    return {{x.value.a * y.value.a, x.value.b * y.value.b}};
  }
  friend TwoFloats operator/(TwoFloats x, TwoFloats y) noexcept {
    return {{x.value.a / y.value.a, x.value.b / y.value.b}};
  }
  static TwoFloats square_root(TwoFloats v) noexcept { return {{std::sqrt(v.value.a), std::sqrt(v.value.b)}}; }
  static TwoFloats positive_part(TwoFloats v) noexcept {
    return {{v.value.a < 0 ? 0 : v.value.a, v.value.b < 0 ? 0 : v.value.b}};
  }
  static TwoFloats where_positive(TwoFloats g, TwoFloats v) noexcept {
    return {{g.value.a > 0 ? v.value.a : 0, g.value.b > 0 ? v.value.b : 0}};
  }
#ifndef PACK_WITHOUT_SETTLE
  void settle() noexcept {}
#endif

#if defined(LAYOUT_OF_THREE_COLUMNS)
  static constexpr int columns = 3;
#else
  static constexpr int columns = 1;
#endif
#if defined(LAYOUT_OF_OTHER_VALUES)
  static constexpr int values = 3;
#else
  static constexpr int values = 2;
#endif
  static constexpr int blocks_per_register = 1, blocks_at_once = 1, chains = 1;
  static constexpr int lane_of_value(int value) noexcept { return value; }
  static constexpr int row_of_pair(int, int pair) noexcept { return pair; }
  template <int First>
  TwoFloats repeat() const noexcept {
    return broadcast(First == 0 ? value.a : value.b);
  }
  static TwoFloats repeat(const float* x) noexcept { return broadcast(*x); }
  static TwoFloats repeat_last(TwoFloats v) noexcept { return broadcast(v.value.a); }
  static TwoFloats from_scalar(float v) noexcept { return broadcast(v); }
#ifndef LAYOUT_WITHOUT_COLLECT
  static TwoFloats collect(const TwoFloats* sum) noexcept { return *sum; }
#endif
  template <int Count>
  TwoFloats head() const noexcept {
    return {{value.a, Count > 1 ? value.b : 0}};
  }
  TwoFloats sum_of_values() const noexcept { return broadcast(value.a + value.b); }
  float first_value() const noexcept { return value.a; }
  template <int Count>
  void store_values(float* y) const noexcept {
    y[0] = value.a;
    if (Count > 1) y[1] = value.b;
  }
};

template <class Pack>
float answered() {
  using namespace pinnquad;
  using Net = Mlp<float, InputSize<4>, Hidden<2, 5>, OutputSize<3>, Relu>;
  const Net net{};
  const float x[Net::inputs] = {};
  float y[Net::outputs] = {};
  PackedNetwork<Net, Pack>(net.parameters).forward(x, y);
  return y[0];
}

// SOUND
const float y = answered<TwoFloats>();

// CASE PACK_WITHOUT_MULTIPLY_ADD: pinnquad: this pack lacks multiply_add
const float y = answered<TwoFloats>();
// CASE PACK_WITHOUT_SETTLE: pinnquad: this pack lacks settle
const float y = answered<TwoFloats>();
// CASE PACK_WITHOUT_TILE: pinnquad: this pack lacks tile_rows
const float y = answered<TwoFloats>();
// CASE LAYOUT_WITHOUT_COLLECT: pinnquad: this pack lacks collect
const float y = answered<TwoFloats>();
// CASE LAYOUT_OF_THREE_COLUMNS: pinnquad: this pack's columns are not 1 or 2
const float y = answered<TwoFloats>();
// CASE LAYOUT_OF_OTHER_VALUES: pinnquad: this pack's values are not blocks_per_register
const float y = answered<TwoFloats>();
