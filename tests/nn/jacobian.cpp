// SPDX-License-Identifier: MIT
#include "pinnquad/nn/jacobian.hpp"
#include "pinnquad/nn/elu.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cfenv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "pinnquad/core/random.hpp"
#include "pinnquad/nn/gelu.hpp"
#include "pinnquad/nn/glu.hpp"
#include "pinnquad/nn/layer_norm.hpp"
#include "pinnquad/nn/leaky_relu.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/silu.hpp"
#include "pinnquad/nn/sine.hpp"
#include "pinnquad/nn/softplus.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "support/end_of_page.hpp"
#include "support/own_layers.hpp"
#include "support/packs.hpp"

using namespace pinnquad;

namespace {

template <class Net>
Net random_network(std::mt19937_64& engine) {
  using Scalar = typename Net::Scalar;
  Net net;
  for (auto& v : net.parameters) v = static_cast<Scalar>(uniform(engine, -0.6, 0.6));
  return net;
}

template <class Scalar, class... Specs>
using From16 = Network<Scalar, InputSize<16>, Specs...>;

/// A network whose batch norms have variances above zero.
template <class Net>
void spread_statistics(Net& net) {
  for (auto& v : net.parameters) v = std::abs(v) + typename Net::Scalar(0.1);
}

/// Central differences in double: error of the order of the step squared, rounding of epsilon / step.
template <class Net>
void check_against_differences(const Net& net, const std::vector<double>& x) {
  constexpr double step = 1e-6, tolerance = 1e-7;
  constexpr auto in = static_cast<std::size_t>(Net::inputs), out = static_cast<std::size_t>(Net::outputs);
  std::vector<double> y(out), jacobian(in * out), plain(out), above(out), below(out);
  JacobianPass<Net>::run(net.parameters.data(), x.data(), y.data(), jacobian.data());
  net.forward(x.data(), plain.data());
  for (std::size_t i = 0; i < out; ++i) CHECK(y[i] == doctest::Approx(plain[i]).epsilon(1e-13));
  for (std::size_t k = 0; k < in; ++k) {
    std::vector<double> moved = x;
    moved[k] = x[k] + step;
    net.forward(moved.data(), above.data());
    moved[k] = x[k] - step;
    net.forward(moved.data(), below.data());
    for (std::size_t i = 0; i < out; ++i) {
      const double expected = (above[i] - below[i]) / (2 * step);
      CHECK(std::abs(jacobian[i * in + k] - expected) <= tolerance * (1 + std::abs(expected)));
    }
  }
}

template <class Net>
std::vector<double> some_input(std::mt19937_64& engine) {
  std::vector<double> x(static_cast<std::size_t>(Net::inputs));
  for (double& v : x) v = uniform(engine, -1.0, 1.0);
  return x;
}

}  // namespace

TEST_CASE_TEMPLATE(
    "Jacobian against central differences", Net, Mlp<double, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>,
    Mlp<double, InputSize<17>, Hidden<3, 32>, OutputSize<4>, Tanh>, From16<double, Dense<1>>,
    From16<double, Dense<7>, Tanh, Dense<9>>, From16<double, DenseWithoutBias<5>, Relu, Dense<13>, Tanh>,
    From16<double, Dense<6>, test::LeakyRelu, Dense<3>>,
    From16<double, Dense<7>, Gelu, Dense<9>, Silu, Dense<5>, Softplus, Dense<4>, Sine, Dense<3>>,
    From16<double, Gelu, DenseWithoutBias<5>, Sine, Silu, Dense<3>, Gelu>,
    From16<double, test::ScalarSquare, Dense<5>, test::Square, test::ScalarSquare, Dense<3>>,
    From16<double, Elu, Dense<7>, Elu, Dense<9>, pinnquad::LeakyRelu, Dense<5>, Elu>,
    From16<double, LayerNorm<16>, Dense<7>, RmsNorm<7>, Tanh, Dense<9>, LayerNorm<5>, Glu<3>, Gelu, Dense<3>>,
    From16<double, Dense<7>, Tanh, RmsNorm<5>, LayerNorm<7>>, Network<double, InputSize<3>, Sine, Dense<1>>,
    Network<double, InputSize<1>, Dense<3>, Tanh, Dense<2>>,
    Network<double, InputSize<3>, Tanh, Dense<40>, Relu, Relu, Dense<4>>) {
  std::mt19937_64 engine(7);
  for (int round = 0; round < 5; ++round) {
    const auto net = random_network<Net>(engine);
    check_against_differences(net, some_input<Net>(engine));
  }
}

TEST_CASE("Jacobian through batch norm uses the running statistics") {
  using Net = From16<double, DenseWithoutBias<6>, BatchNorm, Tanh, Dense<4>>;
  std::mt19937_64 engine(8);
  auto net = random_network<Net>(engine);
  spread_statistics(net);
  check_against_differences(net, some_input<Net>(engine));
}

