// SPDX-License-Identifier: MIT
// Slopes of an airframe's axis commands by the angular acceleration, in hover: a model's slopes are compared with them,
// or pinned to them.
#pragma once

#include <array>

#include "pinnquad/outputs/residual_outputs.hpp"

namespace pinnquad {

/// d(signed sum)/d(angular acceleration) about roll, pitch, yaw, s^2/rad.
using AxisSlopes = std::array<double, 3>;

namespace detail {

/// The slopes of Eq. (3) in hover: of each command by the first features of PaperFeatures.
struct HoverMap {
  static constexpr int features = 6;
  double by_x[rotor_count * features] = {};

  explicit HoverMap(const Airframe<double>& airframe) noexcept {
    const double hovering[features] = {};
    LinearizedBase::slopes<features>(static_cast<const double*>(hovering), LinearizedBase::prepare(airframe),
                                     static_cast<double*>(by_x));
  }
  double operator()(std::size_t rotor, std::size_t feature) const noexcept { return by_x[rotor * features + feature]; }
};

}  // namespace detail

/// The airframe's own in hover, by Eq. (3).
inline AxisSlopes hover_slopes(const Airframe<double>& airframe) noexcept {
  const detail::HoverMap map(airframe);
  AxisSlopes slopes{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto signs = allocation_signs(airframe, static_cast<int>(axis));
    for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
      slopes[axis] += signs[rotor] * map(rotor, 3 + axis);
    }
  }
  return slopes;
}

/// d(sum of the commands)/d(specific force asked along the thrust axis) in hover, s^2/m.
inline double hover_thrust_slope(const Airframe<double>& airframe) noexcept {
  const detail::HoverMap map(airframe);
  double slope = 0;
  for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) slope -= map(rotor, 2);
  return slope;
}

}  // namespace pinnquad
