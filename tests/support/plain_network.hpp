// SPDX-License-Identifier: MIT
// The network a second time: nested loops in double over run-time sizes, nothing of the library. Weights row-major
// (row = output, column = input), then the bias, layer after layer.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace plain {

enum class Activation { none, relu, tanh };

/// Sizes in order, e.g. {16, 8, 4}: two dense layers, `hidden` after each but the last.
struct Network {
  std::vector<int> sizes;
  Activation hidden = Activation::relu;
};

struct Pass {
  std::vector<double> outputs;
  /// Of all that went into a ReLU: how near the pass came to a kink.
  double smallest_pre_activation = std::numeric_limits<double>::infinity();
};

template <class Parameters>
Pass forward(const Network& network, const Parameters& parameters, std::vector<double> x) {
  Pass pass;
  std::size_t at = 0;
  for (std::size_t layer = 0; layer + 1 < network.sizes.size(); ++layer) {
    const auto inputs = static_cast<std::size_t>(network.sizes[layer]);
    const auto outputs = static_cast<std::size_t>(network.sizes[layer + 1]);
    std::vector<double> y(outputs);
    for (std::size_t row = 0; row < outputs; ++row) {
      double sum = static_cast<double>(parameters[at + outputs * inputs + row]);
      for (std::size_t column = 0; column < inputs; ++column) {
        sum += static_cast<double>(parameters[at + row * inputs + column]) * x[column];
      }
      y[row] = sum;
    }
    at += outputs * inputs + outputs;
    if (layer + 2 < network.sizes.size()) {
      for (double& v : y) {
        if (network.hidden == Activation::relu) {
          pass.smallest_pre_activation = std::min(pass.smallest_pre_activation, std::fabs(v));
          v = v > 0.0 ? v : 0.0;
        } else if (network.hidden == Activation::tanh) {
          v = std::tanh(v);
        }
      }
    }
    x = y;
  }
  pass.outputs = x;
  return pass;
}

}  // namespace plain
