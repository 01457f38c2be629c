// SPDX-License-Identifier: MIT
#include "pinnquad/inference/inverse_features.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>

using namespace pinnquad;

TEST_CASE("InverseFeatures are PhysicsFeatures less the lateral specific force") {
  static_assert(is_feature_set<InverseFeatures> && InverseFeatures::size == PhysicsFeatures::size - 2);
  static_assert(InverseFeatures::angular_acceleration == 1);
  MotionInputs<double> in;
  in.linear_acceleration_m_s2 = {1.1, -0.7, 2.3};
  in.angular_acceleration_rad_s2 = {5, -4, 0.5};
  in.velocity_m_s = {3, -2, 0.4};
  in.body_rates_rad_s = {0.6, -0.9, 0.2};
  in.attitude = from_euler<double>({0.3, -0.4, 1.9});
  REQUIRE(InverseFeatures::check(in) == Status::ok);
  std::array<double, InverseFeatures::size> some{};
  std::array<double, PhysicsFeatures::size> all{};
  InverseFeatures::extract(in, some.data());
  PhysicsFeatures::extract(in, all.data());
  for (std::size_t i = 0; i < some.size(); ++i) {
    CAPTURE(i);
    CHECK(some[i] == all[i + 2]);
    CHECK(std::string(InverseFeatures::names[i]) == PhysicsFeatures::names[i + 2]);
    CHECK(std::string(InverseFeatures::units[i]) == PhysicsFeatures::units[i + 2]);
  }
  // by hand: v_dot + omega x v - R^T g, third component
  const double turning = in.body_rates_rad_s[0] * in.velocity_m_s[1] - in.body_rates_rad_s[1] * in.velocity_m_s[0];
  CHECK(some[0] == doctest::Approx(2.3 + turning - 9.80665 * std::cos(0.3) * std::cos(0.4)).epsilon(1e-12));
  in.velocity_m_s[0] = std::numeric_limits<double>::quiet_NaN();
  CHECK(InverseFeatures::check(in) == Status::not_finite);
}