TEST_CASE_TEMPLATE("float agrees with double, with every pack", Pack, NativePack<float>, GenericPack<float, 4>,
                   GenericPack<float, 1>) {
  using Net = Mlp<float, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>;
  std::mt19937_64 engine(9);
  const auto net = random_network<Net>(engine);
  Net::Rebind<double> wide;
  for (std::size_t i = 0; i < net.parameters.size(); ++i) wide.parameters[i] = static_cast<double>(net.parameters[i]);
  std::array<float, 16> x{};
  std::array<double, 16> x_wide{};
  for (std::size_t i = 0; i < x.size(); ++i)
    x_wide[i] = static_cast<double>(x[i] = static_cast<float>(uniform(engine, -1.0, 1.0)));
  float y[4], jacobian[64];
  double y_wide[4], jacobian_wide[64];
  JacobianPass<Net, Pack>::run(net.parameters.data(), x.data(), y, jacobian);
  JacobianPass<Net::Rebind<double>>::run(wide.parameters.data(), x_wide.data(), y_wide, jacobian_wide);
  double largest = 0;
  for (const double j : jacobian_wide) largest = std::max(largest, std::abs(j));
  REQUIRE(largest > 0.01);
  constexpr double rounding = 2e-6;  // of 250 products in a chain of eleven layers
  for (int i = 0; i < 64; ++i)
    CHECK(std::abs(static_cast<double>(jacobian[i]) - jacobian_wide[i]) <= rounding * largest);
}

TEST_CASE_TEMPLATE("the vector unit's way forward keeps what slopes are asked with", Net,
                   From16<float, Dense<25>, test::Square, Dense<25>, test::Square, Dense<25>, test::Square, Dense<4>>,
                   From16<float, Dense<7>, Gelu, Dense<7>, Gelu, Dense<7>, Sine, Relu, Silu, Dense<4>>,
                   From16<float, Gelu, Dense<50>, test::Square, Dense<4>, Softplus>,
                   From16<float, Dense<25>, Elu, Dense<25>, pinnquad::LeakyRelu, Gelu, Dense<4>>,
                   From16<float, Dense<5>, test::ScalarSquare, DenseWithoutBias<5>, Sine, Dense<4>>) {
  std::mt19937_64 engine(11);
  auto net = random_network<Net>(engine);
  for (float& v : net.parameters) v *= 0.5f;
  typename Net::template Rebind<double> wide;
  for (std::size_t i = 0; i < net.parameters.size(); ++i) wide.parameters[i] = static_cast<double>(net.parameters[i]);
  std::array<float, 16> x{};
  std::array<double, 16> x_wide{};
  for (std::size_t i = 0; i < x.size(); ++i)
    x_wide[i] = static_cast<double>(x[i] = static_cast<float>(uniform(engine, -1.0, 1.0)));
  float y[4], jacobian[64];
  double y_wide[4], jacobian_wide[64];
  const auto packed = std::make_unique<PackedNetwork<Net>>(net.parameters);
  JacobianPass<Net>::run(*packed, net.parameters.data(), x.data(), y, jacobian);
  JacobianPass<typename Net::template Rebind<double>>::run(wide.parameters.data(), x_wide.data(), y_wide,
                                                           jacobian_wide);
  double largest = 0, value = 0;
  for (const double j : jacobian_wide) largest = std::max(largest, std::abs(j));
  for (const double v : y_wide) value = std::max(value, std::abs(v));
  REQUIRE(largest > 1e-6);
  constexpr double rounding = 5e-6;  // of 50 products, three layers deep, squared
  for (int i = 0; i < 64; ++i)
    CHECK(std::abs(static_cast<double>(jacobian[i]) - jacobian_wide[i]) <= rounding * largest);
  for (int i = 0; i < 4; ++i) CHECK(std::abs(static_cast<double>(y[i]) - y_wide[i]) <= rounding * value);
}

TEST_CASE("NaN in an input reaches the value") {
  using Net = Mlp<float, InputSize<16>, Hidden<2, 25>, OutputSize<4>, Relu>;
  std::mt19937_64 engine(10);
  const auto net = random_network<Net>(engine);
  std::array<float, 16> x{};
  x[3] = std::numeric_limits<float>::quiet_NaN();
  float y[4] = {}, jacobian[64];
  JacobianPass<Net>::run(net.parameters.data(), x.data(), y, jacobian);
  for (const float v : y) CHECK(std::isnan(v));
}

