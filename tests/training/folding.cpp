// SPDX-License-Identifier: MIT
#include "pinnquad/training/folding.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "support/batch_norm_networks.hpp"
#include "support/random_network.hpp"

using namespace pinnquad;
using pinnquad::detail::Folded;
using pinnquad::test::fill_uniform;
using pinnquad::test::random_batch_norm_network;

namespace {

/// Folding rounds every weight once: a relative error of half an ulp in each product of a sum, then through the layers
/// behind, whose sums cancel. In ulps of the largest output.
constexpr double ulps = 64;

template <class Net>
void check_outputs() {
  using Scalar = typename Net::Scalar;
  std::mt19937_64 engine(31);
  for (int round = 0; round < 20; ++round) {
    const Net network = random_batch_norm_network<Net>(engine);
    const Folded<Net> plain = folded(network);
    std::vector<Scalar> x(Net::inputs), y(Net::outputs), z(Net::outputs);
    double worst = 0.0, largest = 0.0;
    for (int sample = 0; sample < 20; ++sample) {
      fill_uniform(x, engine, 2.0);
      network.forward(x.data(), y.data());
      plain.forward(x.data(), z.data());
      for (std::size_t i = 0; i < y.size(); ++i) {
        worst = std::max(worst, std::fabs(static_cast<double>(y[i]) - static_cast<double>(z[i])));
        largest = std::max(largest, std::fabs(static_cast<double>(y[i])));
      }
    }
    CHECK(worst <= ulps * static_cast<double>(std::numeric_limits<Scalar>::epsilon()) * largest);
  }
}

}  // namespace

TEST_CASE_TEMPLATE("folded and unfolded agree to rounding", Scalar, float, double) {
  check_outputs<BatchNormMlp<Scalar, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>>();
  check_outputs<BatchNormMlp<Scalar, InputSize<5>, Hidden<1, 3>, OutputSize<2>, Tanh>>();
  check_outputs<
      Network<Scalar, InputSize<5>, Dense<7>, BatchNorm, Relu, DenseWithoutBias<4>, Tanh, Dense<3>, BatchNorm>>();
  check_outputs<Network<Scalar, InputSize<5>, DenseWithoutBias<7>, DenseWithoutBias<4>, BatchNorm>>();
}

TEST_CASE("the folded type is the plain one") {
  using Paper = BatchNormMlp<float, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>;
  CHECK((std::is_same_v<Folded<Paper>, Mlp<float, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>>));
  using Mixed = Network<float, InputSize<5>, Dense<7>, BatchNorm, DenseWithoutBias<4>, Tanh, Dense<3>>;
  CHECK((std::is_same_v<Folded<Mixed>, Network<float, InputSize<5>, Dense<7>, Dense<4>, Tanh, Dense<3>>>));
}

TEST_CASE("a network without batch norm is returned bit for bit") {
  using Net = Mlp<float, InputSize<16>, Hidden<2, 9>, OutputSize<4>, Relu>;
  std::mt19937_64 engine(32);
  const Net network = random_batch_norm_network<Net>(engine);
  CHECK((std::is_same_v<Folded<Net>, Net>));
  CHECK(folded(network).parameters == network.parameters);
}

TEST_CASE("by hand") {
  Network<double, InputSize<2>, Dense<1>, BatchNorm> network;
  network.parameters = {1, 2, 5, /* gamma */ 3, /* beta */ 7, /* mean */ 4, /* variance */ 0.25 - 1e-5};
  const auto plain = folded(network).parameters;  // s = 6
  REQUIRE(plain.size() == 3);
  CHECK(plain[0] == doctest::Approx(6.0));
  CHECK(plain[1] == doctest::Approx(12.0));
  CHECK(plain[2] == doctest::Approx(6.0 * (5 - 4) + 7));
}
