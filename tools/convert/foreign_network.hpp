// SPDX-License-Identifier: MIT
// A network as another framework has it, in double: a chain of affine maps and activations, and what its source says
// that it answers.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace programs {

using Numbers = std::vector<double>;

/// Activations that a source may have, and the library's Clip. A sigmoid becomes a tanh between two affine maps.
enum class ForeignActivation { relu, tanh, sigmoid, gelu, silu, softplus, sine, clip };
inline constexpr std::array<const char*, 8> foreign_activations = {"relu", "tanh",     "sigmoid", "gelu",
                                                                   "silu", "softplus", "sine",    "clip"};
inline constexpr double clip_bound = 3.5;  ///< of the library's Clip, which is PyTorch's Hardtanh(-3.5, 3.5)

/// By its definition, with the C library's functions.
inline double activated(ForeignActivation activation, double v) {
  switch (activation) {
    case ForeignActivation::relu: return v < 0 ? 0 : v;
    case ForeignActivation::tanh: return std::tanh(v);
    case ForeignActivation::sigmoid: return 1 / (1 + std::exp(-v));
    case ForeignActivation::gelu: return 0.5 * v * (1 + std::erf(v * std::sqrt(0.5)));
    case ForeignActivation::silu: return v / (1 + std::exp(-v));
    case ForeignActivation::softplus: return v > 30 ? v : std::log1p(std::exp(v));
    case ForeignActivation::sine: return std::sin(v);
    case ForeignActivation::clip: return v < -clip_bound ? -clip_bound : (v > clip_bound ? clip_bound : v);
  }
  return v;
}

/// y = W x + b, row by row (row = output).
struct ForeignDense {
  std::size_t inputs = 0;
  Numbers weights, bias;

  std::size_t outputs() const { return bias.size(); }
};

/// A step of the chain: dense where it has outputs; else y = scale x + shift where there are numbers; else an
/// activation.
struct ForeignStep {
  ForeignDense dense;
  Numbers scale, shift;
  ForeignActivation activation = ForeignActivation::relu;
};

/// The whole of it.
struct ForeignNetwork {
  std::size_t inputs = 0, outputs = 0;
  std::vector<ForeignStep> steps;
  std::string source;  ///< in words: what it was read from
  /// As the source says, operator by operator: nothing of `steps` plays a part.
  std::function<Numbers(const Numbers&)> evaluate;
};

/// y = step(x).
inline Numbers taken(const ForeignStep& step, const Numbers& x) {
  Numbers y = step.dense.outputs() > 0 ? step.dense.bias : x;
  if (step.dense.outputs() > 0) {
    for (std::size_t row = 0; row < y.size(); ++row) {
      for (std::size_t k = 0; k < x.size(); ++k) y[row] += step.dense.weights[row * x.size() + k] * x[k];
    }
  } else if (!step.scale.empty()) {
    for (std::size_t i = 0; i < y.size(); ++i) y[i] = step.scale[i] * x[i] + step.shift[i];
  } else {
    for (double& value : y) value = activated(step.activation, value);
  }
  return y;
}

inline ForeignStep dense_step(ForeignDense dense) {
  ForeignStep step;
  step.dense = std::move(dense);
  return step;
}
inline ForeignStep affine_step(Numbers scale, Numbers shift) {
  ForeignStep step;
  step.scale = std::move(scale);
  step.shift = std::move(shift);
  return step;
}
inline ForeignStep activation_step(ForeignActivation activation) {
  ForeignStep step;
  step.activation = activation;
  return step;
}

}  // namespace programs
