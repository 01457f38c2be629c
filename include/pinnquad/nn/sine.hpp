// SPDX-License-Identifier: MIT
// Sine activation (SIREN, Sitzmann et al. 2020): y = sin(v); a frequency is a factor of the weights before it. Calls
// the C library once per neuron. NaN for an infinity.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/nn/kernel/each_lane.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

template <class ScalarType, int Size>
struct SineLayer : ElementwiseLayer<SineLayer<ScalarType, Size>, ScalarType, Size> {
  static constexpr bool lane_by_lane = true;  ///< a pack is no faster than its scalars

  static PINNQUAD_ALWAYS_INLINE ScalarType activate(ScalarType v) noexcept { return detail::sine(v); }
  template <class Pack>
  static PINNQUAD_ALWAYS_INLINE Pack activate(Pack v) noexcept {
    return detail::each_lane(v, [](ScalarType lane) PINNQUAD_INLINE_LAMBDA { return activate(lane); });
  }
  /// cos v: the output does not tell its sign.
  static PINNQUAD_ALWAYS_INLINE ScalarType slope_from_input(ScalarType v) noexcept { return detail::cosine(v); }
  template <class Pack>
  static PINNQUAD_ALWAYS_INLINE Pack scaled_from_input(Pack v, Pack dy) noexcept {
    return dy * detail::each_lane(v, [](ScalarType lane) PINNQUAD_INLINE_LAMBDA { return slope_from_input(lane); });
  }
};

struct Sine {
  static constexpr const char* description = "pinnquad::Sine";

  template <class Scalar, int In>
  using Bind = SineLayer<Scalar, In>;
};

}  // namespace pinnquad
