// SPDX-License-Identifier: MIT
// What the derivative of a model should be, said as rows: beside each row one whose angular acceleration is a little other,
// and whose signed sums are other by the slopes times that. A penalty on (dy/dx d - slope d)^2 by finite differences along
// directions drawn at random: the gradient of the exact one is a second derivative, which a ReLU network has not.
#pragma once

#include <cmath>

#include "pinnquad/outputs/axis_command_outputs.hpp"
#include "pinnquad/outputs/hover_slopes.hpp"
#include "pinnquad/training/training_data.hpp"

namespace pinnquad {

/// `data` and after it the same rows moved along a direction of the angular acceleration of the present, `step` standard
/// deviations long (each row its own). `slopes`: d(signed sum)/d(angular acceleration), s^2/rad, such as hover_slopes().
template <class ContextType, class Data, class Engine>
Data with_tangent_rows(const ContextType& context, const Data& data, const AxisSlopes& slopes, double step,
                       Engine& engine) {
  using Features = typename ContextType::Features;
  static_assert(Features::angular_acceleration >= 0 && is_signed_sums<typename ContextType::Outputs>,
                "pinnquad: tangent rows need angular accelerations and AxisCommandOutputs");
  Data both = data;
  both.features.insert(both.features.end(), data.features.begin(), data.features.end());
  both.outputs.insert(both.outputs.end(), data.outputs.begin(), data.outputs.end());
  both.weights.insert(both.weights.end(), data.weights.begin(), data.weights.end());
  for (int row = data.size(); row < both.size(); ++row) {
    double direction[3], length = 0;
    for (double& v : direction) {
      v = uniform(engine, -1, 1);
      length += v * v;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto feature = static_cast<std::size_t>(Features::angular_acceleration) + axis;
      const double move = length > 0 ? step * direction[axis] / std::sqrt(length) : 0;
      using Scalar = typename std::decay_t<decltype(both.features)>::value_type;
      both.features[static_cast<std::size_t>(row) * Features::size + feature] += static_cast<Scalar>(move);
      both.outputs[static_cast<std::size_t>(row) * 4 + 1 + axis] +=
          static_cast<Scalar>(slopes[axis] * move * context.input.standard_deviation[feature] /
                              context.output.standard_deviation[1 + axis]);
    }
  }
  return both;
}

}  // namespace pinnquad
