// SPDX-License-Identifier: MIT
// A predictor on the vector unit says what it says as it is written, to rounding; its bounds hold, and NaN goes
// through.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "pinnquad/model/axis_aligned.hpp"
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
using Bounded = Sum<Base, Saturated<Shown>>;
using OfTwoTaps = Sum<AxisAligned<float, 19, 1, 9>, Saturated<Masked<Net<13, Dense<25>, Relu>, 19, 1, 9>>>;
using OfWindow = Sum<AxisAligned<float, 60, 1, 20, 39>, Saturated<Masked<Net<51, Dense<25>, Relu>, 60, 1, 20, 39>>>;
using Bare = Masked<Residual, 19, 1>;
using WideBare = Masked<Net<51, Dense<25>, Relu>, 60, 1, 20, 39>;

/// A user's own: twice each of the first four features.
struct Twice : detail::PredictorBase<Twice, float, 19, 4, 1> {
  static void forward(const float* parameters, const float* x, float* y) noexcept {
    for (int i = 0; i < 4; ++i) y[i] = parameters[0] * x[i];
  }
};
using OfOwn = Sum<Twice, Saturated<Masked<Residual, 19, 1>>>;

/// A Sum's first, and nothing of what has none.
template <class Predictor>
struct FirstOf {
  using type = void;
};
template <class First, class Second>
struct FirstOf<Sum<First, Second>> {
  using type = First;
};

}  // namespace

TEST_CASE_TEMPLATE("on the vector unit as it is written", Predictor, Structured, Bounded, OfTwoTaps, OfWindow, OfOwn,
                   Bare, WideBare, Base) {
  using First = typename FirstOf<Predictor>::type;
  constexpr bool is_sum = !std::is_void_v<First>;
  static_assert(detail::is_packable<Predictor>);
  std::mt19937_64 engine(7);
  Predictor predictor;
  test::fill_uniform(predictor.parameters, engine, 0.3);
  if constexpr (is_sum) {
    for (std::size_t i = 0; i < 4; ++i) {
      predictor.parameters[First::parameter_count + i] = -0.3f;
      predictor.parameters[First::parameter_count + 4 + i] = 0.3f;
    }
  }
  const float* const parameters = predictor.parameters.data();
  const auto packed = std::make_unique<detail::PackedPredictor<Predictor>>();
  packed->assign(parameters);
  CHECK(packed->finite());
  bool clipped = false;
  std::array<float, std::size_t(Predictor::inputs)> x{};
  std::array<float, 4> expected{}, y{};
  for (int round = 0; round < 200; ++round) {
    test::fill_uniform(x, engine, 2.0);
    Predictor::forward(parameters, x.data(), expected.data());
    packed->forward(x.data(), y.data());
    // three layers, of at most 60 products of order 1 each
    for (std::size_t i = 0; i < 4; ++i) CHECK(std::fabs(y[i] - expected[i]) <= 2e-5f);
    if constexpr (is_sum) {
      std::array<float, 4> base{};
      First::forward(parameters, x.data(), base.data());
      for (std::size_t i = 0; i < 4; ++i) {
        CHECK(std::fabs(y[i] - base[i]) <= 0.3f + 1e-5f);
        clipped = clipped || std::fabs(y[i] - base[i]) >= 0.3f - 1e-5f;
      }
    }
  }
  CHECK(clipped == is_sum);
  x[0] = std::numeric_limits<float>::quiet_NaN();  // all are shown it
  packed->forward(x.data(), y.data());
  for (const float v : y) CHECK(std::isnan(v));
  for (const std::size_t broken : {std::size_t(0), predictor.parameters.size() - 1}) {
    Predictor other = predictor;
    other.parameters[broken] = std::numeric_limits<float>::infinity();
    packed->assign(other.parameters.data());
    CHECK(!packed->finite());
  }
}

TEST_CASE("a predictor that says nothing of the vector unit runs as it is written") {
  static_assert(!detail::is_packable<Twice>);
  static_assert(detail::is_packable<OfOwn>);
}
