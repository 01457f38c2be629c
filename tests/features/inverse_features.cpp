// SPDX-License-Identifier: MIT
#include "pinnquad/features/motion_parts.hpp"

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

TEST_CASE("with altitude: those of the motion, then the altitude; check() sees both") {
  static_assert(is_feature_set<InverseFeaturesWithAltitude>);
  static_assert(InverseFeaturesWithAltitude::size == InverseFeatures::size + 1);
  static_assert(InverseFeaturesWithAltitude::angular_acceleration == InverseFeatures::angular_acceleration);
  MotionInputsWithAltitude<float> in;
  in.linear_acceleration_m_s2 = {1.1F, -0.7F, 2.3F};
  in.velocity_m_s = {3, -2, 0.4F};
  in.body_rates_rad_s = {0.6F, -0.9F, 0.2F};
  in.attitude = from_euler<float>({0.3F, -0.4F, 1.9F});
  in.altitude_m = 0.35F;
  REQUIRE(InverseFeaturesWithAltitude::check(in) == Status::ok);
  std::array<float, InverseFeaturesWithAltitude::size> x{};
  std::array<float, InverseFeatures::size> of_motion{};
  InverseFeaturesWithAltitude::extract(in, x.data());
  InverseFeatures::extract<float>(static_cast<const MotionInputs<float>&>(in), of_motion.data());
  for (std::size_t i = 0; i < of_motion.size(); ++i) {
    CAPTURE(i);
    CHECK(x[i] == of_motion[i]);
    CHECK(std::string(InverseFeaturesWithAltitude::names[i]) == InverseFeatures::names[i]);
    CHECK(std::string(InverseFeaturesWithAltitude::units[i]) == InverseFeatures::units[i]);
  }
  CHECK(x.back() == 0.35F);
  CHECK(std::string(InverseFeaturesWithAltitude::names.back()) == "altitude");
  CHECK(std::string(InverseFeaturesWithAltitude::units.back()) == "m");
  in.altitude_m = std::numeric_limits<float>::infinity();
  CHECK(InverseFeaturesWithAltitude::check(in) == Status::not_finite);
  in.altitude_m = 0.35F;
  in.attitude = {0, 2, 0, 0};
  CHECK(InverseFeaturesWithAltitude::check(in) == Status::not_unit_quaternion);
}
