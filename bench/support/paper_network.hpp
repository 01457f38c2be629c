// SPDX-License-Identifier: MIT
// The network of Eq. (4) that all benchmarks run, with weights that keep its activations alive: nothing dies, explodes
// or becomes denormal, so the times are those of a trained network.
#pragma once

#include <array>
#include <cmath>
#include <random>

#include "pinnquad/core/random.hpp"
#include "pinnquad/nn/batch_norm.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"
#include "pinnquad/nn/network.hpp"
#include "pinnquad/nn/relu.hpp"

namespace pinnquad::bench {

using PaperNetwork = Mlp<float, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>;
using PaperBatchNormNetwork = BatchNormMlp<float, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>;
using PaperInput = std::array<float, PaperNetwork::inputs>;
using PaperOutput = std::array<float, PaperNetwork::outputs>;

/// Multiply-adds of one forward pass: 6,125.
inline constexpr int paper_multiply_adds = 16 * 25 + 9 * 25 * 25 + 25 * 4;

/// He et al. (2015), uniform, with small biases: ReLU keeps the variance from layer to layer.
inline PaperNetwork healthy_network(std::uint64_t seed = 1) {
  std::mt19937_64 engine(seed);
  PaperNetwork network;
  unroll<PaperNetwork::layer_count>([&](auto index) {
    using Layer = PaperNetwork::Layer<decltype(index)::value>;
    const int first = PaperNetwork::Sizes::offset(index);
    const int weights = Layer::inputs * Layer::outputs;
    const double bound = std::sqrt(6.0 / Layer::inputs);
    for (int i = 0; i < Layer::parameter_count; ++i) {
      const double limit = i < weights ? bound : 0.1;
      network.parameters[static_cast<std::size_t>(first + i)] = static_cast<float>(uniform(engine, -limit, limit));
    }
  });
  return network;
}

/// A standardised input.
inline PaperInput some_input(std::uint64_t seed = 2) {
  std::mt19937_64 engine(seed);
  PaperInput x{};
  for (float& v : x) v = static_cast<float>(uniform(engine, -1.0, 1.0));
  return x;
}

/// The same weights in another scalar.
template <class Scalar>
typename PaperNetwork::Rebind<Scalar> rebind(const PaperNetwork& network) {
  typename PaperNetwork::Rebind<Scalar> other;
  for (std::size_t i = 0; i < network.parameters.size(); ++i) {
    other.parameters[i] = static_cast<Scalar>(network.parameters[i]);
  }
  return other;
}

/// The next input, made from the last output: what is timed is the latency of a control loop, not a stream of
/// independent samples that the processor would overlap.
template <class Scalar, std::size_t In>
void feed_back(const std::array<Scalar, In>& start, const Scalar* y, Scalar* x, std::size_t outputs = 4) noexcept {
  for (std::size_t i = 0; i < outputs && i < In; ++i) x[i] = start[i] + Scalar(0.125) * y[i];
}

}  // namespace pinnquad::bench
