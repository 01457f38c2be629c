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

/// Activations that a source may have. A sigmoid becomes a tanh between two affine maps, and relu6, hardtanh are clips.
enum class ForeignActivation {
  relu,
  tanh,
  sigmoid,
  gelu,
  silu,
  softplus,
  sine,
  clip,
  elu,
  leaky_relu,
  relu6,
  hardtanh
};
inline constexpr std::array<const char*, 12> foreign_activations = {
    "relu", "tanh", "sigmoid", "gelu", "silu", "softplus", "sine", "clip", "elu", "leaky_relu", "relu6", "hardtanh"};
// the numbers of the library's own, and of PyTorch where a source says none
inline constexpr double clip_bound = 3.5;  ///< Hardtanh(-3.5, 3.5)
inline constexpr double elu_alpha = 1, leaky_relu_alpha = 0.01;

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
  double lower = -clip_bound, upper = clip_bound;  ///< of a clip; an infinite one bounds nothing
  double alpha = 0;                                ///< of elu and leaky_relu

  /// An alpha that is not the library's, but for the rounding of a float.
  bool has_own_alpha() const {
    return (activation == ForeignActivation::elu && std::abs(alpha - elu_alpha) > 1e-9) ||
           (activation == ForeignActivation::leaky_relu && std::abs(alpha - leaky_relu_alpha) > 1e-9);
  }
};

/// By its definition, with the C library's functions.
inline double activated(const ForeignStep& step, double v) {
  switch (step.activation) {
    case ForeignActivation::relu: return v < 0 ? 0 : v;
    case ForeignActivation::tanh: return std::tanh(v);
    case ForeignActivation::sigmoid: return 1 / (1 + std::exp(-v));
    case ForeignActivation::gelu: return 0.5 * v * (1 + std::erf(v * std::sqrt(0.5)));
    case ForeignActivation::silu: return v / (1 + std::exp(-v));
    case ForeignActivation::softplus: return v > 30 ? v : std::log1p(std::exp(v));
    case ForeignActivation::sine: return std::sin(v);
    case ForeignActivation::elu: return v > 0 ? v : step.alpha * std::expm1(v);
    case ForeignActivation::leaky_relu: return v < 0 ? step.alpha * v : v;
    case ForeignActivation::clip:
    case ForeignActivation::relu6:
    case ForeignActivation::hardtanh: return v < step.lower ? step.lower : (v > step.upper ? step.upper : v);
  }
  return v;
}

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
    for (double& value : y) value = activated(step, value);
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
inline ForeignStep clip_step(double lower, double upper) {
  ForeignStep step;
  step.activation = ForeignActivation::clip;
  step.lower = lower;
  step.upper = upper;
  return step;
}
/// With PyTorch's numbers; the clip is the library's.
inline ForeignStep activation_step(ForeignActivation activation) {
  if (activation == ForeignActivation::relu6) return clip_step(0, 6);
  if (activation == ForeignActivation::hardtanh) return clip_step(-1, 1);
  ForeignStep step;
  step.activation = activation;
  step.alpha = activation == ForeignActivation::elu ? elu_alpha : leaky_relu_alpha;
  return step;
}

}  // namespace programs
