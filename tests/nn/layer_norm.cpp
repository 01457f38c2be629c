// SPDX-License-Identifier: MIT
#include "pinnquad/nn/layer_norm.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "pinnquad/nn/batched_network.hpp"
#include "pinnquad/nn/packed_network.hpp"
#include "pinnquad/nn/relu.hpp"
#include "support/random_network.hpp"

using namespace pinnquad;

TEST_CASE("by hand: gamma, then beta; numbers behind the first pass on") {
  Network<double, InputSize<4>, LayerNorm<2>> centred;
  centred.parameters = {2, 3, 10, 20};
  Network<double, InputSize<4>, RmsNorm<2>> plain;
  plain.parameters = centred.parameters;
  const double x[4] = {1, 7, 5, -6};
  double y[4] = {};
  centred.forward(x, y);
  CHECK(y[0] == doctest::Approx(2 * -3 / std::sqrt(9 + 1e-5) + 10).epsilon(1e-15));
  CHECK(y[1] == doctest::Approx(3 * 3 / std::sqrt(9 + 1e-5) + 20).epsilon(1e-15));
  CHECK(y[2] == 5);
  CHECK(y[3] == -6);
  plain.forward(x, y);
  CHECK(y[0] == doctest::Approx(2 * 1 / std::sqrt(25 + 1e-5) + 10).epsilon(1e-15));
  CHECK(y[1] == doctest::Approx(3 * 7 / std::sqrt(25 + 1e-5) + 20).epsilon(1e-15));
  CHECK(y[3] == -6);
}

TEST_CASE("far from 0 the variance of floats keeps its digits; equal numbers give beta; NaN goes through") {
  Network<float, InputSize<4>, LayerNorm<4>> network;
  network.parameters = {1, 1, 1, 1, 0.5f, 0.5f, 0.5f, 0.5f};
  const float far[4] = {4096.0f, 4097.0f, 4098.0f, 4099.0f}, equal[4] = {-3e7f, -3e7f, -3e7f, -3e7f};
  float y[4] = {};
  network.forward(far, y);
  for (int i = 0; i < 4; ++i) CHECK(double(y[i]) == doctest::Approx(0.5 + (i - 1.5) / std::sqrt(1.25)).epsilon(1e-5));
  network.forward(equal, y);
  for (const float v : y) CHECK(v == 0.5f);
  const float bad[4] = {1, std::numeric_limits<float>::quiet_NaN(), 2, 3};
  network.forward(bad, y);
  for (const float v : y) CHECK(std::isnan(v));
}

TEST_CASE_TEMPLATE("packed and batched passes give the portable bits of a norm", Net,
                   Network<float, InputSize<9>, LayerNorm<9>, RmsNorm<5>>,
                   Network<double, InputSize<9>, RmsNorm<9>, LayerNorm<4>>) {
  using Scalar = typename Net::Scalar;
  constexpr int samples = 2 * BatchedNetwork<Net>::lanes + 3;
  std::mt19937_64 engine(31);
  Net network;
  test::fill_uniform(network.parameters, engine);
  std::vector<Scalar> x(9 * samples), y(x.size());
  test::fill_uniform(x, engine, 4.0);
  BatchedNetwork<Net>::forward(network.parameters.data(), x.data(), y.data(), samples);
  const PackedNetwork<Net> packed(network.parameters);
  for (int s = 0; s < samples; ++s) {
    std::array<Scalar, 9> in{}, expected{}, made{};
    for (int i = 0; i < 9; ++i) in[std::size_t(i)] = x[std::size_t(i * samples + s)];
    network.forward(in.data(), expected.data());
    packed.forward(in.data(), made.data());
    CHECK(std::memcmp(made.data(), expected.data(), sizeof made) == 0);
    for (int i = 0; i < 9; ++i) made[std::size_t(i)] = y[std::size_t(i * samples + s)];
    CHECK(std::memcmp(made.data(), expected.data(), sizeof made) == 0);
  }
}
