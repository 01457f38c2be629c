// SPDX-License-Identifier: MIT
// Frames, freshness and refusals of examples/ros2_package/src/inverse_core.hpp, by what a vehicle does.
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <doctest/doctest.h>

#include "flight_stacks/structured_trust.hpp"
#include "models/demo_quadrotor.hpp"
#include "models/structured_quadrotor.hpp"
#include "ros2_package/src/inverse_core.hpp"

namespace {

using namespace pinnquad_ros2;
using pinnquad::Vector3;

constexpr std::int64_t second_ns = 1'000'000'000;
const Vector3<float> none = Vector3<float>::Zero();
const Vector3<float> strong(6, 6, 6), turning(20, -20, 2);  // within the envelope, and rotors at their limit
const float half_turn_of_90 = std::sqrt(0.5f);
const pinnquad::Quaternion<float> north{half_turn_of_90, 0, 0, half_turn_of_90};  // ENU: x, east, is yaw 0

using Certain = InverseCore<StructuredQuadModel>;
/// The archived limits, and one that a strong demand passes.
struct StrictTrust {
  static constexpr auto distribution_mean = StructuredQuadModelTrust::distribution_mean;
  static constexpr auto whitening = StructuredQuadModelTrust::whitening;
  static constexpr double squared_distance_limit = 20;
};
using Trusting = InverseCore<StructuredQuadModel, pinnquad::JointDistance<StrictTrust>>;

template <class Core>
Core hovering(const Settings& settings = {}) {
  Core core(settings);
  Motion motion;
  motion.attitude = north;
  core.set_motion(motion, second_ns);
  return core;
}
template <class Core = Certain>
Answer asked(const Vector3<float>& linear, const Vector3<float>& angular, const Settings& settings = {}) {
  return hovering<Core>(settings).answer(linear, angular, second_ns, second_ns);
}

float sum(const Answer& answer) {
  float all = 0;
  for (const float command : answer.commands) all += command;
  return all;
}

// front right, rear left, front left, rear right
TEST_CASE("ros2: accelerations in FLU move the rotors that FLU says") {
  REQUIRE(Certain().self_test() == pinnquad::Status::ok);
  const Answer hover = asked(none, none);
  REQUIRE(std::string(hover.status) == "ok");
  const Answer up = asked({0, 0, 2}, none);
  CHECK(sum(up) > 1.1f * sum(hover));
  const Answer roll = asked(none, {5, 0, 0});  // to the right: the left rotors are faster
  CHECK(roll.commands[1] + roll.commands[2] > roll.commands[0] + roll.commands[3] + 0.02f);
  const Answer pitch = asked(none, {0, 5, 0});  // nose down: the rear rotors are
  CHECK(pitch.commands[1] + pitch.commands[3] > pitch.commands[0] + pitch.commands[2] + 0.02f);
  const Answer yaw = asked(none, {0, 0, 1});  // to the left: those that turn clockwise are
  CHECK(yaw.commands[2] + yaw.commands[3] > yaw.commands[0] + yaw.commands[1] + 0.02f);
}

TEST_CASE("ros2: velocity and attitude are those of NED and FRD") {
  Motion motion;
  motion.attitude = north * pinnquad::Quaternion<float>{std::cos(0.1f), std::sin(0.1f), 0, 0};  // rolled to the right
  motion.velocity_m_s = {2, 1, 0.5f};
  motion.body_rates_rad_s = {0.3f, 0.2f, 0.1f};
  Certain core;
  core.set_motion(motion, second_ns);
  const Answer answer = core.answer({1, 0.5f, 0.25f}, {3, 2, 1}, second_ns, second_ns);
  pinnquad::MotionInputs<float> inputs;
  inputs.attitude = {std::cos(0.1f), std::sin(0.1f), 0, 0};  // heading north, right side down
  inputs.velocity_m_s = {2, -1, -0.5f};
  inputs.body_rates_rad_s = {0.3f, -0.2f, -0.1f};
  inputs.linear_acceleration_m_s2 = {1, -0.5f, -0.25f};
  inputs.angular_acceleration_rad_s2 = {3, -2, -1};
  pinnquad::Commands<float> expected{};
  REQUIRE(pinnquad::InverseDynamics<StructuredQuadModel>().predict(inputs, expected) == pinnquad::Status::ok);
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(static_cast<double>(answer.commands[i]) == doctest::Approx(static_cast<double>(expected[i])).epsilon(1e-5));
}

TEST_CASE("ros2: what is stale, of the future or without a stamp is not answered") {
  struct Case {
    const char* status;
    std::int64_t state_ms, request_ms, now_ms;
  };
  for (const Case& now : {Case{"stale_state", 0, 10'000, 10'000}, Case{"stale_state", 0, 0, 0},
                          Case{"ok", 10'000, 10'000, 10'000}, Case{"ok", 10'000, 10'019, 10'019},
                          Case{"stale_state", 10'000, 10'021, 10'021}, Case{"stale_state", 10'060, 10'050, 10'050},
                          Case{"stale_request", 10'020, 10'000, 10'021}, Case{"stale_request", 10'000, 10'001, 10'000},
                          Case{"stale_request", 10'000, 0, 10'000}, Case{"stale_state", 10'000, 3'000, 3'000}}) {
    CAPTURE(now.state_ms);
    CAPTURE(now.request_ms);
    Certain core;
    core.set_motion({}, 1'000'000 * now.state_ms);
    const Answer answer = core.answer(none, none, 1'000'000 * now.request_ms, 1'000'000 * now.now_ms);
    CHECK(std::string(answer.status) == now.status);
    CHECK(answer.has_commands == (std::string(now.status) == "ok"));
    CHECK(std::isnan(answer.commands[0]) != answer.has_commands);
    CHECK(std::isnan(answer.beyond_envelope) != answer.has_commands);
  }
  Settings longer;
  longer.state_age_limit_s = 0.5;
  Certain core(longer);
  core.set_motion({}, second_ns);
  CHECK(core.answer(none, none, second_ns + 400'000'000, second_ns + 400'000'000).has_commands);
}

TEST_CASE("ros2: NaN and motions beyond the training flights are refused, with the reason") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(std::string(asked({nan, 0, 0}, none).status) == "not_finite");
  Certain core;
  Motion motion;
  motion.attitude = {2, 0, 0, 0};
  core.set_motion(motion, second_ns);
  CHECK(std::string(core.answer(none, none, second_ns, second_ns).status) == "not_unit_quaternion");
  const Answer beyond = asked(none, {0, 1e3f, 0});
  CHECK(std::string(beyond.status) == "outside_envelope");
  CHECK(std::string(beyond.worst_feature) == "wdot_y");
  CHECK(beyond.beyond_envelope > 1);
  const Answer inside = asked(none, none);
  CHECK(inside.beyond_envelope == 0);
  CHECK(std::string(inside.worst_feature).empty());
}

TEST_CASE("ros2: commands beyond 0 to 1 are clipped or refused, as the settings say") {
  const Answer clipped = asked(strong, turning);
  REQUIRE(std::string(clipped.status) == "limited");
  CHECK(clipped.has_commands);
  for (const float command : clipped.commands) CHECK(command <= 1);
  Settings refuse;
  refuse.clips = false;
  const Answer refused = asked(strong, turning, refuse);
  CHECK(std::string(refused.status) == "outside_limits");
  for (const float command : refused.commands) CHECK(std::isnan(command));
  CHECK(asked(none, none, refuse).has_commands);
}

TEST_CASE("ros2: with limits of trust the distance to the training flights is told and holds") {
  CHECK(std::isnan(asked(none, none).squared_distance));
  const Answer near = asked<Trusting>(none, none);
  CHECK(std::string(near.status) == "ok");
  CHECK(near.squared_distance > 0);
  const Answer far = asked<Trusting>(strong, turning);
  CHECK(std::string(far.status) == "outside_distribution");
  CHECK(far.squared_distance > static_cast<float>(StrictTrust::squared_distance_limit));
  CHECK(far.beyond_envelope == 0);
}

}  // namespace
