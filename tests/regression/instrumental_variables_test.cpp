// SPDX-License-Identifier: MIT
// Regression on columns with errors, of data whose errors are known: closed forms where one instrument serves one
// regressor, weights that least squares bend and instruments do not, standard errors against their spread over draws.
#include "pinnquad/regression/instrumental_variables.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "pinnquad/core/random.hpp"
#include "pinnquad/regression/block_regression.hpp"

using namespace pinnquad;

namespace {

/// y = 1 + slope x + 0.5 w + e. x moves on from row to row by `memory` of itself and is measured with errors; w is
/// exact, and goes with x. Instruments: x as measured one row before and one after, then `idle` columns of noise.
struct Law {
  double slope = 2, noise = 1, memory = 0.9, residual = 0.3, residual_memory = 0;
  int rows = 2000, idle = 0;
};

constexpr int noisy_x = 0, exact_w = 1, before = 2, after = 3;

/// Of unit variance: each the last times `memory`, and something new.
std::vector<double> series(std::mt19937_64& engine, int rows, double memory) {
  std::vector<double> values;
  double last = standard_normal(engine);
  for (int i = 0; i < rows; ++i) {
    last = memory * last + std::sqrt(1 - memory * memory) * standard_normal(engine);
    values.push_back(last);
  }
  return values;
}

std::vector<RegressionSums> blocks_of(const Law& law, std::uint64_t seed, int block_rows = 50) {
  std::mt19937_64 engine(seed);
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  const std::vector<double> x = series(engine, law.rows, law.memory), own = series(engine, law.rows, 0.5),
                            e = series(engine, law.rows, law.residual_memory);
  std::vector<double> measured = x;
  for (double& v : measured) v += law.noise * standard_normal(engine);
  std::vector<RegressionSums> blocks;
  for (int i = 1; i + 1 < law.rows; ++i) {
    if (blocks.empty() || blocks.back().rows() >= block_rows) blocks.emplace_back(4 + law.idle, 1);
    std::vector<double> row = {measured[at(i)], 0.5 * x[at(i)] + own[at(i)], measured[at(i - 1)], measured[at(i + 1)]};
    for (int k = 0; k < law.idle; ++k) row.push_back(standard_normal(engine));
    const double y = 1 + law.slope * x[at(i)] + 0.5 * row[1] + law.residual * e[at(i)];
    blocks.back().add(row.data(), &y);
  }
  return blocks;
}

InstrumentRoles roles_of(const Law& law) {
  InstrumentRoles roles{{exact_w}, {noisy_x}, {before, after}};
  for (int k = 0; k < law.idle; ++k) roles.instruments.push_back(4 + k);
  return roles;
}

InstrumentedWeight weight_of(const Law& law, std::uint64_t seed, int block_rows = 50) {
  return instrumented_weight(blocks_of(law, seed, block_rows), 0, roles_of(law), noisy_x);
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double deviation_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double sum = 0;
  for (const double v : values) sum += (v - mean) * (v - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

}  // namespace

TEST_CASE("one instrument for one regressor: cov(z, y) / cov(z, x), and least squares for k = 0") {
  const RegressionSums sums = detail::total(blocks_of({}, 1));
  const InstrumentRoles one{{}, {noisy_x}, {before}};
  const Eigen::MatrixXd covariances = sums.covariances();
  const auto weight = [&](double k) {
    return fit_ridge(k_class_sums(sums, one, k), 0, {true, false, false, false}).weights[noisy_x];
  };
  CHECK(weight(1) == doctest::Approx(covariances(before, 4) / covariances(before, noisy_x)).epsilon(1e-9));
  CHECK(weight(0) == doctest::Approx(covariances(noisy_x, 4) / covariances(noisy_x, noisy_x)).epsilon(1e-12));
  // as many instruments as noisy regressors: limited information is two-stage least squares, k = 1
  CHECK(fuller_k(sums, one) == doctest::Approx(1 - 1 / (sums.rows() - 2)).epsilon(1e-9));
}

TEST_CASE("sums of an input as the output are those of rows with it there") {
  std::mt19937_64 engine(2);
  RegressionSums sums(3, 1), swapped(3, 1);
  for (int i = 0; i < 20; ++i) {
    const double x[3] = {standard_normal(engine), standard_normal(engine), standard_normal(engine)};
    const double y = standard_normal(engine);
    sums.add(static_cast<const double*>(x), &y);
    swapped.add(static_cast<const double*>(x), x + 1);
  }
  CHECK((sums.of_input(1).products() - swapped.products()).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("least squares bend the weight by the share of the errors, instruments do not") {
  const Law law{2, 1, 0.9, 0.3, 0, 20000};
  const InstrumentedWeight found = weight_of(law, 3, 200);
  // what w = x / 2 + own does not tell of x has the variance 1 / (1 + 1 / 4); the errors' is 1
  const double left = 1 / 1.25;
  CHECK(found.least_squares == doctest::Approx(law.slope * left / (left + 1)).epsilon(0.03));
  CHECK(found.instrumented == doctest::Approx(law.slope).epsilon(0.02));
  CHECK(std::abs(found.instrumented - law.slope) < 3 * found.instrumented_error);
  CHECK(found.errors_in_variables);
  CHECK(found.strength > 1000);
}

TEST_CASE("without errors, and with few, the test of exogeneity finds nothing; a sign turns nothing") {
  int found = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (const double noise : {0.0, 0.15}) {
      Law law;
      law.noise = noise;  // 0.15: bends by 0.15^2 / 0.8, less than 5 %
      found += weight_of(law, 10 + seed).errors_in_variables ? 1 : 0;
    }
  }
  CHECK(found <= 2);
  Law negative;
  negative.slope = -2;
  CHECK(weight_of(negative, 4).errors_in_variables);
  negative.noise = 0;
  CHECK_FALSE(weight_of(negative, 4).errors_in_variables);
}

TEST_CASE("standard errors are the spread over draws, of residuals that remember too") {
  for (const double memory : {0.0, 0.95}) {
    Law law;
    law.noise = 0.3;
    law.residual = 1;
    law.residual_memory = memory;
    std::vector<double> weights, errors, row_by_row;
    int covered = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      const InstrumentedWeight found = weight_of(law, 100 + seed, 100);
      weights.push_back(found.instrumented);
      errors.push_back(found.instrumented_error);
      const double half = student_t_975(19) * found.instrumented_error;
      covered += std::abs(found.instrumented - law.slope) < half ? 1 : 0;
      if (seed < 3) row_by_row.push_back(weight_of(law, 100 + seed, 1).instrumented_error);
    }
    CHECK(mean_of(errors) == doctest::Approx(deviation_of(weights)).epsilon(0.25));
    CHECK(covered >= 52);  // of 57; three deviations below are 52
    if (memory > 0) CHECK(mean_of(row_by_row) < 0.6 * deviation_of(weights));
  }
}

TEST_CASE("many weak instruments lean two-stage least squares towards least squares; Fuller's estimator hardly") {
  Law law;
  law.memory = 0.25;
  law.noise = 2;
  law.idle = 30;
  std::vector<double> two_stage, fuller, strength;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RegressionSums sums = detail::total(blocks_of(law, 200 + seed));
    const InstrumentRoles roles = roles_of(law);
    const std::vector<bool> taken = detail::regressors(sums, roles);
    two_stage.push_back(fit_ridge(k_class_sums(sums, roles, 1), 0, taken).weights[noisy_x]);
    fuller.push_back(fit_ridge(k_class_sums(sums, roles, fuller_k(sums, roles)), 0, taken).weights[noisy_x]);
    strength.push_back(detail::first_stage_strength(sums, roles, noisy_x));
  }
  const double error = deviation_of(fuller) / std::sqrt(40.0);
  CHECK(mean_of(two_stage) < 0.8 * law.slope);
  CHECK(std::abs(mean_of(fuller) - law.slope) < 4 * error);
  CHECK(mean_of(strength) < 10);
}

TEST_CASE("around the weight the others are shrunk to what is known of them: noise to nothing, a real one hardly") {
  // two columns that nearly repeat each other and mean nothing, one that means something
  const auto errors_of = [](double meant, bool shrunk) {
    std::array<double, 2> worst{};  // of the two, of the one
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      std::mt19937_64 engine(seed);
      RegressionSums sums(6, 1);
      double last = 0, measured[3] = {0, 0, 0};
      for (int i = 0; i < 3000; ++i) {
        last = 0.9 * last + std::sqrt(0.19) * standard_normal(engine);
        const double a = standard_normal(engine), b = a + 0.1 * standard_normal(engine), c = standard_normal(engine);
        const double rows[6] = {measured[1], a, b, c, measured[0], measured[2]};
        const double y = 2 * measured[1] + meant * c + 10 * standard_normal(engine);
        sums.add(static_cast<const double*>(rows), &y);
        measured[0] = measured[1];
        measured[1] = measured[2];
        measured[2] = last;
      }
      const InstrumentRoles roles{{1, 2, 3}, {0}, {4, 5}};
      const RegressionSums moved = k_class_sums(sums, roles, fuller_k(sums, roles));
      const AffineMap free = detail::fit_k_class(moved, roles);
      const AffineMap map = shrunk ? fit_instrumented(sums, roles, 0) : free;
      CHECK(map.weights[0] == doctest::Approx(free.weights[0]).epsilon(1e-9));
      worst[0] = std::max({worst[0], std::abs(map.weights[1]), std::abs(map.weights[2])});
      worst[1] = std::max(worst[1], std::abs(map.weights[3] - meant));
    }
    return worst;
  };
  CHECK(errors_of(0, false)[0] > 2);
  CHECK(errors_of(0, true)[0] < 0.5);
  CHECK(errors_of(10, true)[1] < 0.6);  // three deviations of least squares, 10 / sqrt(3000)
}