namespace {

/// The same from memory that ends with its page as from memory with NaN behind it.
template <class Net, class Pack>
void check_within_memory() {
  using Scalar = typename Net::Scalar;
  constexpr auto in = static_cast<std::size_t>(Net::inputs), out = static_cast<std::size_t>(Net::outputs);
  constexpr int behind = 64;
  CAPTURE(in);
  CAPTURE(out);
  std::mt19937_64 engine(12);
  const auto net = random_network<Net>(engine);
  test::EndOfPage<Scalar> parameters(net.parameters.size()), x(in), y(out), jacobian(in * out);
  std::copy(net.parameters.begin(), net.parameters.end(), parameters.begin());
  for (Scalar& v : x) v = static_cast<Scalar>(uniform(engine, -1.0, 1.0));
  const auto followed_by_nan = [](const auto& values) {
    std::vector<Scalar> result(values.begin(), values.end());
    result.resize(result.size() + behind, std::numeric_limits<Scalar>::quiet_NaN());
    return result;
  };
  const auto roomy_parameters = followed_by_nan(net.parameters), roomy_x = followed_by_nan(x);
  constexpr Scalar canary(-77);
  std::vector<Scalar> roomy_y(out + behind, canary), roomy_jacobian(in * out + behind, canary);
  const auto check = [&] {
    CHECK(std::equal(y.begin(), y.end(), roomy_y.begin()));
    CHECK(std::equal(jacobian.begin(), jacobian.end(), roomy_jacobian.begin()));
    CHECK(std::count(roomy_y.begin(), roomy_y.end(), canary) == behind);
    CHECK(std::count(roomy_jacobian.begin(), roomy_jacobian.end(), canary) == behind);
  };
  using Jacobian = JacobianPass<Net, Pack>;
  Jacobian::run(parameters.data(), x.data(), y.data(), jacobian.data());
  Jacobian::run(roomy_parameters.data(), roomy_x.data(), roomy_y.data(), roomy_jacobian.data());
  check();
  test::EndOfPage<PackedNetwork<Net, Pack>> packed(1);
  packed.data()->assign(parameters.data());
  Jacobian::run(*packed.data(), parameters.data(), x.data(), y.data(), jacobian.data());
  Jacobian::run(*packed.data(), roomy_parameters.data(), roomy_x.data(), roomy_y.data(), roomy_jacobian.data());
  check();
}

}  // namespace

// Rows of weights that end before, with and after a pack; a bias behind the last of them that is long enough to be
// read, that is not, and none.
TEST_CASE_TEMPLATE("nothing is read behind parameters and inputs, nothing written behind outputs and Jacobian", Pack,
                   PINNQUAD_TEST_REGISTER_PACKS, PINNQUAD_TEST_DOUBLE_PACKS, GenericPack<float, 4>) {
  using Scalar = typename Pack::Scalar;
  check_within_memory<Network<Scalar, InputSize<5>, Dense<2>>, Pack>();
  check_within_memory<Network<Scalar, InputSize<7>, Dense<1>, Gelu>, Pack>();
  check_within_memory<Network<Scalar, InputSize<17>, Dense<3>>, Pack>();
  check_within_memory<Network<Scalar, InputSize<16>, Dense<9>, Relu, Dense<4>>, Pack>();
  check_within_memory<Network<Scalar, InputSize<3>, Sine, Dense<5>, Relu, DenseWithoutBias<2>>, Pack>();
  check_within_memory<Network<Scalar, InputSize<1>, Relu, DenseWithoutBias<9>>, Pack>();
}

namespace {

/// Leaves signalling NaNs where the next call has its stack: arithmetic with one raises FE_INVALID.
PINNQUAD_NOINLINE void poison_stack() {
  volatile std::uint32_t stack[16384];
  for (volatile std::uint32_t& word : stack) word = 0x7fa00000u;
}

template <class Net, class Pack>
PINNQUAD_NOINLINE bool reads_what_none_wrote(const PackedNetwork<Net, Pack>& packed, const Net& net) {
  constexpr auto inputs = static_cast<std::size_t>(Net::inputs), outputs = static_cast<std::size_t>(Net::outputs);
  std::vector<float> x(inputs, 0.1f), y(outputs), jacobian(inputs * outputs);
  poison_stack();
  std::feclearexcept(FE_ALL_EXCEPT);
  JacobianPass<Net, Pack>::run(packed, net.parameters.data(), x.data(), y.data(), jacobian.data());
  return std::fetestexcept(FE_INVALID) != 0;
}

template <class Net, class Pack>
void check_all_written() {
  std::mt19937_64 engine(8);
  const auto net = std::make_unique<Net>(random_network<Net>(engine));
  const auto packed = std::make_unique<PackedNetwork<Net, Pack>>();
  packed->assign(net->parameters.data());
  CHECK(!reads_what_none_wrote<Net, Pack>(*packed, *net));
}

}  // namespace

TEST_CASE_TEMPLATE("nothing is computed with what was not written", Pack, PINNQUAD_TEST_REGISTER_PACKS,
                   GenericPack<float, 4>) {
  check_all_written<Network<float, InputSize<3>, Tanh, Dense<9>, Tanh, Dense<7>, Tanh>, Pack>();
  check_all_written<Network<float, InputSize<2>, Dense<9>, Tanh, Dense<20>, Tanh, Dense<4>>, Pack>();
}
