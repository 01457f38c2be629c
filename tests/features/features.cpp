// SPDX-License-Identifier: MIT
#include "pinnquad/features/features.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "support/numbers_of.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"

using pinnquad::Accelerations;
using pinnquad::EulerAngles;
using pinnquad::is_feature_set;
using pinnquad::motion_inputs;
using pinnquad::MotionInputs;
using pinnquad::MotionInputsWithAltitude;
using pinnquad::PaperFeatures;
using pinnquad::PaperFeaturesWithAltitude;
using pinnquad::State;
using pinnquad::Status;
using pinnquad::test::draws;
using pinnquad::test::RandomStates;
using pinnquad::test::rotation_tolerance;
using pinnquad::test::rounding;

namespace {

template <class Scalar>
MotionInputs<Scalar> random_inputs(RandomStates& random) {
  return motion_inputs(random.state<Scalar>(), random.motion<Scalar>());
}

template <class Scalar>
std::array<Scalar, 16> features(const MotionInputs<Scalar>& inputs) {
  std::array<Scalar, 16> x{};
  PaperFeatures::extract(inputs, x.data());
  return x;
}

struct NoFeatures {};
struct FeaturesWithTooFewNames : PaperFeatures {
  static constexpr std::array<const char*, 2> names = {"a", "b"};
};

}  // namespace

TEST_CASE("sixteen entries in the paper's order (docs/paper.md, deviation 1)") {
  MotionInputs<double> inputs;
  inputs.linear_acceleration_m_s2 = {1, 2, 3};
  inputs.angular_acceleration_rad_s2 = {4, 5, 6};
  inputs.velocity_m_s = {7, 8, 9};
  inputs.body_rates_rad_s = {10, 11, 12};
  inputs.attitude = pinnquad::from_euler(EulerAngles<double>{0.3, -0.2, 1.1});
  const auto x = features(inputs);
  for (std::size_t i = 0; i < 12; ++i) CHECK(x[i] == static_cast<double>(i + 1));
  CHECK(std::fabs(x[12] - 0.3) <= rotation_tolerance<double>);
  CHECK(std::fabs(x[13] + 0.2) <= rotation_tolerance<double>);
  CHECK(std::fabs(x[14] - std::sin(1.1)) <= rotation_tolerance<double>);
  CHECK(std::fabs(x[15] - std::cos(1.1)) <= rotation_tolerance<double>);
  CHECK(PaperFeatures::size == 16);
  const std::array<std::string, 16> names = {"vdot_bx", "vdot_by", "vdot_bz", "wdot_x", "wdot_y", "wdot_z",
                                             "v_bx",    "v_by",    "v_bz",    "w_x",    "w_y",    "w_z",
                                             "roll",    "pitch",   "sin_yaw", "cos_yaw"};
  for (std::size_t i = 0; i < 16; ++i) CHECK(PaperFeatures::names[i] == names[i]);
  CHECK(std::string(PaperFeatures::names[PaperFeatures::angular_acceleration]) == "wdot_x");
}

TEST_CASE_TEMPLATE("attitudes there and back, all headings", Scalar, float, double) {
  // near pitch +-90 degrees the angles themselves are ill-conditioned: asin loses half its digits there
  for (double roll = -3.0; roll <= 3.0; roll += 0.4) {
    for (double pitch = -1.4; pitch <= 1.4; pitch += 0.2) {
      for (double yaw = -3.0; yaw <= 3.0; yaw += 0.5) {
        MotionInputs<Scalar> inputs;
        inputs.attitude = pinnquad::from_euler(EulerAngles<Scalar>{Scalar(roll), Scalar(pitch), Scalar(yaw)});
        REQUIRE(PaperFeatures::check(inputs) == Status::ok);
        const auto x = features(inputs);
        const double tolerance = 6 * rotation_tolerance<Scalar>;  // 1 / cos(1.4) = 6
        CHECK(std::fabs(static_cast<double>(x[12]) - roll) <= tolerance);
        CHECK(std::fabs(static_cast<double>(x[13]) - pitch) <= tolerance);
        CHECK(std::fabs(static_cast<double>(x[14]) - std::sin(yaw)) <= tolerance);
        CHECK(std::fabs(static_cast<double>(x[15]) - std::cos(yaw)) <= tolerance);
        // q and -q are one attitude
        const auto& q = inputs.attitude;
        MotionInputs<Scalar> opposite;
        opposite.attitude = {-q.w, -q.x, -q.y, -q.z};
        CHECK(pinnquad::test::distance(features(opposite), x) <= tolerance);
      }
    }
  }
}

