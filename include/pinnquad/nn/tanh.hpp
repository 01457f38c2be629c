// SPDX-License-Identifier: MIT
// Hyperbolic tangent activation: y = tanh(v). Calls the C library once per neuron.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/kernel/each_lane.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

template <class ScalarType, int Size>
struct TanhLayer : ElementwiseLayer<TanhLayer<ScalarType, Size>, ScalarType, Size> {
  static constexpr bool lane_by_lane = true;  ///< a pack is no faster than its scalars

  static PINNQUAD_ALWAYS_INLINE ScalarType activate(ScalarType v) noexcept { return detail::hyperbolic_tangent(v); }
  template <class Pack>
  static PINNQUAD_ALWAYS_INLINE Pack activate(Pack v) noexcept {
    return detail::each_lane(v, [](ScalarType lane) PINNQUAD_INLINE_LAMBDA { return activate(lane); });
  }
  /// 1 - y^2.
  static PINNQUAD_ALWAYS_INLINE ScalarType slope(ScalarType y) noexcept { return ScalarType(1) - y * y; }
  template <class Pack>
  static PINNQUAD_ALWAYS_INLINE Pack scaled(Pack y, Pack dy) noexcept {
    return dy - y * y * dy;
  }
};

struct Tanh {
  static constexpr const char* description = "pinnquad::Tanh";

  template <class Scalar, int In>
  using Bind = TanhLayer<Scalar, In>;
};

}  // namespace pinnquad
