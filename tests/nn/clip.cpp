// SPDX-License-Identifier: MIT
#include "pinnquad/nn/clip.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "pinnquad/nn/jacobian.hpp"
#include "pinnquad/nn/network.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "support/random_network.hpp"

using namespace pinnquad;

TEST_CASE_TEMPLATE("what is within 3.5 stays to the bit, what is beyond becomes the bound, NaN goes through", Scalar,
                   float, double) {
  using Layer = Clip::Bind<Scalar, 1>;
  for (const Scalar v : {Scalar(0), Scalar(-0.1), Scalar(3.4999), Scalar(-3.5), Scalar(3.5)}) {
    CHECK(Layer::activate(v) == v);
  }
  const Scalar infinity = std::numeric_limits<Scalar>::infinity();
  CHECK(Layer::activate(Scalar(3.51)) == Scalar(3.5));
  CHECK(Layer::activate(Scalar(-1e30)) == Scalar(-3.5));
  CHECK(Layer::activate(infinity) == Scalar(3.5));
  CHECK(Layer::activate(-infinity) == Scalar(-3.5));
  CHECK(std::isnan(Layer::activate(std::numeric_limits<Scalar>::quiet_NaN())));
  CHECK(Layer::slope(Scalar(3.4)) == Scalar(1));
  CHECK(Layer::slope(Layer::activate(Scalar(4))) == Scalar(0));
  CHECK(Layer::slope(Layer::activate(Scalar(-4))) == Scalar(0));
}

TEST_CASE("a network that clips first is the network of clipped inputs, and has no slope by what it clips") {
  using Plain = Network<double, InputSize<6>, Dense<9>, Tanh, Dense<4>>;
  using Clipping = Network<double, InputSize<6>, Clip, Dense<9>, Tanh, Dense<4>>;
  std::mt19937_64 engine(3);
  Plain plain;
  test::fill_uniform(plain.parameters, engine, 1.0);
  Clipping clipping;
  std::copy(plain.parameters.begin(), plain.parameters.end(), clipping.parameters.begin());
  const std::vector<double> x = {0.2, -7, 3.4, 4, -0.6, 90}, clipped = {0.2, -3.5, 3.4, 3.5, -0.6, 3.5};
  double y[4], expected[4], slopes[24], plain_slopes[24];
  clipping.forward(x.data(), y);
  plain.forward(clipped.data(), expected);
  JacobianPass<Clipping>::run(clipping.parameters.data(), x.data(), y, slopes);
  JacobianPass<Plain>::run(plain.parameters.data(), clipped.data(), expected, plain_slopes);
  for (int i = 0; i < 4; ++i) {
    CHECK(y[i] == expected[i]);
    for (int k = 0; k < 6; ++k) {
      const bool inside = std::abs(x[std::size_t(k)]) < 3.5;
      CHECK(slopes[6 * i + k] == doctest::Approx(inside ? plain_slopes[6 * i + k] : 0.0));
    }
  }
}
