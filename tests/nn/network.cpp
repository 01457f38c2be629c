// SPDX-License-Identifier: MIT
#include "pinnquad/nn/network.hpp"
#include "pinnquad/nn/elu.hpp"
#include "pinnquad/nn/leaky_relu.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

#include "pinnquad/nn/gelu.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/silu.hpp"
#include "pinnquad/nn/sine.hpp"
#include "pinnquad/nn/softplus.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "support/plain_network.hpp"
#include "support/random_network.hpp"
#include "support/tolerances.hpp"

using namespace pinnquad;
using pinnquad::test::fill_uniform;
using pinnquad::test::random_parameters;
using pinnquad::test::rounding;

namespace {

using PaperNetwork = Mlp<float, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>;

/// Eight inputs, two hidden layers of different width.
template <class Scalar, class Activation>
using Uneven = Network<Scalar, InputSize<8>, Dense<13>, Activation, Dense<5>, Activation, Dense<3>>;

struct NotALayer {};
struct NoForward {
  template <class Scalar, int In>
  struct Bind {
    static constexpr int inputs = In, outputs = In, parameter_count = 0;
  };
};

}  // namespace

TEST_CASE("the paper's network has the paper's size") {
  CHECK(PaperNetwork::parameter_count == 6379);  // 16 x 25 + 25, nine times 25 x 25 + 25, 25 x 4 + 4
  CHECK(Mlp<float, InputSize<15>, Hidden<10, 25>, OutputSize<4>, Relu>::parameter_count ==
        6354);  // X in R^15 as printed
  CHECK(PaperNetwork::layer_count == 21);
  CHECK(PaperNetwork::inputs == 16);
  CHECK(PaperNetwork::outputs == 4);
  CHECK(PaperNetwork::widest == 25);
  CHECK(PaperNetwork::workspace_bytes == 2 * 25 * sizeof(float));
  CHECK(sizeof(PaperNetwork) == 6379 * sizeof(float));
}

TEST_CASE("Mlp is the network written out") {
  using Written = Network<float, InputSize<7>, Dense<6>, Tanh, Dense<6>, Tanh, Dense<2>>;
  CHECK((std::is_same_v<Mlp<float, InputSize<7>, Hidden<2, 6>, OutputSize<2>, Tanh>, Written>));
  CHECK((std::is_same_v<Written::Rebind<double>, Mlp<double, InputSize<7>, Hidden<2, 6>, OutputSize<2>, Tanh>>));
  CHECK((std::is_same_v<Mlp<float, InputSize<7>, Hidden<0, 6>, OutputSize<2>, Tanh>,
                        Network<float, InputSize<7>, Dense<2>>>));
}

TEST_CASE("offsets: parameters stand layer after layer, activations have none") {
  using Sizes = Uneven<float, Relu>::Sizes;
  const int expected[] = {0, 8 * 13 + 13, 8 * 13 + 13, 117 + 13 * 5 + 5, 187, 187 + 5 * 3 + 3};
  for (int layer = 0; layer <= 5; ++layer) CHECK(Sizes::offset(layer) == expected[layer]);
  CHECK(Uneven<float, Relu>::parameter_count == 205);
  CHECK(Uneven<float, Relu>::widest == 13);
  CHECK(Network<float, InputSize<40>, Dense<2>>::widest == 40);
}

TEST_CASE("what is a layer") {
  CHECK(pinnquad::is_layer<Dense<3>>);
  CHECK(pinnquad::is_layer<Relu>);
  CHECK(pinnquad::is_layer<Tanh>);
  CHECK_FALSE(pinnquad::is_layer<NotALayer>);
  CHECK_FALSE(pinnquad::is_layer<NoForward>);
  CHECK_FALSE(pinnquad::is_layer<int>);
  CHECK(pinnquad::is_network<PaperNetwork>);
  CHECK_FALSE(pinnquad::is_network<Dense<3>>);
}

TEST_CASE("weights are row-major: row = output, column = input; the bias follows") {
  Network<double, InputSize<3>, Dense<2>> network;
  network.parameters = {1, 20, 300, 4, 50, 600, 7000, 8000};
  const double x[3] = {1, 2, 3};
  double y[2] = {};
  network.forward(x, y);
  CHECK(y[0] == 7000 + 1 + 40 + 900);
  CHECK(y[1] == 8000 + 4 + 100 + 1800);
}

