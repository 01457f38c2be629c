// SPDX-License-Identifier: MIT
// The network a second time: nested loops in double over run-time sizes, nothing of the library. Weights row-major
// (row = output, column = input), then the bias, layer after layer.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
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

/// Commands of the small model (support/small_model.hpp), or of one with other numbers, for features in physical units.
template <class Model>
std::vector<double> commands(const Model& model, const float* x) {
  const auto scaled = [](const auto& scaler, std::size_t i) {
    return std::pair(static_cast<double>(scaler.mean[i]), static_cast<double>(scaler.standard_deviation[i]));
  };
  std::vector<double> z(16);
  for (std::size_t i = 0; i < z.size(); ++i) {
    const auto [mean, deviation] = scaled(model.input, i);
    z[i] = (static_cast<double>(x[i]) - mean) / deviation;
  }
  auto y = forward({{16, 8, 4}, Activation::relu}, model.parameters, z).outputs;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const auto [mean, deviation] = scaled(model.output, i);
    y[i] = y[i] * deviation + mean;
  }
  return y;
}

}  // namespace plain
