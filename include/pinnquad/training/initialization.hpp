// SPDX-License-Identifier: MIT
// Initial weights. Contract: `template <class Layer, class Engine> void initialise(Scalar* parameters, Engine&) const`.
#pragma once

#include <cmath>

#include "pinnquad/core/random.hpp"
#include "pinnquad/nn/batch_norm.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"
#include "pinnquad/nn/network.hpp"

namespace pinnquad {

/// Xavier (Glorot and Bengio 2010), uniform: W in +-sqrt(6 / (inputs + outputs)), biases 0. Other layers with
/// parameters start at 0 unless they have `initialise(parameters, engine)` themselves.
struct XavierUniform {
  template <class Scalar, int In, int Out, bool HasBias, class Engine>
  void initialise(DenseLayer<Scalar, In, Out, HasBias> layer, Scalar* parameters, Engine& engine) const {
    const double limit = std::sqrt(6.0 / (In + Out));
    for (int i = 0; i < Out * In; ++i) parameters[i] = Scalar(uniform(engine, -limit, limit));
    for (int i = Out * In; i < layer.parameter_count; ++i) parameters[i] = Scalar(0);
  }
  /// gamma 1, beta 0, mean 0, variance 1: nearly the identity. Draws nothing.
  template <class Scalar, int Size, class Engine>
  void initialise(BatchNorm::Bind<Scalar, Size>, Scalar* parameters, Engine&) const {
    for (int i = 0; i < Size; ++i) {
      parameters[i] = Scalar(1);
      parameters[Size + i] = Scalar(0);
      parameters[2 * Size + i] = Scalar(0);
      parameters[3 * Size + i] = Scalar(1);
    }
  }
  template <class Layer, class Scalar, class Engine>
  void initialise(Layer, Scalar* parameters, Engine& engine) const {
    if constexpr (brings_own<Layer, Scalar, Engine>(0)) {
      Layer::initialise(parameters, engine);
    } else {
      for (int i = 0; i < Layer::parameter_count; ++i) parameters[i] = Scalar(0);
    }
  }

 private:
  template <class Layer, class Scalar, class Engine>
  static constexpr auto brings_own(int)
      -> decltype(Layer::initialise(static_cast<Scalar*>(nullptr), std::declval<Engine&>()), true) {
    return true;
  }
  template <class Layer, class Scalar, class Engine>
  static constexpr bool brings_own(long) {
    return false;
  }
};

/// A network with initial weights, layer by layer from one engine: the same seed gives the same bits.
template <class NetworkType, class Initialization = XavierUniform, class Engine>
NetworkType initialised(Engine& engine, const Initialization& initialization = {}) {
  NetworkType network;
  unroll<NetworkType::layer_count>([&](auto index) {
    using Layer = typename NetworkType::template Layer<decltype(index)::value>;
    initialization.initialise(Layer{}, network.parameters.data() + NetworkType::Sizes::offset(index), engine);
  });
  return network;
}

}  // namespace pinnquad
