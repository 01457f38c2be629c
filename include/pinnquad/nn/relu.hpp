// SPDX-License-Identifier: MIT
// Rectified linear unit: y = v < 0 ? 0 : v. NaN goes through (fmax would swallow it).
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

template <class ScalarType, int Size>
struct ReluLayer : ElementwiseLayer<ReluLayer<ScalarType, Size>, ScalarType, Size> {
  static PINNQUAD_ALWAYS_INLINE ScalarType activate(ScalarType v) noexcept { return detail::positive_part(v); }
  template <class Pack>
  static PINNQUAD_ALWAYS_INLINE Pack activate(Pack v) noexcept {
    return Pack::positive_part(v);
  }
  /// 1 where y > 0, else 0 (0 at the kink).
  static PINNQUAD_ALWAYS_INLINE ScalarType slope(ScalarType y) noexcept {
    return y > ScalarType(0) ? ScalarType(1) : ScalarType(0);
  }
  template <class Pack>
  static PINNQUAD_ALWAYS_INLINE Pack scaled(Pack y, Pack dy) noexcept {
    return Pack::where_positive(y, dy);
  }
};

struct Relu {
  static constexpr const char* description = "pinnquad::Relu";

  template <class Scalar, int In>
  using Bind = ReluLayer<Scalar, In>;
};

}  // namespace pinnquad
