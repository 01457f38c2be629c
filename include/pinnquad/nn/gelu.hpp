// SPDX-License-Identifier: MIT
// Gaussian error linear unit (Hendrycks and Gimpel 2016), the exact form: y = v Phi(v) = v (1 + erf(v / sqrt 2)) / 2.
// PyTorch's GELU(approximate='none'). Calls the C library once per neuron. NaN for -infinity, as there.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/kernel/each_lane.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

template <class ScalarType, int Size>
struct GeluLayer : ElementwiseLayer<GeluLayer<ScalarType, Size>, ScalarType, Size> {
  static constexpr bool lane_by_lane = true;  ///< a pack is no faster than its scalars

  static PINNQUAD_ALWAYS_INLINE ScalarType activate(ScalarType v) noexcept { return v * normal_probability(v); }
  template <class Pack>
  static PINNQUAD_ALWAYS_INLINE Pack activate(Pack v) noexcept {
    return detail::each_lane(v, [](ScalarType lane) PINNQUAD_INLINE_LAMBDA { return activate(lane); });
  }
  /// Phi(v) + v phi(v), phi the density of the standard normal distribution. Two inputs have the same output: asked
  /// with v.
  static PINNQUAD_ALWAYS_INLINE ScalarType slope_from_input(ScalarType v) noexcept {
    constexpr auto density_at_0 = ScalarType(0.39894228040143268);  // 1 / sqrt(2 pi)
    return normal_probability(v) + v * (density_at_0 * detail::exponential(ScalarType(-0.5) * v * v));
  }
  template <class Pack>
  static PINNQUAD_ALWAYS_INLINE Pack scaled_from_input(Pack v, Pack dy) noexcept {
    return dy * detail::each_lane(v, [](ScalarType lane) PINNQUAD_INLINE_LAMBDA { return slope_from_input(lane); });
  }

 private:
  /// Phi(v), by erfc: the tail below 0 keeps its digits.
  static PINNQUAD_ALWAYS_INLINE ScalarType normal_probability(ScalarType v) noexcept {
    constexpr auto half_root = ScalarType(0.70710678118654752);  // sqrt(1/2)
    return ScalarType(0.5) * detail::complementary_error_function(-half_root * v);
  }
};

struct Gelu {
  static constexpr const char* description = "pinnquad::Gelu";

  template <class Scalar, int In>
  using Bind = GeluLayer<Scalar, In>;
};

}  // namespace pinnquad
