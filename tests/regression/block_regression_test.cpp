// SPDX-License-Identifier: MIT
// Regression with intervals: exact where there is no noise, intervals that hold the truth as often as they say where
// errors of neighbours are alike, instruments where least squares is wrong.
#include "pinnquad/regression/block_regression.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "pinnquad/core/random.hpp"

using namespace pinnquad;

namespace {

/// An autoregressive series: correlation of neighbours `memory`, deviation 1.
class Walk {
 public:
  Walk(std::mt19937_64& engine, double memory) : engine_(engine), memory_(memory), now_(standard_normal(engine)) {}
  double next() {
    now_ = memory_ * now_ + std::sqrt(1 - memory_ * memory_) * standard_normal(engine_);
    return now_;
  }

 private:
  std::mt19937_64& engine_;
  double memory_, now_;
};

}  // namespace

TEST_CASE("quantiles of Student's t are those of the tables") {
  CHECK(student_t_975(4) == doctest::Approx(2.776).epsilon(2e-3));
  CHECK(student_t_975(10) == doctest::Approx(2.228).epsilon(1e-3));
  CHECK(student_t_975(29) == doctest::Approx(2.045).epsilon(1e-3));
  CHECK(student_t_975(1e9) == doctest::Approx(1.960).epsilon(1e-3));
}

TEST_CASE("a law without noise is found exactly, by least squares and by instruments, of any scale") {
  for (const std::size_t instruments : {std::size_t(0), std::size_t(3)}) {
    CAPTURE(instruments);
    std::mt19937_64 engine(1);
    BlockRegression regression(2, instruments, 5);
    for (std::size_t row = 0; row < 100; ++row) {
      const double a = 1e-5 * uniform(engine, -1, 1), b = 1e4 * uniform(engine, 0, 1);
      const std::array<double, 2> x = {a, b};
      const std::array<double, 3> z = {a, b, 1};
      regression.add(row / 20, x.data(), 3e5 * a - 2 * b, z.data());
    }
    const BlockSolution solution = regression.solve();
    CHECK(solution.blocks() == 5);
    CHECK(solution.estimate(0).value == doctest::Approx(3e5));
    CHECK(solution.estimate(1).value == doctest::Approx(-2));
    CHECK(solution.estimate(1).half_width < 1e-6);
    const Estimate ratio = solution.estimate_of([](const auto& values) { return values[0] / values[1]; });
    CHECK(ratio.value == doctest::Approx(-1.5e5));
  }
}

TEST_CASE("what stands still or repeats another is not told, and does no harm to the rest") {
  std::mt19937_64 engine(2);
  BlockRegression regression(4, 0, 4);
  for (std::size_t row = 0; row < 80; ++row) {
    const double a = uniform(engine, -1, 1), b = uniform(engine, -1, 1);
    const std::array<double, 4> x = {a, 0, 2 * a, b};
    regression.add(row / 20, x.data(), 5 * a + 7 * b);
  }
  const BlockSolution solution = regression.solve();
  CHECK(solution.estimate(0).value == doctest::Approx(5));
  CHECK_FALSE(solution.told(1));
  CHECK_FALSE(solution.told(2));
  CHECK(std::isinf(solution.estimate(2).half_width));
  CHECK(solution.estimate(2).value == 0);
  CHECK(solution.estimate(3).value == doctest::Approx(7));
}

TEST_CASE("intervals hold the truth in about 95 of 100 cases although the errors of neighbours are alike") {
  constexpr int cases = 300;
  constexpr std::size_t rows = 1200, blocks = 30;  // blocks of 40, errors that die out in 5
  std::mt19937_64 engine(3);
  int held = 0, held_by_least_squares = 0;
  for (int one = 0; one < cases; ++one) {
    Walk moved(engine, 0.9), error(engine, 0.8);
    BlockRegression regression(2, 0, blocks);
    double xx = 0, ee = 0;
    for (std::size_t row = 0; row < rows; ++row) {
      const std::array<double, 2> x = {moved.next(), 1};
      const double e = error.next();
      regression.add(row * blocks / rows, x.data(), 2 * x[0] + 1 + e);
      xx += x[0] * x[0];
      ee += e * e;
    }
    const Estimate slope = regression.solve().estimate(0);
    held += slope.holds(2) ? 1 : 0;
    // the textbook's interval, of errors that know nothing of each other
    held_by_least_squares += std::abs(slope.value - 2) <= 1.96 * std::sqrt(ee / double(rows) / xx) ? 1 : 0;
  }
  CHECK(held >= 273);  // 91 %: three deviations below 95 %
  CHECK(held <= 296);
  CHECK(held_by_least_squares < 240);
}

TEST_CASE("an error that goes into the regressor through feedback: least squares misses, past instruments do not") {
  constexpr std::size_t rows = 20000, blocks = 40;
  std::mt19937_64 engine(4);
  Walk wanted(engine, 0.95);
  BlockRegression plain(1, 0, blocks), by_past(1, 3, blocks);
  std::array<double, 3> past{};
  for (std::size_t row = 0; row < rows; ++row) {
    const double noise = standard_normal(engine);
    const double u = wanted.next() - 0.7 * noise;  // the controller sees the noise
    const double y = 3 * u + noise;
    if (row >= past.size()) {
      plain.add(row * blocks / rows, &u, y);
      by_past.add(row * blocks / rows, &u, y, past.data());
    }
    past = {u, past[0], past[1]};
  }
  const Estimate wrong = plain.solve().estimate(0), right = by_past.solve().estimate(0);
  CHECK_FALSE(wrong.holds(3));
  CHECK(wrong.value < 2.7);
  CHECK(right.holds(3));
  CHECK(right.half_width < 0.1);
}

TEST_CASE("fewer than three blocks give no interval; no unknown and too few instruments are refused") {
  BlockRegression regression(1, 0, 2);
  for (std::size_t row = 0; row < 10; ++row) {
    const double x = double(row);
    regression.add(row % 2, &x, 2 * x);
  }
  CHECK(regression.solve().estimate(0).value == doctest::Approx(2));
  CHECK(std::isinf(regression.solve().estimate(0).half_width));
  CHECK_THROWS_AS(BlockRegression(0, 0, 3), std::invalid_argument);
  CHECK_THROWS_AS(BlockRegression(1, 0, 0), std::invalid_argument);
  CHECK_THROWS_AS(BlockRegression(2, 1, 3), std::invalid_argument);
}
