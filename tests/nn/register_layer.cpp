// SPDX-License-Identifier: MIT
// Layers in registers against plain loops in double: every size, as rows and as columns, until they repeat; every pack
// of floats and of doubles.
#include "pinnquad/nn/kernel/register_layer.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "pinnquad/nn/packed_network.hpp"
#include "pinnquad/nn/relu.hpp"
#include "support/packs.hpp"
#include "support/random_network.hpp"

using namespace pinnquad;
using pinnquad::test::fill_uniform;

namespace {

/// A value in double, and how far a computation in the packs' scalar and any order of its sums may be from it.
struct Bounded {
  double value = 0.0;
  double bound = 0.0;
};

/// y = W x + b in double. A sum of n products, in any order and with one or two roundings each, is off by at most
/// (n + 2) eps times the sum of the magnitudes (Higham 2002, section 3.1); errors of the inputs pass through |W|. These
/// loops are off as far themselves where the scalar is double.
template <class Scalar>
std::vector<Bounded> plain_layer(const Scalar* weight, const std::vector<Bounded>& x, std::size_t rows) {
  const double eps = static_cast<double>(std::numeric_limits<Scalar>::epsilon()) * (sizeof(Scalar) == 8 ? 2.0 : 1.0);
  const Scalar* bias = weight + rows * x.size();
  std::vector<Bounded> y(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    double sum = static_cast<double>(bias[row]), magnitude = std::fabs(sum), passed = 0.0;
    for (std::size_t column = 0; column < x.size(); ++column) {
      const double w = static_cast<double>(weight[row * x.size() + column]);
      sum += w * x[column].value;
      magnitude += std::fabs(w) * (std::fabs(x[column].value) + x[column].bound);
      passed += std::fabs(w) * x[column].bound;
    }
    y[row] = {sum, passed + (static_cast<double>(x.size()) + 2.0) * eps * magnitude};
  }
  return y;
}

template <class Scalar>
bool agrees(Scalar actual, const Bounded& expected) {
  if (std::isnan(expected.value)) return std::isnan(actual);
  if (std::isinf(expected.value)) return static_cast<double>(actual) == expected.value;
  return std::fabs(static_cast<double>(actual) - expected.value) <= expected.bound;
}

/// A network of dense layers with ReLU between them: what is under test and what it should be.
template <class Scalar>
struct Case {
  std::vector<std::size_t> sizes;
  const Scalar* parameters;
  std::function<void(const Scalar*, Scalar*)> forward;

