// SPDX-License-Identifier: MIT
// How much an airframe's signed sums of the commands rise with the angular acceleration: what a model's slopes are
// compared with, and pinned to.
#pragma once

#include <array>

#include "pinnquad/inference/residual_outputs.hpp"

namespace pinnquad {

/// d(signed sum)/d(angular acceleration) about roll, pitch, yaw, s^2/rad.
using AxisSlopes = std::array<double, 3>;

/// The airframe's own in hover, by Eq. (3).
inline AxisSlopes hover_slopes(const Airframe<double>& airframe) noexcept {
  constexpr int features = 6;
  const double hovering[features] = {};
  double by_x[rotor_count * features] = {};
  LinearizedInverse::slopes<features>(static_cast<const double*>(hovering), LinearizedInverse::prepare(airframe),
                                      static_cast<double*>(by_x));
  AxisSlopes slopes{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto signs = allocation_signs(airframe, static_cast<int>(axis));
    for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
      slopes[axis] += signs[rotor] * by_x[rotor * features + 3 + axis];
    }
  }
  return slopes;
}

}  // namespace pinnquad
