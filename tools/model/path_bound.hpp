// SPDX-License-Identifier: MIT
// Bounds of a network's derivatives along a direction, valid at every input: the products of the weights along each
// path from the inputs to an output are added up, each activation's slope anywhere from 0 to 1 (docs/certificate.md).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "pinnquad/exported/run_time_network.hpp"

namespace programs {

/// Ends of an interval for each of several numbers.
struct Intervals {
  std::vector<double> least, most;
};

/// The intervals of `outputs` weighted sums of intervals, weights row by row. Intervals that hold 0 add up numbers of
/// one sign at each end: rounding errs by less than (inputs + 1) 2^-53 of it.
template <class Scalar>
Intervals weighed_intervals(const Scalar* weights, std::size_t outputs, const Intervals& from) {
  Intervals sums{std::vector<double>(outputs), std::vector<double>(outputs)};
  for (std::size_t row = 0; row < outputs; ++row) {
    for (std::size_t i = 0; i < from.least.size(); ++i) {
      const auto weight = static_cast<double>(*weights++);
      sums.least[row] += weight * (weight < 0 ? from.most[i] : from.least[i]);
      sums.most[row] += weight * (weight < 0 ? from.least[i] : from.most[i]);
    }
  }
  return sums;
}

/// Bounds of a network's outputs from those of its first layer, of `inputs` numbers, each holding 0. `widths`: outputs
/// of each dense layer; parameters in the order of a Network.
template <class Scalar>
Intervals path_bound_behind_first(const Scalar* parameters, std::size_t inputs, const std::vector<std::size_t>& widths,
                                  Intervals bounds) {
  std::size_t operations = 4;
  const Scalar* own = parameters + (inputs + 1) * widths[0];
  for (std::size_t layer = 1; layer < widths.size(); ++layer) {
    bounds = weighed_intervals(own, widths[layer], bounds);
    own += (widths[layer - 1] + 1) * widths[layer];
    operations += widths[layer - 1] + 1;
  }
  const double outward = 1 + static_cast<double>(operations) * std::numeric_limits<double>::epsilon();
  for (double& end : bounds.least) end *= outward;
  for (double& end : bounds.most) end *= outward;
  return bounds;
}

/// Bounds along a direction, of which each entry is in an interval: tighter than the sum of the bounds by each input.
template <class Scalar>
Intervals path_bound_along(const Scalar* parameters, const std::vector<std::size_t>& widths,
                           const Intervals& direction) {
  const std::size_t inputs = direction.least.size();
  Intervals first = weighed_intervals(parameters, widths[0], direction);
  for (std::size_t row = 0; row < widths[0]; ++row) {
    double magnitudes = 0;  // of products that may cancel
    for (std::size_t i = 0; i < inputs; ++i) {
      const auto weight = static_cast<double>(parameters[row * inputs + i]);
      magnitudes += (weight < 0 ? -weight : weight) * std::max(-direction.least[i], direction.most[i]);
    }
    const double doubt = static_cast<double>(inputs + 1) * std::numeric_limits<double>::epsilon() * magnitudes;
    first.least[row] = std::min(0.0, first.least[row] - doubt);
    first.most[row] = std::max(0.0, first.most[row] + doubt);
  }
  return path_bound_behind_first(parameters, inputs, widths, std::move(first));
}

/// The outputs of each dense layer of a network whose path bound is known: at most 3, with activations between them
/// whose slope is from 0 to 1. Empty for any other: of Gelu, Silu and Sine it is not, and of more layers the bound says
/// nothing.
inline std::vector<std::size_t> bounded_widths(const pinnquad::RunTimeNetwork& network,
                                               const pinnquad::RunTimeNetwork::Part& part) {
  constexpr std::array<std::string_view, 5> slopes_from_0_to_1 = {
      "pinnquad::Relu", "pinnquad::LeakyRelu", "pinnquad::Tanh", "pinnquad::Softplus", "pinnquad::Elu"};
  if (part.axis_aligned || part.layer_count > 5 || part.layer_count % 2 == 0 || network.is_double()) return {};
  std::vector<std::size_t> widths;
  for (int i = 0; i < part.layer_count; ++i) {
    const pinnquad::RunTimeNetwork::Layer& layer = part.layers[i];
    if (i % 2 == 0) {
      if (layer.outputs == 0 || !layer.has_bias) return {};
      widths.push_back(static_cast<std::size_t>(layer.outputs));
    } else if (layer.activation < 0 ||
               std::find(slopes_from_0_to_1.begin(), slopes_from_0_to_1.end(),
                         pinnquad::detail::run_time_activations<double>[layer.activation].description) ==
                   slopes_from_0_to_1.end()) {
      return {};
    }
  }
  return widths;
}

}  // namespace programs
