// SPDX-License-Identifier: MIT
#include "pinnquad/nn/packed_network.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "pinnquad/core/random.hpp"
#include "pinnquad/nn/gelu.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "support/own_layers.hpp"
#include "support/plain_network.hpp"
#include "support/random_network.hpp"
#include "support/tolerances.hpp"

using namespace pinnquad;
using pinnquad::test::fill_uniform;
using pinnquad::test::random_parameters;
using pinnquad::test::rounding;

namespace {

template <class NetworkType, class Pack>
void agrees_with_plain_loops(const plain::Network& reference) {
  using Scalar = typename NetworkType::Scalar;
  std::mt19937_64 engine(31);
  for (int round = 0; round < 10; ++round) {
    const auto drawn = random_parameters<Scalar>(reference.sizes, engine);
    typename NetworkType::Parameters parameters{};
    REQUIRE(drawn.size() == parameters.size());
    for (std::size_t i = 0; i < drawn.size(); ++i) parameters[i] = drawn[i];
    const PackedNetwork<NetworkType, Pack> packed(parameters);
    std::array<Scalar, NetworkType::inputs> x{};
    fill_uniform(x, engine);
    std::array<Scalar, NetworkType::outputs + 1> y{};
    y.back() = Scalar(42);
    packed.forward(x.data(), y.data());
    CHECK(y.back() == Scalar(42));  // writes its outputs and nothing behind them
    const auto expected = plain::forward(reference, parameters, {x.begin(), x.end()}).outputs;
    double difference = 0.0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      difference = std::max(difference, std::fabs(static_cast<double>(y[i]) - expected[i]));
    }
    CHECK(difference <= rounding<Scalar>(40.0 * NetworkType::layer_count));  // sums of at most 40 terms of order 1
  }
}

template <class Pack>
void agrees_for_many_networks() {
  using Scalar = typename Pack::Scalar;
  using plain::Activation;
  agrees_with_plain_loops<Network<Scalar, InputSize<6>, Dense<3>, Tanh, Dense<18>, Tanh, Dense<3>>, Pack>(
      {{6, 3, 18, 3}, Activation::tanh});
  agrees_with_plain_loops<Network<Scalar, InputSize<5>, Dense<9>, Relu, Dense<4>, Relu, Dense<1>>, Pack>(
      {{5, 9, 4, 1}, Activation::relu});
  agrees_with_plain_loops<Network<Scalar, InputSize<3>, Dense<2>>, Pack>({{3, 2}, Activation::none});
}

/// Where there are vector instructions: unrolled over plain loops, this size takes minutes to compile.
template <class Pack>
void agrees_for_large_networks() {
  if constexpr (pinnquad::has_vector_unit<typename Pack::Scalar>) {
    using Scalar = typename Pack::Scalar;
    agrees_with_plain_loops<Mlp<Scalar, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>, Pack>(
        {{16, 25, 25, 25, 25, 25, 25, 25, 25, 25, 25, 4}, plain::Activation::relu});
    agrees_with_plain_loops<Network<Scalar, InputSize<33>, Dense<7>, Tanh, Dense<40>, Tanh, Dense<3>>, Pack>(
        {{33, 7, 40, 3}, plain::Activation::tanh});
    agrees_with_plain_loops<Network<Scalar, InputSize<4>, Dense<80>, Relu, Dense<2>>, Pack>(
        {{4, 80, 2}, plain::Activation::relu});
  }
}

template <class Net, class Pack, class Parameters>
std::array<typename Net::Scalar, Net::outputs> packed_outputs(const Parameters& parameters,
                                                              const std::array<typename Net::Scalar, Net::inputs>& x) {
  std::array<typename Net::Scalar, Net::outputs> y{};
  PackedNetwork<Net, Pack>(parameters).forward(x.data(), y.data());
  return y;
}

}  // namespace

TEST_CASE("a packed network agrees with plain loops in double") {
  SUBCASE("native, float") { agrees_for_many_networks<NativePack<float>>(); }
  SUBCASE("native, double") { agrees_for_many_networks<NativePack<double>>(); }
  SUBCASE("native, large, float") { agrees_for_large_networks<NativePack<float>>(); }
  SUBCASE("native, large, double") { agrees_for_large_networks<NativePack<double>>(); }
  SUBCASE("generic, float") { agrees_for_many_networks<GenericPack<float, 4>>(); }
}

