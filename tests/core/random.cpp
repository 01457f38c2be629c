// SPDX-License-Identifier: MIT
// Known answers were computed by a second implementation of mt19937_64 and of the formulas, in Python.
#include "pinnquad/core/random.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "support/tolerances.hpp"

namespace {
constexpr std::uint64_t seed = 42;
}

TEST_CASE("the engine is the standard's") {
  std::mt19937_64 engine;
  engine.discard(9999);
  CHECK(engine() == 9981545732273789042u);  // [rand.predef]
}

TEST_CASE("uniform_01 and uniform: known bits") {
  std::mt19937_64 engine(seed);
  CHECK(pinnquad::uniform_01(engine) == 0x1.82a3befaddcbcp-1);
  CHECK(pinnquad::uniform_01(engine) == 0x1.472f1f73724a0p-1);
  CHECK(pinnquad::uniform_01(engine) == 0x1.81192cfe1cbcfp-1);
  engine.seed(seed);
  CHECK(pinnquad::uniform(engine, -3.0, 2.5) == 0x1.27424d31e1f04p+0);
  CHECK(pinnquad::uniform(engine, -3.0, 2.5) == 0x1.07832cfaf4970p-1);
  CHECK(pinnquad::uniform(engine, -3.0, 2.5) == 0x1.23053bbacf078p+0);
}

TEST_CASE("uniform_index: known answers, with rejected draws") {
  std::mt19937_64 engine(seed);
  for (const std::uint64_t expected : {6u, 4u, 0u, 2u, 1u, 8u, 6u, 4u, 0u, 7u})
    CHECK(pinnquad::uniform_index(engine, 10) == expected);
  // a quarter of the engine's values is rejected for this count: the first of these draws is
  const std::uint64_t count = 3 * (std::uint64_t{1} << 62);
  for (const std::uint64_t expected :
       {9660662969780974662u, 12641024047231570392u, 11756813601242511406u, 1412093754192123597u}) {
    CHECK(pinnquad::uniform_index(engine, count) == expected);
  }
}

TEST_CASE("standard_normal: known answers") {
  // log and cos of the C library may differ in the last bit from machine to machine
  const double libm_tolerance = pinnquad::test::rounding<double>(4);
  std::mt19937_64 engine(7);
  for (const double expected : {1.5913998756469563, 0.3889032347053571, 0.5191723646028278, 1.5343549480559588}) {
    CHECK(std::fabs(pinnquad::standard_normal(engine) - expected) <= libm_tolerance * expected);
  }
}

TEST_CASE("shuffle: known answer, and a permutation for every length") {
  std::mt19937_64 engine(seed);
  std::vector<int> values(10);
  std::iota(values.begin(), values.end(), 0);
  pinnquad::shuffle(values, engine);
  CHECK(values == std::vector<int>{1, 7, 9, 0, 3, 8, 4, 2, 5, 6});

  for (std::size_t length = 0; length < 40; ++length) {
    std::vector<std::size_t> indices(length);
    std::iota(indices.begin(), indices.end(), std::size_t{0});
    pinnquad::shuffle(indices, engine);
    std::sort(indices.begin(), indices.end());
    bool permutation = true;
    for (std::size_t i = 0; i < length; ++i) permutation = permutation && indices[i] == i;
    CHECK(permutation);
  }
}

namespace {
/// The engine's extremes: all zeros, all ones.
struct Extremes {
  using result_type = std::uint64_t;
  static constexpr std::uint64_t min() { return 0; }
  static constexpr std::uint64_t max() { return ~std::uint64_t{0}; }
  std::uint64_t value;
  std::uint64_t operator()() { return value; }
};
}  // namespace

TEST_CASE("the extremes of the engine stay in range") {
  Extremes zeros{0}, ones{~std::uint64_t{0}};
  CHECK(pinnquad::uniform_01(zeros) == 0.0);
  CHECK(pinnquad::uniform_01(ones) < 1.0);
  CHECK(std::isfinite(pinnquad::standard_normal(zeros)));
  CHECK(std::isfinite(pinnquad::standard_normal(ones)));
  CHECK(pinnquad::uniform_index(ones, 10) < 10u);
  CHECK(pinnquad::uniform_index(ones, 1) == 0u);
  CHECK(pinnquad::uniform_index(zeros, 8) == 0u);
}
