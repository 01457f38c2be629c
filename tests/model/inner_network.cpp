// SPDX-License-Identifier: MIT
// A predictor's network on the vector unit says what the predictor says as it is written, to rounding; its bounds hold,
// and NaN goes through.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "pinnquad/model/axis_aligned.hpp"
#include "pinnquad/model/path_bound.hpp"
#include "pinnquad/nn/relu.hpp"
#include "support/random_network.hpp"

using namespace pinnquad;

namespace {

template <int In, class... Specs>
using Net = Network<float, InputSize<In>, Specs..., Dense<4>>;
using Residual = Net<16, Dense<32>, Relu, Dense<32>, Relu>;
using Shown = Net<19, Dense<12>, Relu>;
using Base = AxisAligned<float, 19, 1>;

using Structured = Sum<Base, Saturated<Masked<Residual, 19, 1>>>;
using Bounded = Sum<Base, Saturated<PathBounded<Shown>>>;
using OfTwoTaps = Sum<AxisAligned<float, 19, 1, 9>, Saturated<Masked<Net<13, Dense<25>, Relu>, 19, 1, 9>>>;
using Bare = Masked<Residual, 19, 1>;

template <class Predictor>
struct Bounds;
template <class First, class Second>
struct Bounds<Sum<First, Second>> {
  static constexpr int first = First::parameter_count;
};

}  // namespace

TEST_CASE_TEMPLATE("with its network on the vector unit as it is written", Predictor, Structured, Bounded, OfTwoTaps,
                   Bare) {
  using Inner = detail::InnerNetwork<Predictor>;
  static_assert(Inner::exists);
  std::mt19937_64 engine(7);
  Predictor predictor;
  test::fill_uniform(predictor.parameters, engine, 0.3);
  bool clipped = false;
  if constexpr (!std::is_same_v<Predictor, Bare>) {
    for (std::size_t i = 0; i < 4; ++i) {
      predictor.parameters[Bounds<Predictor>::first + i] = -0.3f;
      predictor.parameters[Bounds<Predictor>::first + 4 + i] = 0.3f;
    }
  }
  const float* const parameters = predictor.parameters.data();
  const auto packed = std::make_unique<const detail::PackedInner<Predictor>>(
      detail::packed_inner<Predictor>(static_cast<const float*>(parameters)));
  std::array<float, 19> x{};
  std::array<float, 4> expected{}, y{};
  for (int round = 0; round < 200; ++round) {
    test::fill_uniform(x, engine, 2.0);
    Predictor::forward(parameters, x.data(), expected.data());
    detail::forward_packed<Predictor>(parameters, *packed, x.data(), y.data());
    // three layers, of at most 32 products of order 1 each
    for (std::size_t i = 0; i < 4; ++i) CHECK(std::fabs(y[i] - expected[i]) <= 2e-5f);
    if constexpr (!std::is_same_v<Predictor, Bare>) {
      std::array<float, 4> base{};
      using First = std::conditional_t<std::is_same_v<Predictor, OfTwoTaps>, AxisAligned<float, 19, 1, 9>, Base>;
      First::forward(parameters, x.data(), base.data());
      for (std::size_t i = 0; i < 4; ++i) {
        CHECK(std::fabs(y[i] - base[i]) <= 0.3f + 1e-5f);
        clipped = clipped || std::fabs(y[i] - base[i]) >= 0.3f - 1e-5f;
      }
    }
  }
  CHECK((clipped || std::is_same_v<Predictor, Bare>));
  x[0] = std::numeric_limits<float>::quiet_NaN();  // all are shown it
  detail::forward_packed<Predictor>(parameters, *packed, x.data(), y.data());
  for (const float v : y) CHECK(std::isnan(v));
}

TEST_CASE("a predictor without a network has none inside") {
  static_assert(!detail::InnerNetwork<Base>::exists);
  static_assert(!detail::InnerNetwork<Sum<Base, Saturated<Base>>>::exists);
  static_assert(detail::InnerNetwork<Structured>::first == Base::parameter_count + 8);
  static_assert(detail::InnerNetwork<Residual>::first == 0);
}