TEST_CASE_TEMPLATE("check() finds NaN and infinity in each of the sixteen numbers", Scalar, float, double) {
  RandomStates random(162);
  const auto good = random_inputs<Scalar>(random);
  pinnquad::test::with_each_number_bad<Scalar>(
      good, [](const MotionInputs<Scalar>& inputs) { CHECK(PaperFeatures::check(inputs) == Status::not_finite); });
  CHECK(PaperFeatures::check(good) == Status::ok);
}

TEST_CASE("check() refuses an attitude that is no rotation, and lets rounding pass") {
  MotionInputs<float> inputs;
  for (const float scale : {0.0F, 0.5F, 0.99F, 1.01F, 2.0F, 1e30F}) {
    inputs.attitude = {0.0F, scale, 0.0F, 0.0F};
    CHECK(PaperFeatures::check(inputs) == Status::not_unit_quaternion);
  }
  for (const float scale : {0.9999F, 1.0F, 1.0001F}) {
    inputs.attitude = {0.0F, 0.0F, scale, 0.0F};
    CHECK(PaperFeatures::check(inputs) == Status::ok);
  }
}

TEST_CASE("motion_inputs() asks for the motion in the state, velocity in the body frame") {
  RandomStates random(163);
  const auto state = random.state<double>();
  const auto motion = random.motion<double>();
  const auto inputs = motion_inputs(state, motion);
  CHECK(inputs.linear_acceleration_m_s2 == motion.linear_m_s2);
  CHECK(inputs.angular_acceleration_rad_s2 == motion.angular_rad_s2);
  CHECK(inputs.body_rates_rad_s == state.body_rates_rad_s);
  const auto world = pinnquad::body_to_world(state.attitude, inputs.velocity_m_s);
  CHECK(pinnquad::test::distance(world, state.velocity_m_s) <= 10 * rotation_tolerance<double>);
  CHECK(pinnquad::test::components(inputs.attitude) == pinnquad::test::components(state.attitude));
}

TEST_CASE("with altitude: the sixteen of the paper, then the altitude; check() sees it") {
  RandomStates random(164);
  MotionInputsWithAltitude<float> inputs;
  static_cast<MotionInputs<float>&>(inputs) = random_inputs<float>(random);
  inputs.altitude_m = 1.25F;
  std::array<float, PaperFeaturesWithAltitude::size> x{};
  PaperFeaturesWithAltitude::extract(inputs, x.data());
  const auto paper = features<float>(inputs);
  for (std::size_t i = 0; i < 16; ++i) {
    CHECK(x[i] == paper[i]);
    CHECK(std::string(PaperFeaturesWithAltitude::names[i]) == PaperFeatures::names[i]);
    CHECK(std::string(PaperFeaturesWithAltitude::units[i]) == PaperFeatures::units[i]);
  }
  CHECK(x[16] == 1.25F);
  CHECK(std::string(PaperFeaturesWithAltitude::names[16]) == "altitude");
  CHECK(std::string(PaperFeaturesWithAltitude::units[16]) == "m");
  CHECK(PaperFeaturesWithAltitude::angular_acceleration == PaperFeatures::angular_acceleration);
  CHECK(PaperFeaturesWithAltitude::check(inputs) == Status::ok);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    auto broken = inputs;
    broken.altitude_m = bad;
    CHECK(PaperFeaturesWithAltitude::check(broken) == Status::not_finite);
    broken = inputs;
    broken.body_rates_rad_s[1] = bad;
    CHECK(PaperFeaturesWithAltitude::check(broken) == Status::not_finite);
  }
  inputs.attitude = {0.0F, 2.0F, 0.0F, 0.0F};
  CHECK(PaperFeaturesWithAltitude::check(inputs) == Status::not_unit_quaternion);
}

TEST_CASE("what is a feature set") {
  CHECK(is_feature_set<PaperFeatures>);
  CHECK(is_feature_set<PaperFeaturesWithAltitude>);
  CHECK_FALSE(is_feature_set<NoFeatures>);
  CHECK_FALSE(is_feature_set<FeaturesWithTooFewNames>);
  CHECK_FALSE(is_feature_set<int>);
}
