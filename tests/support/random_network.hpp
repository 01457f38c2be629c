// SPDX-License-Identifier: MIT
// Random numbers for networks: parameters and inputs of order 1, seeded, the same on every machine.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "pinnquad/core/random.hpp"

namespace pinnquad::test {

/// Fills anything contiguous with values in +-largest.
template <class Values>
void fill_uniform(Values& values, std::mt19937_64& engine, double largest = 1.0) {
  for (auto& value : values) value = static_cast<std::decay_t<decltype(value)>>(uniform(engine, -largest, largest));
}

/// Values in +-1 that keep `margin` from 0.
inline std::vector<double> off_zero(std::size_t count, std::mt19937_64& engine, double margin) {
  std::vector<double> values(count);
  for (double& v : values) {
    const double magnitude = uniform(engine, margin, 1.0);
    v = uniform_01(engine) < 0.5 ? -magnitude : magnitude;
  }
  return values;
}

/// Weights in +-sqrt(3 / inputs), so that activations keep their size from layer to layer, and biases in +-0.3.
template <class Scalar>
std::vector<Scalar> random_parameters(const std::vector<int>& sizes, std::mt19937_64& engine) {
  std::vector<Scalar> parameters;
  for (std::size_t layer = 0; layer + 1 < sizes.size(); ++layer) {
    const double limit = std::sqrt(3.0 / sizes[layer]);
    for (int i = 0; i < sizes[layer] * sizes[layer + 1]; ++i) {
      parameters.push_back(static_cast<Scalar>(uniform(engine, -limit, limit)));
    }
    for (int i = 0; i < sizes[layer + 1]; ++i) parameters.push_back(static_cast<Scalar>(uniform(engine, -0.3, 0.3)));
  }
  return parameters;
}

}  // namespace pinnquad::test
