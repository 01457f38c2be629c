// SPDX-License-Identifier: MIT
#include "pinnquad/nn/leaky_relu.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace pinnquad;

TEST_CASE_TEMPLATE("leaky ReLU: what is above 0 to the bit, 0.01 v below to the bit, NaN goes through", Scalar, float,
                   double) {
  using Layer = LeakyRelu::Bind<Scalar, 1>;
  constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();
  for (const Scalar v : {Scalar(1e-30), Scalar(0.3), Scalar(7), Scalar(3e30), infinity}) {
    CHECK(Layer::activate(v) == v);
    CHECK(Layer::activate(-v) == Scalar(0.01) * -v);
    CHECK(Layer::slope(Layer::activate(v)) == Scalar(1));
    CHECK(Layer::slope(Layer::activate(-v)) == Scalar(0.01));
  }
  CHECK(Layer::activate(Scalar(0)) == Scalar(0));
  CHECK(Layer::slope(Scalar(0)) == Scalar(0.01));  // from below, as ReLU's
  CHECK(std::isnan(Layer::activate(std::numeric_limits<Scalar>::quiet_NaN())));
}