TEST_CASE_TEMPLATE("layers of any order and kind: without pack form, with parameters, activation first and last", Pack,
                   NativePack<float>, NativePack<double>) {
  using Scalar = typename Pack::Scalar;
  using pinnquad::test::ChannelScale;
  using pinnquad::test::LeakyRelu;
  using Net = Network<Scalar, InputSize<3>, Tanh, ChannelScale, Dense<5>, LeakyRelu, Dense<2>, ChannelScale, Relu,
                      Dense<4>, Tanh, Tanh, Dense<3>, LeakyRelu>;
  std::mt19937_64 engine(32);
  for (int round = 0; round < 10; ++round) {
    Net network;
    fill_uniform(network.parameters, engine);
    std::array<Scalar, 3> x{};
    fill_uniform(x, engine);
    std::array<Scalar, 3> y{};
    network.forward(x.data(), y.data());
    // some fifty operations on values of order 1 to 3
    CHECK(pinnquad::test::distance(packed_outputs<Net, Pack>(network.parameters, x), y) <= rounding<Scalar>(200));
  }
}

TEST_CASE_TEMPLATE("NaN goes through, from any input and any weight", Pack, NativePack<float>, NativePack<double>) {
  using Scalar = typename Pack::Scalar;
  using Net = Network<Scalar, InputSize<6>, Dense<5>, Relu, Dense<3>, Relu, Dense<2>>;
  const Scalar nan = std::numeric_limits<Scalar>::quiet_NaN();
  std::mt19937_64 engine(33);
  Net network;
  std::array<Scalar, 6> x{};
  for (auto& p : network.parameters) p = static_cast<Scalar>(pinnquad::uniform(engine, 0.1, 1.0));
  fill_uniform(x, engine);
  const auto all_nan = [](const auto& y) {
    for (const Scalar v : y) {
      if (v == v) return false;
    }
    return true;
  };
  std::array<Scalar, 2> y{};
  for (Scalar& entry : x) {
    const Scalar kept = entry;
    entry = nan;
    network.forward(x.data(), y.data());
    CHECK(all_nan(y));
    CHECK(all_nan(packed_outputs<Net, Pack>(network.parameters, x)));
    entry = kept;
  }
  for (std::size_t i = 0; i < network.parameters.size() - 8; i += 7) {  // the last layer's reach one output each
    const Scalar kept = network.parameters[i];
    network.parameters[i] = nan;
    network.forward(x.data(), y.data());
    CHECK(all_nan(y));
    CHECK(all_nan(packed_outputs<Net, Pack>(network.parameters, x)));
    network.parameters[i] = kept;
  }
}

TEST_CASE("packing happens at compile time for parameters that are known then") {
  using Net = Network<float, InputSize<2>, Dense<1>>;
  static constexpr Net::Parameters parameters = {2.0F, 3.0F, 0.5F};
  static constexpr PackedNetwork<Net> packed{parameters};
  const float x[2] = {1.0F, 10.0F};
  float y = 0.0F;
  packed.forward(x, &y);
  CHECK(y == 32.5F);
}

namespace {
using Large = Network<float, InputSize<256>, Dense<256>>;
/// Weight (row, column) = row - column, bias = 1: small integers, so that any order of a sum is exact.
constexpr Large::Parameters large_parameters() {
  Large::Parameters parameters{};
  for (std::size_t row = 0; row < 256; ++row) {
    for (std::size_t column = 0; column < 256; ++column) {
      parameters[row * 256 + column] = static_cast<float>(row) - static_cast<float>(column);
    }
    parameters[256 * 256 + row] = 1.0F;
  }
  return parameters;
}
}  // namespace

TEST_CASE("a layer of 256 x 256 is packed at compile time, within the compilers' default limits") {
  static constexpr Large::Parameters parameters = large_parameters();
  static constexpr PackedNetwork<Large> packed{parameters};
  std::array<float, 256> x{}, y{};
  x[3] = 2.0F;
  x[255] = -1.0F;
  packed.forward(x.data(), y.data());
  for (std::size_t row = 0; row < 256; ++row) {
    const float value = static_cast<float>(row);
    CHECK(y[row] == 2.0F * (value - 3.0F) - (value - 255.0F) + 1.0F);
  }
}

TEST_CASE("inputs need not be aligned") {
  using Net = Network<float, InputSize<16>, Dense<9>, Relu, Dense<4>>;
  std::mt19937_64 engine(34);
  Net network;
  fill_uniform(network.parameters, engine);
  const PackedNetwork<Net> packed(network.parameters);
  alignas(64) std::array<float, 17> x{};
  alignas(64) std::array<float, 5> y{}, moved{};
  fill_uniform(x, engine);
  packed.forward(x.data() + 1, y.data());
  std::array<float, 16> aligned{};
  for (std::size_t i = 0; i < 16; ++i) aligned[i] = x[i + 1];
  packed.forward(aligned.data(), moved.data() + 1);
  for (std::size_t i = 0; i < 4; ++i) CHECK(y[i] == moved[i + 1]);
}

