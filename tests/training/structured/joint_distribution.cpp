// SPDX-License-Identifier: MIT
#include "pinnquad/training/structured/trust_limits.hpp"

#include <Eigen/LU>

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "pinnquad/core/random.hpp"
#include "pinnquad/features/motion_parts.hpp"

using namespace pinnquad;

namespace {

using Features = Joined<AngularAcceleration, BodyRates>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Normal rows with means and correlations of their own, in units that differ by a factor of thousands.
Flight normal_rows(std::size_t rows, unsigned seed) {
  Matrix6 mix = Matrix6::Zero();
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) mix(i, j) = (i == j ? 1.0 : 0.4) * (1 + 0.3 * j - 0.2 * i) * std::pow(4.0, i - 2);
  }
  std::mt19937_64 engine(seed);
  Flight flight(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    Vector6 z;
    for (int i = 0; i < 6; ++i) z[i] = standard_normal(engine);
    const Vector6 x = mix * z + Vector6::LinSpaced(6, -3, 50);
    flight[row].time_s = 0.05 * static_cast<double>(row);
    for (int i = 0; i < 3; ++i) {
      flight[row].angular_acceleration_rad_s2[i] = x[i];
      flight[row].body_rates_rad_s[i] = x[3 + i];
    }
  }
  return flight;
}

Vector6 features(const Sample& sample) {
  const auto x = sample_features<Features, double>(sample);
  return Eigen::Map<const Vector6>(x.data());
}

RowSet all(const Flight& flight) { return RowSet(flight, {0, flight.size()}); }

detail::JointDistribution fitted_to(const RowSet& rows, double shrinkage = FittedTrust::Settings{}.shrinkage) {
  AskedModel model;
  model.units.assign(Features::units.begin(), Features::units.end());
  model.each_exact_row = detail::rows_of_features<Features, double>();
  return detail::fit_joint_distribution(model, rows, shrinkage);
}

}  // namespace

TEST_CASE("the squared distance is (x - mean)' C^-1 (x - mean) of the shrunk covariance, by a dense inverse") {
  const Flight flight = normal_rows(400, 1);
  const auto fitted = fitted_to(all(flight), 0.05);
  Vector6 mean = Vector6::Zero();
  for (const Sample& sample : flight) mean += features(sample) / 400;
  Matrix6 covariance = Matrix6::Zero();
  for (const Sample& sample : flight)
    covariance += (features(sample) - mean) * (features(sample) - mean).transpose() / 400;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) covariance(i, j) *= i == j ? 1.0 : 0.95;
  }
  const Matrix6 inverse = covariance.inverse();
  for (const Sample& sample : normal_rows(50, 2)) {
    const Vector6 d = features(sample) - mean;
    CHECK(fitted.squared_distance(sample_features<Features, double>(sample).data()) ==
          doctest::Approx(d.dot(inverse * d)).epsilon(1e-2));
  }
}

TEST_CASE("of normal rows it is distributed as chi square with as many degrees of freedom as features") {
  const Flight flight = normal_rows(20000, 3), fresh = normal_rows(20000, 4);
  const auto fitted = fitted_to(all(flight));
  double sum = 0;
  int beyond_5 = 0, beyond_1 = 0;
  for (const Sample& sample : fresh) {
    const double squared = fitted.squared_distance(sample_features<Features, double>(sample).data());
    sum += squared;
    beyond_5 += squared > 12.592 ? 1 : 0;  // 95 % and 99 % quantiles, 6 degrees of freedom
    beyond_1 += squared > 16.812 ? 1 : 0;
  }
  CHECK(sum / 20000 == doctest::Approx(6).epsilon(0.02));
  CHECK(beyond_5 / 20000.0 == doctest::Approx(0.05).epsilon(0.12));
  CHECK(beyond_1 / 20000.0 == doctest::Approx(0.01).epsilon(0.3));
}

TEST_CASE("rows that break what all training rows keep are far, and a feature that stands still has spread 1") {
  Flight flight = normal_rows(500, 5);
  for (Sample& sample : flight) {
    sample.angular_acceleration_rad_s2[1] = 2 * sample.angular_acceleration_rad_s2[0];  // no inverse without shrinkage
    sample.body_rates_rad_s[2] = 7;
  }
  const auto fitted = fitted_to(all(flight));
  auto x = fitted.mean;
  CHECK(fitted.squared_distance(x.data()) == 0);
  x[5] += 3;
  CHECK(fitted.squared_distance(x.data()) == doctest::Approx(9));
  const auto columns = detail::feature_statistics<Features>(all(flight));
  auto kept = fitted.mean, broken = fitted.mean;
  kept[0] += columns[0].scale(), kept[1] += columns[1].scale();
  broken[0] += columns[0].scale(), broken[1] -= columns[1].scale();
  CHECK(fitted.squared_distance(kept.data()) < 10);
  CHECK(fitted.squared_distance(broken.data()) > 1000);
  for (const double w : fitted.whitening) CHECK(is_finite(w));
}

TEST_CASE("too few rows and shares that are none are refused") {
  const Flight few = normal_rows(6, 6), enough = normal_rows(7, 6);
  CHECK_THROWS_AS(fitted_to(all(few)), std::invalid_argument);
  CHECK_NOTHROW(fitted_to(all(enough)));
  for (const double share : {0.0, -0.1, 1.1, std::nan("")}) {
    CHECK_THROWS_AS(fitted_to(all(enough), share), std::invalid_argument);
  }
  // a share that is lost in the rounding of correlations without an inverse
  Flight dependent = normal_rows(500, 7);
  for (Sample& sample : dependent) sample.angular_acceleration_rad_s2[1] = 2 * sample.angular_acceleration_rad_s2[0];
  CHECK_NOTHROW(fitted_to(all(dependent)));
  CHECK_THROWS_AS(fitted_to(all(dependent), 1e-30), std::invalid_argument);
}