namespace {
/// Each layer alone, one behind the other.
template <class NetworkType, int Index = 0>
void layer_by_layer(const typename NetworkType::Scalar* parameters, const typename NetworkType::Scalar* x,
                    typename NetworkType::Scalar* y) {
  using Layer = typename NetworkType::template Layer<Index>;
  typename NetworkType::Scalar made[Layer::outputs];
  Layer::forward(parameters, x, made);
  if constexpr (Index + 1 < NetworkType::layer_count) {
    layer_by_layer<NetworkType, Index + 1>(parameters + Layer::parameter_count, made, y);
  } else {
    std::copy(made, made + Layer::outputs, y);
  }
}
/// Every second of an array.
template <class Scalar>
struct EverySecond {
  const Scalar* x;
  Scalar operator[](int i) const noexcept { return x[2 * i]; }
};
}  // namespace

TEST_CASE_TEMPLATE("a wide last hidden layer, made in parts, has the bits of each layer alone", Type,
                   Mlp<float, InputSize<16>, Hidden<2, 32>, OutputSize<4>, Relu>,
                   Mlp<float, InputSize<16>, Hidden<1, 32>, OutputSize<4>, Relu>,
                   Mlp<float, InputSize<30>, Hidden<3, 48>, OutputSize<5>, Tanh>,
                   Mlp<double, InputSize<28>, Hidden<3, 28>, OutputSize<4>, Tanh>,
                   Mlp<float, InputSize<7>, Hidden<2, 27>, OutputSize<4>, Relu>,
                   Network<float, InputSize<6>, Dense<32>, Dense<40>, Relu, Dense<3>, Tanh>,
                   Network<float, InputSize<32>, Dense<32>, Relu, Dense<32>, Relu>) {
  using Scalar = typename Type::Scalar;
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int round = 0; round < 20; ++round) {
    Type network;
    for (Scalar& parameter : network.parameters) parameter = static_cast<Scalar>(uniform(engine));
    Scalar apart[2 * Type::inputs], x[Type::inputs], y[Type::outputs], of_apart[Type::outputs], alone[Type::outputs];
    for (Scalar& value : apart) value = static_cast<Scalar>(uniform(engine));
    for (int i = 0; i < Type::inputs; ++i) x[i] = apart[2 * i];
    network.forward(x, y);
    pinnquad::detail::PortablePass<Type>::forward_of(network.parameters.data(), EverySecond<Scalar>{apart}, of_apart);
    layer_by_layer<Type>(network.parameters.data(), x, alone);
    for (int i = 0; i < Type::outputs; ++i) {
      CHECK(y[i] == alone[i]);
      CHECK(of_apart[i] == alone[i]);
    }
  }
}

TEST_CASE("workspace: the inputs have none, a last hidden layer made in parts almost none") {
  CHECK(Mlp<float, InputSize<16>, Hidden<2, 32>, OutputSize<4>, Relu>::workspace_bytes == (32 + 4) * sizeof(float));
  CHECK(Mlp<float, InputSize<16>, Hidden<3, 32>, OutputSize<4>, Relu>::workspace_bytes == 64 * sizeof(float));
  CHECK(Mlp<float, InputSize<16>, Hidden<2, 24>, OutputSize<4>, Relu>::workspace_bytes == 48 * sizeof(float));
}

