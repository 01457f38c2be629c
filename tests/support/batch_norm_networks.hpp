// SPDX-License-Identifier: MIT
// Networks with batch norm whose every parameter matters: gammas and variances of order 1, some gammas negative.
#pragma once

#include <random>

#include "pinnquad/core/random.hpp"
#include "pinnquad/nn/batch_norm.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"
#include "support/random_network.hpp"

namespace pinnquad::test {

namespace batch_norm {
template <class Layer, class Scalar>
void randomise_layer(Layer, Scalar* parameters, std::mt19937_64& engine) {
  const double limit = std::sqrt(3.0 / Layer::inputs);
  for (int i = 0; i < Layer::parameter_count; ++i) parameters[i] = static_cast<Scalar>(uniform(engine, -limit, limit));
}
template <class Scalar, int Size>
void randomise_layer(pinnquad::BatchNorm::Bind<Scalar, Size>, Scalar* parameters, std::mt19937_64& engine) {
  for (int i = 0; i < Size; ++i) {
    const double gamma = uniform(engine, 0.5, 2.0);
    parameters[i] = static_cast<Scalar>(i % 5 == 3 ? -gamma : gamma);
    parameters[Size + i] = static_cast<Scalar>(uniform(engine, -0.5, 0.5));
    parameters[2 * Size + i] = static_cast<Scalar>(uniform(engine, -0.5, 0.5));
    parameters[3 * Size + i] = static_cast<Scalar>(uniform(engine, 0.25, 3.0));
  }
}
}  // namespace batch_norm

template <class Net>
Net random_batch_norm_network(std::mt19937_64& engine) {
  Net network;
  unroll<Net::layer_count>([&](auto index) {
    using Layer = typename Net::template Layer<decltype(index)::value>;
    batch_norm::randomise_layer(Layer{}, network.parameters.data() + Net::Sizes::offset(index), engine);
  });
  return network;
}

}  // namespace pinnquad::test
