// SPDX-License-Identifier: MIT
// Bodies of exact_derivatives.hpp.
#pragma once

#include "pinnquad/deploy/exact_derivatives.hpp"

namespace pinnquad {

PINNQUAD_BODY AxisSlopes ExactDerivatives::operator()(const double* features, bool held) const {
  // a value, its derivatives by three angular accelerations, and zeros that fill a pack
  constexpr int numbers = padded<NativePack<double>>(4);
  using Entry = RunTimeNetwork::Values<double, numbers>;
  const int inputs = network_.inputs(), outputs = network_.outputs();
  std::vector<Entry> work(std::size_t(inputs + outputs) + network_.workspace());
  Entry* const x = work.data();
  Entry* const y = x + inputs;
  for (std::size_t i = 0; i < input_mean_.size(); ++i) x[i] = {(features[i] - input_mean_[i]) / input_deviation_[i]};
  each_angular_acceleration(
      held, [&](std::size_t axis, std::size_t feature) { x[feature][axis + 1] = 1 / input_deviation_[feature]; });
  network_.forward<double, numbers>(parameters_.data(), static_cast<const Entry*>(x), y, y + outputs);
  std::vector<double> made(output_mean_.size()), by_outputs(std::size_t(rotor_count) * output_mean_.size());
  for (std::size_t k = 0; k < made.size(); ++k) made[k] = y[k][0] * output_deviation_[k] + output_mean_[k];
  constexpr std::size_t read = RunTimeOutputs<double>::base_features;
  double by_x[rotor_count * read];
  outputs_.slopes(features, made.data(), by_outputs.data(), static_cast<double*>(by_x));
  std::array<Commands<double>, 3> by_acceleration{};
  for (std::size_t rotor = 0; rotor < std::size_t(rotor_count); ++rotor) {
    for (std::size_t k = 0; k < made.size(); ++k) {
      const double slope = by_outputs[rotor * made.size() + k] * output_deviation_[k];
      for (std::size_t axis = 0; axis < 3; ++axis) by_acceleration[axis][rotor] += slope * y[k][axis + 1];
    }
  }
  each_angular_acceleration(held, [&](std::size_t axis, std::size_t feature) {
    for (std::size_t rotor = 0; feature < read && rotor < std::size_t(rotor_count); ++rotor) {
      by_acceleration[axis][rotor] += by_x[rotor * read + feature];
    }
  });
  AxisSlopes result{};
  for (std::size_t axis = 0; axis < 3; ++axis) result[axis] = signed_sum(signs_[axis], by_acceleration[axis]);
  return result;
}

PINNQUAD_BODY std::array<double, 3> ExactDerivatives::signed_sums(const Commands<double>& u) const {
  return {signed_sum(signs_[0], u), signed_sum(signs_[1], u), signed_sum(signs_[2], u)};
}

PINNQUAD_BODY void ExactDerivatives::add_place(int feature, ShownAcceleration shown, bool is_present) {
  if (shown == ShownAcceleration::none || shown == ShownAcceleration::unknown) return;
  places_.push_back({static_cast<std::size_t>(feature), static_cast<std::size_t>(shown), is_present});
}

}  // namespace pinnquad