TEST_CASE_TEMPLATE("forward agrees with plain loops in double", Scalar, float, double) {
  std::mt19937_64 engine(11);
  const auto compare = [&engine](auto network, const plain::Network& reference) {
    using Type = decltype(network);
    for (int round = 0; round < 20; ++round) {
      const auto parameters = random_parameters<Scalar>(reference.sizes, engine);
      REQUIRE(parameters.size() == network.parameters.size());
      for (std::size_t i = 0; i < parameters.size(); ++i) network.parameters[i] = parameters[i];
      std::array<Scalar, Type::inputs> x{};
      std::array<Scalar, Type::outputs> y{}, by_pointer{};
      fill_uniform(x, engine);
      network.forward(x.data(), y.data());
      Type::forward(parameters.data(), x.data(), by_pointer.data());
      CHECK(y == by_pointer);
      const auto expected = plain::forward(reference, parameters, {x.begin(), x.end()}).outputs;
      // each layer's sums have at most 40 terms of order 1
      CHECK(pinnquad::test::distance(y, expected) <= rounding<Scalar>(40.0 * Type::layer_count));
    }
  };
  compare(Uneven<Scalar, Relu>{}, {{8, 13, 5, 3}, plain::Activation::relu});
  compare(Uneven<Scalar, Tanh>{}, {{8, 13, 5, 3}, plain::Activation::tanh});
  compare(Mlp<Scalar, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>{},
          {{16, 25, 25, 25, 25, 25, 25, 25, 25, 25, 25, 4}, plain::Activation::relu});
  compare(Network<Scalar, InputSize<1>, Dense<1>>{}, {{1, 1}, plain::Activation::none});
}

namespace {
/// Layer by layer through Layer::forward, nothing fused or repeated.
template <class Type, int Index = 0>
std::vector<typename Type::Scalar> layer_by_layer(const Type& network, const std::vector<typename Type::Scalar>& x) {
  if constexpr (Index == Type::layer_count) {
    return x;
  } else {
    using Layer = typename Type::template Layer<Index>;
    std::vector<typename Type::Scalar> y(Layer::outputs);
    Layer::forward(network.parameters.data() + Type::Sizes::offset(Index), x.data(), y.data());
    return layer_by_layer<Type, Index + 1>(network, y);
  }
}

/// y_i = p_i x_i: a layer with parameters that nothing is fused with.
template <class ScalarType, int Size>
struct ScaleLayer {
  using Scalar = ScalarType;
  static constexpr int inputs = Size, outputs = Size, parameter_count = Size;
  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    for (int i = 0; i < Size; ++i) y[i] = parameters[i] * x[i];
  }
};
struct Scale {
  template <class Scalar, int In>
  using Bind = ScaleLayer<Scalar, In>;
};
}  // namespace

TEST_CASE_TEMPLATE("fused activations and loops over equal layers keep the bits of a pass layer by layer", Scalar,
                   float, double) {
  std::mt19937_64 engine(12);
  const auto compare = [&engine](auto network) {
    using Type = decltype(network);
    CAPTURE(Type::layer_count);
    fill_uniform(network.parameters, engine);
    std::vector<Scalar> x(Type::inputs), y(Type::outputs);
    fill_uniform(x, engine);
    network.forward(x.data(), y.data());
    CHECK(y == layer_by_layer(network, x));
  };
  using D6 = Dense<6>;
  compare(Mlp<Scalar, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>{});  // first differs, nine equal, last
  compare(Mlp<Scalar, InputSize<6>, Hidden<3, 6>, OutputSize<6>, Tanh>{});     // all equal but for the last activation
  compare(Network<Scalar, InputSize<6>, D6, D6, D6, D6>{});                    // equal, nothing to fuse, last writes y
  compare(Network<Scalar, InputSize<6>, D6, Relu, D6, Tanh, D6, Tanh, D6, Relu>{});  // equal layers, other activations
  compare(Network<Scalar, InputSize<6>, Relu, D6, Relu, Relu, D6, D6, Relu>{});      // activation first, twice, last
  compare(Network<Scalar, InputSize<6>, Scale, Relu, Scale, Relu, Dense<3>>{});  // repeats in twos: no step of its own
  compare(
      Network<Scalar, InputSize<6>, pinnquad::DenseWithoutBias<6>, Relu, pinnquad::DenseWithoutBias<6>, Relu, D6>{});
  using pinnquad::Gelu;
  compare(
      Network<Scalar, InputSize<6>, D6, Gelu, D6, Gelu, D6, pinnquad::Silu, D6, pinnquad::Softplus, pinnquad::Sine>{});
  compare(Network<Scalar, InputSize<6>, D6, pinnquad::Elu, D6, pinnquad::Elu, D6, pinnquad::LeakyRelu, D6,
                  pinnquad::LeakyRelu, Dense<3>>{});
  compare(Network<Scalar, InputSize<70>, Dense<60>, Relu, Dense<60>, Relu, Dense<60>, Relu, Dense<2>>{});
}
