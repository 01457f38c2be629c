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

TEST_CASE("shuffle reaches all 24 orders of four, equally often") {
  std::mt19937_64 engine(3);
  std::array<int, 256> counts{};
  const int repetitions = 24000;
  for (int i = 0; i < repetitions; ++i) {
    std::array<int, 4> v{0, 1, 2, 3};
    pinnquad::shuffle(v, engine);
    ++counts[static_cast<std::size_t>(v[0] + 4 * v[1] + 16 * v[2] + 64 * v[3])];
  }
  int orders = 0;
  double chi_squared = 0.0;
  for (const int count : counts) {
    if (count == 0) continue;
    ++orders;
    chi_squared += (count - 1000.0) * (count - 1000.0) / 1000.0;
  }
  CHECK(orders == 24);
  CHECK(chi_squared < 49.7);  // 23 degrees of freedom, 0.1 %
}

TEST_CASE("uniform_01 is uniform in [0, 1)") {
  std::mt19937_64 engine(4);
  std::array<int, 20> bins{};
  const int count = 100000;
  double lowest = 1.0, highest = 0.0;
  for (int i = 0; i < count; ++i) {
    const double value = pinnquad::uniform_01(engine);
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
    ++bins[std::min<std::size_t>(19, static_cast<std::size_t>(value * 20.0))];
  }
  CHECK(lowest >= 0.0);
  CHECK(highest < 1.0);
  double chi_squared = 0.0;
  for (const int bin : bins) chi_squared += (bin - 5000.0) * (bin - 5000.0) / 5000.0;
  CHECK(chi_squared < 43.8);  // 19 degrees of freedom, 0.1 %
  CHECK(chi_squared > 3.0);   // too even is wrong as well
}

TEST_CASE("standard_normal has mean 0, variance 1 and a normal's tails") {
  std::mt19937_64 engine(5);
  const int count = 100000;
  double sum = 0.0, squares = 0.0, fourth = 0.0;
  int beyond_two = 0;
  for (int i = 0; i < count; ++i) {
    const double z = pinnquad::standard_normal(engine);
    sum += z;
    squares += z * z;
    fourth += z * z * z * z;
    beyond_two += std::fabs(z) > 2.0 ? 1 : 0;
  }
  // four standard errors each
  CHECK(std::fabs(sum / count) < 4.0 * std::sqrt(1.0 / count));
  CHECK(std::fabs(squares / count - 1.0) < 4.0 * std::sqrt(2.0 / count));
  CHECK(std::fabs(fourth / count - 3.0) < 4.0 * std::sqrt(96.0 / count));
  CHECK(std::fabs(beyond_two / double(count) - 0.0455) < 4.0 * std::sqrt(0.0455 * 0.9545 / count));
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