namespace {

/// Each layer's outputs by the layer itself, one behind the other.
template <class Net, int Index = 0>
void by_layers(const typename Net::Scalar* parameters, const typename Net::Scalar* x, typename Net::Scalar* outputs) {
  if constexpr (Index < Net::layer_count) {
    using Layer = typename Net::template Layer<Index>;
    Layer::forward(parameters + Net::Sizes::offset(Index), x, outputs);
    by_layers<Net, Index + 1>(parameters, outputs, outputs + Layer::outputs);
  }
}

/// `kept`: one letter per layer, k for outputs that are left behind, - for those that are not.
template <class Net, class Pack>
void keeps(const std::string& kept) {
  using Scalar = typename Net::Scalar;
  constexpr auto all = static_cast<std::size_t>(Net::Sizes::outputs_before(Net::layer_count));
  REQUIRE(kept.size() == Net::layer_count);
  std::mt19937_64 engine(35);
  Net network;
  fill_uniform(network.parameters, engine, 0.6);
  std::array<Scalar, Net::inputs> x{};
  fill_uniform(x, engine);
  std::array<Scalar, all> expected{};
  by_layers<Net>(network.parameters.data(), x.data(), expected.data());

  constexpr Scalar canary(-77);
  std::array<Scalar, all + 1> left{};
  left.fill(canary);
  std::array<Scalar, Net::outputs + 1> y{};
  y.fill(canary);
  PackedNetwork<Net, Pack>(network.parameters).forward_keeping(x.data(), y.data(), left.data());
  CHECK(left.back() == canary);
  CHECK(y.back() == canary);
  // of a layer's largest value: sums of some forty products, after layers that passed their own rounding on
  const double tolerance = rounding<Scalar>(9);
  const auto largest = [&](std::size_t first, std::size_t end) {
    double result = 0;
    for (; first < end; ++first) result = std::fmax(result, std::fabs(static_cast<double>(expected[first])));
    return result;
  };
  std::size_t at = 0;
  for (std::size_t layer = 0; layer < kept.size(); ++layer) {
    CAPTURE(layer);
    const double scale = largest(at, at + static_cast<std::size_t>(Net::Sizes::outputs[layer]));
    for (int i = 0; i < Net::Sizes::outputs[layer]; ++i, ++at) {
      if (kept[layer] == 'k') {
        CHECK(std::fabs(static_cast<double>(left[at] - expected[at])) / scale <= tolerance);
      } else {
        CHECK(left[at] == canary);
      }
    }
  }
  const double scale = largest(all - Net::outputs, all);
  for (std::size_t i = 0; i < Net::outputs; ++i) {
    CHECK(std::fabs(static_cast<double>(y[i] - expected[all - Net::outputs + i])) / scale <= tolerance);
  }
}

}  // namespace

TEST_CASE("forward_keeping leaves each layer's outputs where they are asked for, from registers and from memory") {
  using pinnquad::DenseWithoutBias;
  using pinnquad::Gelu;
  using pinnquad::test::ChannelScale;
  using pinnquad::test::LeakyRelu;
  using pinnquad::test::Square;
  const auto check = [](auto pack, auto width) {
    using Pack = decltype(pack);
    using Scalar = typename Pack::Scalar;
    using Wide = Dense<decltype(width)::value>;
    // equal layers are a loop; a slope asked with the output leaves the sums out, one asked with the input does not
    keeps<Network<Scalar, InputSize<5>, Wide, Relu, Wide, Relu, Wide, Relu, Dense<3>>, Pack>("-k-k-kk");
    keeps<Network<Scalar, InputSize<5>, Wide, Square, Wide, Square, Dense<3>, Relu>, Pack>("kkkk-k");
    keeps<Network<Scalar, InputSize<5>, Tanh, Wide, Gelu, DenseWithoutBias<7>, Relu, ChannelScale, LeakyRelu>, Pack>(
        "kkkkkkk");
    keeps<Network<Scalar, InputSize<5>, Wide, LeakyRelu, Dense<9>, ChannelScale>, Pack>("kkkk");
  };
  SUBCASE("float, as wide as registers take") { check(NativePack<float>{}, pinnquad::Index<6>{}); }
  SUBCASE("float, in memory") { check(NativePack<float>{}, pinnquad::Index<41>{}); }
  SUBCASE("double, as wide as registers take") { check(NativePack<double>{}, pinnquad::Index<6>{}); }
  SUBCASE("double, in memory") { check(NativePack<double>{}, pinnquad::Index<41>{}); }
}
