// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <pinnquad/core/random.hpp>
#include <pinnquad/evaluation/summary.hpp>
#include <random>
#include <stdexcept>
#include <vector>

using pinnquad::pearson_correlation;
using Series = std::vector<double>;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double rounding = 1e-12;

Series normal_series(std::size_t count, unsigned seed) {
  std::mt19937_64 engine(seed);
  Series series(count);
  for (double& value : series) value = pinnquad::standard_normal(engine);
  return series;
}

Series mapped(Series series, double scale, double offset) {
  for (double& value : series) value = scale * value + offset;
  return series;
}

}  // namespace

TEST_CASE("footnote 2 of the paper: two very different pairs, the same correlation") {
  constexpr double printed_digits = 5e-7;  // six digits are known
  const Series x = {1, 2, 3, 4, 5};
  CHECK(std::abs(pearson_correlation(x, {1, -2, -3, 4, 5}) - 0.626099) < printed_digits);
  CHECK(std::abs(pearson_correlation(x, {1, 2, 3, 1.9455, 2.5}) - 0.626096) < printed_digits);
}

TEST_CASE("correlation is symmetric, bounded, and blind to scale and offset but for the sign") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Series x = normal_series(50, seed);
    Series y = normal_series(50, seed + 100);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += 0.1 * seed * x[i];
    const double correlation = pearson_correlation(x, y);
    CHECK(std::abs(correlation) < 1);
    CHECK(pearson_correlation(y, x) == doctest::Approx(correlation).epsilon(rounding));
    CHECK(pearson_correlation(mapped(x, 3.7, -11), mapped(y, 0.02, 5)) ==
          doctest::Approx(correlation).epsilon(rounding));
    CHECK(pearson_correlation(mapped(x, -3.7, 2), y) == doctest::Approx(-correlation).epsilon(rounding));
  }
}

TEST_CASE("series on a line have exactly +-1 at most, never beyond") {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const Series x = normal_series(31, seed);
    const double up = pearson_correlation(x, mapped(x, 0.1, 0.3));
    const double down = pearson_correlation(x, mapped(x, -7.3, 0.3));
    CHECK(up <= 1);
    CHECK(up > 1 - rounding);
    CHECK(down >= -1);
    CHECK(down < -1 + rounding);
  }
}

TEST_CASE("an offset far larger than the spread does no harm") {
  constexpr double offset = 1e8;
  constexpr double offset_tolerance = 1e-7;  // 1e8 rounds the values to 1e-8
  const Series x = normal_series(1000, 3);
  const Series y = normal_series(1000, 4);
  CHECK(std::abs(pearson_correlation(mapped(x, 1, offset), mapped(y, 1, -offset)) - pearson_correlation(x, y)) <
        offset_tolerance);
}

TEST_CASE("what is undefined is NaN") {
  CHECK(std::isnan(pearson_correlation({}, {})));
  CHECK(std::isnan(pearson_correlation({1}, {2})));
  CHECK(std::isnan(pearson_correlation(Series(10, 0.1), normal_series(10, 1))));  // 0.1 x 10 / 10 is not 0.1
  CHECK(std::isnan(pearson_correlation(normal_series(10, 1), Series(10, 0.1))));
  CHECK(std::isnan(pearson_correlation({1e-170, 2e-170, 3e-170}, {1, 2, 3})));  // a variance that underflows to 0
  CHECK(std::isnan(pearson_correlation({1, std::nan(""), 3}, {1, 2, 3})));
  CHECK(std::isnan(pearson_correlation({1, infinity, 3}, {1, 2, 3})));
  CHECK_THROWS_AS(pearson_correlation({1, 2}, {1, 2, 3}), std::invalid_argument);
}