TEST_CASE("bounds hold for an instrumented weight too") {
  Law law;
  const RegressionSums sums = detail::total(blocks_of(law, 5));
  const AffineMap above = fit_instrumented(sums, roles_of(law), noisy_x, {{{{noisy_x, 1.0}}, 3.0, false}});
  CHECK(above.weights[noisy_x] == doctest::Approx(3).epsilon(1e-9));
  CHECK(above.weights[before] == 0);
}

TEST_CASE("regressors that stand still or repeat each other leave a finite answer") {
  RegressionSums sums(4, 1);
  std::mt19937_64 engine(6);
  for (int i = 0; i < 100; ++i) {
    const double x = standard_normal(engine), row[4] = {x, x, 0, 0};
    sums.add(static_cast<const double*>(row), &x);
  }
  const InstrumentRoles roles{{}, {0, 1}, {2, 3}};
  CHECK(fuller_k(sums, roles) == 1);
  CHECK(std::isfinite(fit_instrumented(sums, roles, 0).weights[0]));
}

TEST_CASE("quantiles of Student's t, and too few blocks") {
  CHECK(student_t_975(9) == doctest::Approx(2.262).epsilon(0.003));
  CHECK(student_t_975(29) == doctest::Approx(2.045).epsilon(0.001));
  CHECK(student_t_975(1000000) == doctest::Approx(1.96).epsilon(0.001));
  CHECK_THROWS_AS(static_cast<void>(weight_of({}, 7, 1000)), std::invalid_argument);
}
