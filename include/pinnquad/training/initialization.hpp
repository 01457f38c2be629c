// SPDX-License-Identifier: MIT
// Initial weights: Xavier (Glorot and Bengio 2010), uniform: W in +-sqrt(6 / (inputs + outputs)), biases 0.
#pragma once

#include <cmath>
#include <utility>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/nn/batch_norm.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"
#include "pinnquad/nn/network.hpp"

namespace pinnquad {

namespace detail {
template <class Layer, class Scalar, class Engine>
using InitialiseOf = decltype(Layer::initialise(std::declval<Scalar*>(), std::declval<Engine&>()));

/// Parameters are 0 before. A layer may bring `static void initialise(Scalar* parameters, Engine&)`.
template <class Layer, class Scalar, class Engine>
void initialise(Layer, [[maybe_unused]] Scalar* parameters, [[maybe_unused]] Engine& engine) {
  if constexpr (is_detected<InitialiseOf, Layer, Scalar, Engine>) Layer::initialise(parameters, engine);
}
template <class Scalar, int In, int Out, bool HasBias, class Engine>
void initialise(DenseLayer<Scalar, In, Out, HasBias>, Scalar* parameters, Engine& engine) {
  const double limit = std::sqrt(6.0 / (In + Out));
  for (int i = 0; i < Out * In; ++i) parameters[i] = Scalar(uniform(engine, -limit, limit));
}
/// Nearly the identity. Draws nothing.
template <class Scalar, int Size, class Engine>
void initialise(BatchNorm::Bind<Scalar, Size>, Scalar* parameters, Engine&) {
  for (int i = 0; i < Size; ++i) parameters[i] = parameters[3 * Size + i] = Scalar(1);  // gamma, variance
}
}  // namespace detail

/// A network with initial weights, layer by layer from one engine: the same seed gives the same bits. Other layers with
/// parameters start at 0, unless they have `initialise(parameters, engine)` themselves.
template <class NetworkType, class Engine>
NetworkType initialised(Engine& engine) {
  NetworkType network;
  unroll<NetworkType::layer_count>([&](auto index) {
    using Layer = typename NetworkType::template Layer<decltype(index)::value>;
    detail::initialise(Layer{}, network.parameters.data() + NetworkType::Sizes::offset(index), engine);
  });
  return network;
}

}  // namespace pinnquad