  bool agrees_at(const std::vector<Scalar>& inputs) const {
    std::vector<Bounded> values;
    for (const Scalar v : inputs) values.push_back({static_cast<double>(v), 0.0});
    const Scalar* weight = parameters;
    for (std::size_t layer = 1; layer < sizes.size(); ++layer) {
      if (layer > 1) {
        for (Bounded& v : values) v.value = v.value < 0.0 ? 0.0 : v.value;
      }
      values = plain_layer(weight, values, sizes[layer]);
      weight += sizes[layer] * (sizes[layer - 1] + 1);
    }
    // what stands behind the inputs must not be read, or must not matter; nothing is written behind the outputs
    std::vector<Scalar> x = inputs;
    x.resize(inputs.size() + 16, std::numeric_limits<Scalar>::quiet_NaN());
    std::vector<Scalar> y(values.size() + 1, Scalar(42));
    forward(x.data(), y.data());
    bool all = y.back() == Scalar(42);
    for (std::size_t i = 0; i < values.size(); ++i) all = all && agrees(y[i], values[i]);
    return all;
  }
};

template <class Scalar>
void check_case(const Case<Scalar>& network, std::mt19937_64& engine) {
  CAPTURE(network.sizes[0]);
  CAPTURE(network.sizes[1]);
  std::vector<Scalar> inputs(network.sizes[0]);
  fill_uniform(inputs, engine);
  CHECK(network.agrees_at(inputs));
  using Limits = std::numeric_limits<Scalar>;
  for (const Scalar special : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
    for (Scalar& input : inputs) {
      CAPTURE(special);
      const Scalar kept = input;
      input = special;
      CHECK(network.agrees_at(inputs));
      input = kept;
    }
  }
}

/// From memory, A values; in registers, B and C of them.
template <class Pack, int A, int B, int C>
void check_sizes(std::mt19937_64& engine) {
  using Scalar = typename Pack::Scalar;
  using Net = Network<Scalar, InputSize<A>, Dense<B>, Relu, Dense<C>, Relu, Dense<A>>;
  static_assert(pinnquad::detail::fits_registers<Net, Pack>());
  Net network;
  fill_uniform(network.parameters, engine);
  const PackedNetwork<Net, Pack> packed(network.parameters);
  check_case<Scalar>(
      {{A, B, C, A}, network.parameters.data(), [&](const Scalar* x, Scalar* y) { packed.forward(x, y); }}, engine);
}

/// B is 1 to half of Count and C is Count down to the other half; A is odd and even, small and large: 11 is prime to
/// Count.
template <class Pack, int Count, int... Each>
void check_all_sizes(std::integer_sequence<int, Each...>) {
  static_assert(Count % 2 == 0 && Count % 11 != 0 && sizeof...(Each) == Count / 2);
  std::mt19937_64 engine(41);
  (check_sizes<Pack, (11 * Each + 15) % Count + 1, Each + 1, Count - Each>(engine), ...);
}

/// 1 / v, with a pack form: infinite in lanes that hold nothing.
template <class Scalar, int Size>
struct ReciprocalLayer : pinnquad::ElementwiseLayer<ReciprocalLayer<Scalar, Size>, Scalar, Size> {
  static Scalar activate(Scalar v) noexcept { return Scalar(1) / v; }
  template <class Pack>
  static Pack activate(Pack v) noexcept {
    return Pack::broadcast(Scalar(1)) / v;
  }
};
struct Reciprocal {
  template <class Scalar, int In>
  using Bind = ReciprocalLayer<Scalar, In>;
};

}  // namespace

TEST_CASE_TEMPLATE("any size: values, NaN and infinity from any input, nothing read or written behind", Pack,
                   pinnquad::NativePack<float>, pinnquad::NativePack<double>) {
  // narrow packs repeat themselves behind one group of blocks and a register; a wide one has three registers in 40
  // anyway
  constexpr int count = Pack::values < 8 ? (Pack::blocks_at_once + 1) * Pack::values : 40;
  check_all_sizes<Pack, count>(std::make_integer_sequence<int, count / 2>{});
}

TEST_CASE_TEMPLATE("every pack: sizes on both sides of its registers", Pack, PINNQUAD_TEST_REGISTER_PACKS,
                   PINNQUAD_TEST_DOUBLE_PACKS) {
  std::mt19937_64 engine(43);
  check_sizes<Pack, 16, 25, 4>(engine);
  check_sizes<Pack, 5, 9, 17>(engine);
  check_sizes<Pack, 8, 7, 33>(engine);
}

TEST_CASE_TEMPLATE("an activation that is infinite at zero does not leak from unused lanes", Pack,
                   PINNQUAD_TEST_REGISTER_PACKS, PINNQUAD_TEST_DOUBLE_PACKS) {
  const auto check = [](auto size) {
    constexpr int count = decltype(size)::value;
    CAPTURE(count);
    using Scalar = typename Pack::Scalar;
    using Net = Network<Scalar, InputSize<3>, Dense<count>, Reciprocal, Dense<25>, Reciprocal, Dense<2>>;
    std::mt19937_64 engine(42);
    Net network;
    for (auto& p : network.parameters)
      p = static_cast<Scalar>(pinnquad::uniform(engine, 0.5, 1.0));  // no pole, no cancelling
    std::array<Scalar, 3> x = {Scalar(0.5), Scalar(1), Scalar(0.75)};
    std::array<Scalar, 2> expected{}, y{};
    network.forward(x.data(), expected.data());
    PackedNetwork<Net, Pack>(network.parameters).forward(x.data(), y.data());
    // three sums of at most 25 positive terms and two quotients: each error relative
    for (std::size_t i = 0; i < 2; ++i)
      CHECK(std::fabs(y[i] / expected[i] - Scalar(1)) <= 70 * std::numeric_limits<Scalar>::epsilon());
  };
  check(pinnquad::Index<2>{});
  check(pinnquad::Index<13>{});
  check(pinnquad::Index<27>{});
}
