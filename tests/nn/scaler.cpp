// SPDX-License-Identifier: MIT
#include "pinnquad/nn/scaler.hpp"

#include <doctest/doctest.h>

#include <array>
#include <random>

#include "support/random_network.hpp"
#include "support/tolerances.hpp"

using pinnquad::Scaler;
using pinnquad::test::rounding;

TEST_CASE_TEMPLATE("standardise and restore are inverse, also in place", Scalar, float, double) {
  std::mt19937_64 engine(3);
  Scaler<Scalar, 5> scaler;
  pinnquad::test::fill_uniform(scaler.mean, engine, 3.0);
  for (Scalar& spread : scaler.standard_deviation) spread = static_cast<Scalar>(pinnquad::uniform(engine, 0.1, 4.0));
  std::array<Scalar, 5> v{}, z{};
  pinnquad::test::fill_uniform(v, engine, 10.0);
  scaler.standardise(v.data(), z.data());
  for (std::size_t i = 0; i < 5; ++i) CHECK(z[i] == (v[i] - scaler.mean[i]) / scaler.standard_deviation[i]);
  scaler.restore(z.data(), z.data());
  // two operations each way on values of order 10
  CHECK(pinnquad::test::distance(z, v) <= 10 * rounding<Scalar>(4));
}

TEST_CASE("a scaler that was not set changes nothing") {
  constexpr Scaler<double, 3> identity{};
  const double v[3] = {-1.5, 0.0, 2.5};
  double z[3] = {};
  identity.standardise(v, z);
  for (int i = 0; i < 3; ++i) CHECK(z[i] == v[i]);
}
