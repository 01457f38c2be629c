// SPDX-License-Identifier: MIT
// Sigmoid linear unit (swish): y = v / (1 + exp(-v)). Calls the C library once per neuron. NaN for -infinity, as
// PyTorch's SiLU.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/kernel/each_lane.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

template <class ScalarType, int Size>
struct SiluLayer : ElementwiseLayer<SiluLayer<ScalarType, Size>, ScalarType, Size> {
  static constexpr bool lane_by_lane = true;  ///< a pack is no faster than its scalars

  static PINNQUAD_ALWAYS_INLINE ScalarType activate(ScalarType v) noexcept {
    return v / (ScalarType(1) + detail::exponential(-v));
  }
  template <class Pack>
  static PINNQUAD_ALWAYS_INLINE Pack activate(Pack v) noexcept {
    return detail::each_lane(v, [](ScalarType lane) PINNQUAD_INLINE_LAMBDA { return activate(lane); });
  }
  /// s (1 + v (1 - s)) with s = 1 / (1 + exp(-v)). Two inputs have the same output: asked with v.
  static PINNQUAD_ALWAYS_INLINE ScalarType slope_from_input(ScalarType v) noexcept {
    const ScalarType s = detail::logistic(v);
    return s * (ScalarType(1) + v * (ScalarType(1) - s));
  }
  template <class Pack>
  static PINNQUAD_ALWAYS_INLINE Pack scaled_from_input(Pack v, Pack dy) noexcept {
    return dy * detail::each_lane(v, [](ScalarType lane) PINNQUAD_INLINE_LAMBDA { return slope_from_input(lane); });
  }
};

struct Silu {
  static constexpr const char* description = "pinnquad::Silu";

  template <class Scalar, int In>
  using Bind = SiluLayer<Scalar, In>;
};

}  // namespace pinnquad
