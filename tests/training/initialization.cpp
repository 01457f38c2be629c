// SPDX-License-Identifier: MIT
#include "pinnquad/training/initialization.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "pinnquad/nn/batch_norm.hpp"
#include "pinnquad/nn/relu.hpp"
#include "support/own_layers.hpp"

using namespace pinnquad;
using pinnquad::test::ChannelScale;

TEST_CASE_TEMPLATE("Xavier: bounds, mean and variance of each layer, biases 0", Scalar, float, double) {
  using Net = Network<Scalar, InputSize<40>, Dense<100>, Relu, Dense<60>>;
  std::mt19937_64 engine(111);
  const Net net = initialised<Net>(engine);
  const auto check = [&net](int offset, int in, int out) {
    const double limit = std::sqrt(6.0 / (in + out));
    double sum = 0.0, squares = 0.0, largest = 0.0;
    for (int i = 0; i < in * out; ++i) {
      const double w = static_cast<double>(net.parameters[static_cast<std::size_t>(offset + i)]);
      sum += w;
      squares += w * w;
      largest = std::max(largest, std::fabs(w));
    }
    const double count = in * out;
    CHECK(largest <= limit * (1 + 1e-7));  // a float may round up
    CHECK(largest >= 0.99 * limit);
    const double variance = 2.0 / (in + out);                          // Glorot and Bengio, Eq. (12)
    CHECK(std::fabs(sum / count) <= 4 * std::sqrt(variance / count));  // four standard errors
    CHECK(squares / count ==
          doctest::Approx(variance).epsilon(4 * std::sqrt(0.8 / count)));  // kurtosis 1.8 of a uniform
    for (int i = 0; i < out; ++i) CHECK(net.parameters[static_cast<std::size_t>(offset + in * out + i)] == Scalar(0));
  };
  check(0, 40, 100);
  check(40 * 100 + 100, 100, 60);
}

TEST_CASE("the bits of a seed are the same on every compiler and standard library") {
  using Net = Network<double, InputSize<2>, Dense<2>>;
  std::mt19937_64 engine(1);
  const Net net = initialised<Net>(engine);
  std::mt19937_64 again(1);
  const double limit = std::sqrt(6.0 / 4.0);
  for (std::size_t i = 0; i < 4; ++i) {
    const double u = static_cast<double>(again() >> 11) / 9007199254740992.0;
    CHECK(net.parameters[i] == -limit + 2.0 * limit * u);
  }
}

TEST_CASE("a layer that brings its own initial values uses them") {
  using Net = Network<double, InputSize<3>, Dense<4>, ChannelScale>;
  std::mt19937_64 engine(112);
  const Net net = initialised<Net>(engine);
  for (std::size_t i = 16; i < 20; ++i) {
    CHECK(net.parameters[i] >= 0.9);
    CHECK(net.parameters[i] < 1.1);
  }
}

TEST_CASE("batch norm begins near the identity and draws nothing: weights are those of the network without it") {
  using Normed = pinnquad::BatchNormMlp<double, InputSize<16>, Hidden<2, 9>, OutputSize<4>, Relu>;
  std::mt19937_64 engine(113), again(113);
  const auto normed = initialised<Normed>(engine);
  const auto plain = initialised<Mlp<double, InputSize<16>, Hidden<2, 9>, OutputSize<4>, Relu>>(again);
  CHECK(engine() == again());
  for (std::size_t i = 0; i < 144; ++i) CHECK(normed.parameters[i] == plain.parameters[i]);
  for (std::size_t i = 0; i < 81; ++i) CHECK(normed.parameters[144 + 36 + i] == plain.parameters[144 + 9 + i]);
  for (std::size_t i = 0; i < 36; ++i) CHECK(normed.parameters[144 + i] == (i < 9 || i >= 27 ? 1.0 : 0.0));
}
