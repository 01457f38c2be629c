// SPDX-License-Identifier: MIT
#include "pinnquad/nn/elu.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace pinnquad;

TEST_CASE_TEMPLATE("ELU: what is above 0 to the bit, exp(v) - 1 below, and its slope", Scalar, float, double) {
  using Layer = Elu::Bind<Scalar, 1>;
  constexpr auto epsilon = static_cast<double>(std::numeric_limits<Scalar>::epsilon());
  // v, exp(v) - 1, exp(v): of 40 digits (Python's decimal)
  const double rows[][3] = {{-12, -0.99999385578764666, 6.1442123533282098e-6},
                            {-5, -0.99326205300091453, 6.7379469990854671e-3},
                            {-1, -0.63212055882855768, 0.36787944117144232},
                            {-0.25, -0.22119921692859513, 0.77880078307140487},
                            {-0.0009765625, -9.7608581802433777e-4, 0.99902391418197566}};
  for (const auto& row : rows) {
    const Scalar y = Layer::activate(Scalar(row[0]));
    CAPTURE(row[0]);
    CHECK(std::abs(double(y) - row[1]) <= 4 * epsilon * std::abs(row[1]));
    CHECK(std::abs(double(Layer::slope(y)) - row[2]) <= 4 * epsilon);
  }
  for (const Scalar v : {Scalar(1e-30), Scalar(0.5), Scalar(3e30), std::numeric_limits<Scalar>::infinity()}) {
    CHECK(Layer::activate(v) == v);
    CHECK(Layer::slope(v) == Scalar(1));
  }
  CHECK(Layer::activate(Scalar(0)) == Scalar(0));
  CHECK(Layer::slope(Scalar(0)) == Scalar(1));
  CHECK(Layer::activate(-std::numeric_limits<Scalar>::infinity()) == Scalar(-1));
  CHECK(Layer::slope(Scalar(-1)) == Scalar(0));
}
