// SPDX-License-Identifier: MIT
#include "pinnquad/nn/batched_network.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "pinnquad/core/random.hpp"
#include "pinnquad/nn/batch_norm.hpp"
#include "pinnquad/nn/elu.hpp"
#include "pinnquad/nn/gelu.hpp"
#include "pinnquad/nn/leaky_relu.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/silu.hpp"
#include "pinnquad/nn/sine.hpp"
#include "pinnquad/nn/softplus.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "support/own_layers.hpp"

using namespace pinnquad;

namespace {

template <class Scalar>
std::vector<Scalar> random_values(std::size_t count, std::mt19937_64& engine) {
  std::vector<Scalar> values(count);
  for (Scalar& v : values) v = static_cast<Scalar>(uniform(engine, -1.0, 1.0));
  return values;
}

/// Each sample on its own, by the portable kernel.
template <class Net>
std::vector<typename Net::Scalar> one_by_one(const Net& net, const std::vector<typename Net::Scalar>& x, int samples) {
  using Scalar = typename Net::Scalar;
  const auto at = [samples](int row, int s) { return static_cast<std::size_t>(row * samples + s); };
  std::vector<Scalar> y(static_cast<std::size_t>(Net::outputs * samples));
  for (int s = 0; s < samples; ++s) {
    Scalar in[static_cast<std::size_t>(Net::inputs)], out[static_cast<std::size_t>(Net::outputs)];
    for (int i = 0; i < Net::inputs; ++i) in[i] = x[at(i, s)];
    net.forward(in, out);
    for (int i = 0; i < Net::outputs; ++i) y[at(i, s)] = out[i];
  }
  return y;
}

template <class Net, class Pack>
void check_all_sizes() {
  using Scalar = typename Net::Scalar;
  using Batched = BatchedNetwork<Net, Pack>;
  std::mt19937_64 engine(11);
  Net net;
  for (Scalar& v : net.parameters) v = static_cast<Scalar>(uniform(engine, 0.05, 0.5) * (engine() % 2 == 0 ? 1 : -1));
  // without hardware FMA both round product and sum apart; with it the packs that have none do
  const double tolerance = 4 * 25 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());
  for (const int samples : {0, 1, 2, Batched::lanes - 1, Batched::lanes, Batched::lanes + 1, 3 * Batched::lanes, 101}) {
    CAPTURE(samples);
    const auto x = random_values<Scalar>(static_cast<std::size_t>(Net::inputs * samples), engine);
    const auto expected = one_by_one(net, x, samples);
    constexpr Scalar untouched(-77);
    std::vector<Scalar> y(expected.size() + 1, untouched);
    Batched::forward(net.parameters.data(), x.data(), y.data(), samples);
    CHECK(y.back() == untouched);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const auto e = static_cast<double>(expected[i]);
      REQUIRE(std::abs(static_cast<double>(y[i]) - e) <= tolerance * (1 + std::abs(e)));
    }
  }
}

}  // namespace

TEST_CASE_TEMPLATE("every sample of a batch as if alone", Net,
                   Mlp<float, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>,
                   Mlp<double, InputSize<17>, Hidden<2, 9>, OutputSize<4>, Tanh>,
                   Network<float, InputSize<1>, Dense<1>>,
                   Network<float, InputSize<5>, Relu, DenseWithoutBias<8>, Tanh, Dense<13>>,
                   Network<float, InputSize<6>, Dense<7>, Gelu, DenseWithoutBias<5>, Silu, Sine, Dense<3>, Softplus>,
                   Network<float, InputSize<6>, Dense<7>, Elu, Dense<9>, pinnquad::LeakyRelu, Elu, Dense<3>>,
                   Network<float, InputSize<6>, Dense<7>, test::LeakyRelu, test::ChannelScale, Dense<2>>) {
  using Scalar = typename Net::Scalar;
  SUBCASE("native pack") { check_all_sizes<Net, NativePack<Scalar>>(); }
  SUBCASE("packs of 4") { check_all_sizes<Net, GenericPack<Scalar, 4>>(); }
  SUBCASE("packs of 3") { check_all_sizes<Net, GenericPack<Scalar, 3>>(); }
}

TEST_CASE_TEMPLATE("the bits are those of the portable kernel, rounded once or twice as the target does", Scalar, float,
                   double) {
  if (!has_vector_unit<Scalar>) return;
  using Net = Mlp<Scalar, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>;
  std::mt19937_64 engine(12);
  Net net;
  for (Scalar& v : net.parameters) v = static_cast<Scalar>(uniform(engine, -0.4, 0.4));
  constexpr int samples = 77;
  const auto x = random_values<Scalar>(static_cast<std::size_t>(Net::inputs) * samples, engine);
  std::vector<Scalar> y(static_cast<std::size_t>(Net::outputs) * samples);
  BatchedNetwork<Net>::forward(net.parameters.data(), x.data(), y.data(), samples);
  CHECK(y == one_by_one(net, x, samples));
}

TEST_CASE("NaN in one sample stays in that sample, and reaches its outputs") {
  using Net = Mlp<float, InputSize<16>, Hidden<2, 25>, OutputSize<4>, Relu>;
  std::mt19937_64 engine(13);
  Net net;
  for (float& v : net.parameters) v = static_cast<float>(uniform(engine, -0.4, 0.4));
  constexpr std::size_t samples = 70, broken = 69;
  auto x = random_values<float>(16 * samples, engine);
  x[5 * samples + broken] = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> y(4 * samples);
  BatchedNetwork<Net>::forward(net.parameters.data(), x.data(), y.data(), static_cast<int>(samples));
  for (std::size_t i = 0; i < y.size(); ++i) CHECK(std::isnan(y[i]) == (i % samples == broken));
}

namespace {

/// x / |x|, which has no value at 0; counts how often it was asked for that.
int asked_at_zero = 0;
template <class ScalarType, int Size>
struct DirectionLayer {
  using Scalar = ScalarType;
  static constexpr int inputs = Size, outputs = Size, parameter_count = 0;
  static void forward(const Scalar*, const Scalar* x, Scalar* y) noexcept {
    Scalar square(0);
    for (int i = 0; i < Size; ++i) square += x[i] * x[i];
    if (!(square > Scalar(0))) ++asked_at_zero;
    for (int i = 0; i < Size; ++i) y[i] = x[i] / std::sqrt(square);
  }
};
struct Direction {
  template <class Scalar, int In>
  using Bind = DirectionLayer<Scalar, In>;
};

}  // namespace

TEST_CASE_TEMPLATE("a layer of a user's own meets no input that nobody gave: padding repeats a sample", Scalar, float,
                   double) {
  using Net = Network<Scalar, InputSize<6>, Direction, Dense<5>, Relu, Dense<3>>;
  check_all_sizes<Net, NativePack<Scalar>>();
  CHECK(asked_at_zero == 0);
}
