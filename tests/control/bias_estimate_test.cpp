// SPDX-License-Identifier: MIT
// The bias estimate: its closed form, its bound, what freezes it.
#include "pinnquad/control/bias_estimate.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using pinnquad::BiasEstimate;
using pinnquad::Vector3;

namespace {

constexpr double step_s = 1e-3;

/// Falls freely by `bias` besides what is expected.
Vector3<double> fly(BiasEstimate<double>& estimate, const Vector3<double>& bias, double duration_s,
                    Vector3<double>& velocity) {
  const Vector3<double> expected(0.3, -0.4, 1.2);
  for (int i = 0; i < static_cast<int>(std::lround(duration_s / step_s)); ++i) {
    velocity += (expected + bias) * step_s;
    estimate.update(velocity, expected, step_s);
  }
  return estimate.acceleration_m_s2();
}

}  // namespace

TEST_CASE("a constant disturbance is found as two equal poles find it: d (1 - (1 + w t) exp(-w t))") {
  const Vector3<double> bias(0.5, -1.0, 2.0);
  for (const double bandwidth : {1.0, 2.5}) {
    for (const double t : {0.2, 1.0, 3.0}) {
      BiasEstimate<double> estimate({bandwidth, 3.0});
      Vector3<double> velocity = Vector3<double>::Zero();
      const Vector3<double> found = fly(estimate, bias, t, velocity);
      const double share = 1 - (1 + bandwidth * t) * std::exp(-bandwidth * t);
      CHECK((found - share * bias).norm() <= 0.01 * bias.norm());  // Euler's steps of 1 ms
    }
  }
}

TEST_CASE("beyond its bound the estimate keeps the direction") {
  BiasEstimate<double> estimate({2.5, 1.5});
  Vector3<double> velocity = Vector3<double>::Zero();
  const Vector3<double> found = fly(estimate, {0, 6, 8}, 10, velocity);
  CHECK(found.norm() == doctest::Approx(1.5).epsilon(1e-9));
  CHECK(found[1] / found[2] == doctest::Approx(0.75).epsilon(1e-6));
}

TEST_CASE("frozen it stays; what is not finite or too late is not taken; bandwidth 0 estimates nothing") {
  BiasEstimate<double> estimate;
  Vector3<double> velocity = Vector3<double>::Zero();
  const Vector3<double> found = fly(estimate, {0, 0, 2}, 3, velocity);
  REQUIRE(found[2] > 1.9);
  for (int i = 0; i < 1000; ++i) estimate.freeze({0, 0, 0.1 * i});
  CHECK(estimate.acceleration_m_s2() == found);
  CHECK(estimate.predicted_velocity_m_s()[2] == doctest::Approx(99.9));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  estimate.update({nan, 0, 0}, {0, 0, 0}, step_s);
  estimate.update({0, 0, 0}, {0, nan, 0}, step_s);
  estimate.update({0, 0, 50}, {0, 0, 0}, 1.0);
  estimate.update({0, 0, 50}, {0, 0, 0}, nan);
  estimate.resume({0, nan, 0}, {0, 0, 0});
  CHECK(estimate.acceleration_m_s2() == found);
  CHECK(estimate.predicted_velocity_m_s()[2] == doctest::Approx(50));
  BiasEstimate<double> none({0.0, 3.0});
  CHECK(fly(none, {0, 0, 2}, 1, velocity).norm() <= 0);
}
