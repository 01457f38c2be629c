// SPDX-License-Identifier: MIT
// Softplus: y = log(1 + exp(v)), a smooth ReLU; PyTorch's Softplus(beta=1), without its threshold. Calls the C library
// twice per neuron.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/kernel/each_lane.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

template <class ScalarType, int Size>
struct SoftplusLayer : ElementwiseLayer<SoftplusLayer<ScalarType, Size>, ScalarType, Size> {
  static constexpr bool lane_by_lane = true;  ///< a pack is no faster than its scalars

  /// max(v, 0) + log(1 + exp(-|v|)): nothing overflows.
  static PINNQUAD_ALWAYS_INLINE ScalarType activate(ScalarType v) noexcept {
    return detail::positive_part(v) + detail::log_of_one_plus(detail::exponential(-detail::absolute(v)));
  }
  template <class Pack>
  static PINNQUAD_ALWAYS_INLINE Pack activate(Pack v) noexcept {
    return detail::each_lane(v, [](ScalarType lane) PINNQUAD_INLINE_LAMBDA { return activate(lane); });
  }
  /// 1 / (1 + exp(-v)) = 1 - exp(-y).
  static PINNQUAD_ALWAYS_INLINE ScalarType slope(ScalarType y) noexcept { return -detail::exponential_minus_one(-y); }
  template <class Pack>
  static PINNQUAD_ALWAYS_INLINE Pack scaled(Pack y, Pack dy) noexcept {
    return dy * detail::each_lane(y, [](ScalarType lane) PINNQUAD_INLINE_LAMBDA { return slope(lane); });
  }
};

struct Softplus {
  static constexpr const char* description = "pinnquad::Softplus";

  template <class Scalar, int In>
  using Bind = SoftplusLayer<Scalar, In>;
};

}  // namespace pinnquad
