// SPDX-License-Identifier: MIT
#include "pinnquad/nn/batch_norm.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <type_traits>
#include <vector>

#include "pinnquad/nn/packed_network.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "support/batch_norm_networks.hpp"
#include "support/random_network.hpp"
#include "support/tolerances.hpp"

using namespace pinnquad;
using pinnquad::test::fill_uniform;
using pinnquad::test::random_batch_norm_network;
using pinnquad::test::rounding;

TEST_CASE("by hand: gamma (x - mean) / sqrt(variance + 1e-5) + beta, parameters in that order") {
  Network<double, InputSize<2>, BatchNorm> network;
  network.parameters = {2, 3, 10, 20, 1, 4, 0.25 - 1e-5, 4 - 1e-5};
  const double x[2] = {2, -2};
  double y[2] = {};
  network.forward(x, y);
  CHECK(y[0] == doctest::Approx(2 * (2 - 1) / 0.5 + 10).epsilon(1e-15));
  CHECK(y[1] == doctest::Approx(3 * (-2 - 4) / 2.0 + 20).epsilon(1e-15));
}

TEST_CASE("a variance of 0 divides by sqrt(1e-5), not by 0") {
  Network<double, InputSize<1>, BatchNorm> network;
  network.parameters = {1, 0, 3, 0};
  const double x = 4;
  double y = 0;
  network.forward(&x, &y);
  CHECK(y == doctest::Approx(std::sqrt(1e5)));
}

TEST_CASE("a Dense without bias is W x") {
  Network<double, InputSize<3>, DenseWithoutBias<2>> network;
  network.parameters = {1, 20, 300, 4, 50, 600};
  const double x[3] = {1, 2, 3};
  double y[2] = {};
  network.forward(x, y);
  CHECK(y[0] == 1 + 40 + 900);
  CHECK(y[1] == 4 + 100 + 1800);
}

TEST_CASE("the paper's network with batch norm: between Dense and activation, no bias before it") {
  using Written = Network<float, InputSize<7>, DenseWithoutBias<6>, BatchNorm, Tanh, DenseWithoutBias<6>, BatchNorm,
                          Tanh, Dense<2>>;
  CHECK((std::is_same_v<BatchNormMlp<float, InputSize<7>, Hidden<2, 6>, OutputSize<2>, Tanh>, Written>));
  using Paper = BatchNormMlp<float, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>;
  CHECK(Paper::parameter_count == 16 * 25 + 9 * 25 * 25 + 10 * 4 * 25 + 25 * 4 + 4);
  CHECK(pinnquad::is_layer<BatchNorm>);
  CHECK(pinnquad::is_layer<DenseWithoutBias<3>>);
}

TEST_CASE_TEMPLATE("forward agrees with plain loops in double, portable and packed", Scalar, float, double) {
  using Net = BatchNormMlp<Scalar, InputSize<8>, Hidden<2, 13>, OutputSize<3>, Relu>;
  std::mt19937_64 engine(21);
  for (int round = 0; round < 20; ++round) {
    const Net network = random_batch_norm_network<Net>(engine);
    std::vector<Scalar> x(8);
    fill_uniform(x, engine);
    std::vector<double> expected(x.begin(), x.end());
    std::size_t at = 0;
    const auto next = [&] { return static_cast<double>(network.parameters[at++]); };
    const auto dense = [&](std::size_t out, bool bias) {
      std::vector<double> y(out, 0.0);
      for (double& sum : y) {
        for (const double v : expected) sum += next() * v;
      }
      if (bias) {
        for (double& sum : y) sum += next();
      }
      expected = y;
    };
    for (int hidden = 0; hidden < 2; ++hidden) {
      dense(13, false);
      std::vector<double> norm(4 * 13);
      for (double& v : norm) v = next();
      for (std::size_t i = 0; i < 13; ++i) {
        const double y = norm[i] * (expected[i] - norm[26 + i]) / std::sqrt(norm[39 + i] + 1e-5) + norm[13 + i];
        expected[i] = y > 0 ? y : 0;
      }
    }
    dense(3, true);
    std::vector<Scalar> y(3), packed(3);
    network.forward(x.data(), y.data());
    pinnquad::PackedNetwork<Net>(network.parameters).forward(x.data(), packed.data());
    // sums of at most 13 terms of order 1, three layers deep, scaled by at most 2 / sqrt(0.25) = 4 each
    CHECK(pinnquad::test::distance(y, expected) <= rounding<Scalar>(1000));
    CHECK(pinnquad::test::distance(packed, expected) <= rounding<Scalar>(1000));
  }
}
