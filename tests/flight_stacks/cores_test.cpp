// SPDX-License-Identifier: MIT
// The cores of the example modules, message by message: frames, units, motor order, what is refused, what is stale.
#include <doctest/doctest.h>

#include <chrono>
#include <cstring>
#include <random>
#include <thread>

#include "model_blocks.hpp"
#include "stacks.hpp"

namespace {

using namespace pinnquad::autopilot::test;
using pinnquad::Status;
using pinnquad::autopilot::Reaction;

constexpr float not_asked = std::numeric_limits<float>::quiet_NaN();
std::uint64_t clock_us = 0;
std::uint64_t test_clock() { return clock_us; }

using Px4Core = pinnquad_px4::NeuralControl<DemoQuadModel>;
using CrazyflieCore = pinnquad_crazyflie::NeuralControl<CrazyflieModel>;

struct Px4 {
  const Block block = sound_block<DemoQuadModel>();
  Px4Core core{&test_clock};
  pinnquad_px4::VehicleAngularVelocity rates;
  pinnquad_px4::VehicleAttitude attitude;
  pinnquad_px4::VehicleLocalPosition local;
  pinnquad_px4::TrajectorySetpoint set_point;
  pinnquad_px4::ActuatorMotors motors;
  pinnquad_px4::PinnquadStatus status;

  Px4() {
    local.xy_valid = local.z_valid = local.v_xy_valid = local.v_z_valid = true;
    set_point.yaw = not_asked;
    REQUIRE(core.offer_model(block.data(), block.size()) == Status::ok);
  }
  bool run(std::uint64_t now_us = 1'000'000) {
    clock_us = now_us;
    rates.timestamp_sample = attitude.timestamp_sample = local.timestamp_sample = set_point.timestamp = now_us;
    static_cast<void>(core.take(rates));
    static_cast<void>(core.take(attitude));
    static_cast<void>(core.take(local));
    static_cast<void>(core.take(set_point));
    return core.run(motors, status);
  }
  Reaction reaction() const { return static_cast<Reaction>(status.reaction); }
};

struct Crazyflie {
  const Block block = sound_block<CrazyflieModel>();
  CrazyflieCore core;
  CrazyflieState state{};
  CrazyflieSetpoint set_point{};
  CrazyflieReport report{};
  float m[4]{};

  Crazyflie() {
    state.attitude_quaternion[3] = 1;
    for (std::uint8_t& mode : set_point.mode) mode = crazyflie_mode_abs;
    set_point.mode_yaw = crazyflie_mode_abs;
    REQUIRE(core.offer_model(block.data(), block.size()) == Status::ok);
  }
  bool step(std::uint32_t now_ms = 1000) {
    state.gyro_timestamp = state.attitude_timestamp = state.position_timestamp = set_point.timestamp = now_ms;
    return core.step(now_ms, state, set_point, m, report);
  }
};

}  // namespace

TEST_CASE("PX4: at rest on its set point the vehicle hovers") {
  Px4 px4;
  REQUIRE(px4.run());
  CHECK(px4.reaction() == Reaction::flies);
  const auto airframe = pinnquad::airframe_value<pinnquad::PaperQuadrotor, double>();
  for (const float u : px4.motors.control) CHECK(u == doctest::Approx(1 / airframe.thrust_to_weight()).epsilon(0.05));
  CHECK(px4.motors.timestamp == 1'000'000);
}

TEST_CASE(
    "PX4: each error is answered by the motors that mend it; 1 front right, 2 rear left, 3 front left, 4 rear right") {
  Px4 px4;
  const float* u = px4.motors.control;
  SUBCASE("rolled right: the right rotors lift") {
    px4.attitude.q[0] = std::cos(0.1f), px4.attitude.q[1] = std::sin(0.1f);
    REQUIRE(px4.run());
    CHECK(u[0] + u[3] > u[1] + u[2] + 0.02f);
  }
  SUBCASE("nose up: the rear rotors lift") {
    px4.attitude.q[0] = std::cos(0.1f), px4.attitude.q[2] = std::sin(0.1f);
    REQUIRE(px4.run());
    CHECK(u[1] + u[3] > u[0] + u[2] + 0.02f);
  }
  SUBCASE("turning right: the rotors that turn clockwise push left") {
    px4.rates.xyz[2] = 0.3f;
    REQUIRE(px4.run());
    CHECK(u[2] + u[3] > u[0] + u[1] + 0.02f);
  }
  SUBCASE("below its place: all lift") {
    px4.local.z = 0.5f;
    REQUIRE(px4.run());
    CHECK(u[0] + u[1] + u[2] + u[3] > 4 * 0.55f);
  }
  SUBCASE("place to the north: the rear rotors lift, the nose goes down") {
    px4.set_point.position[0] = 0.5f;
    REQUIRE(px4.run());
    CHECK(u[1] + u[3] > u[0] + u[2] + 0.02f);
  }
  SUBCASE("an acceleration to the east alone: the left rotors lift") {
    for (int i = 0; i < 3; ++i) px4.set_point.position[i] = px4.set_point.velocity[i] = not_asked;
    px4.set_point.acceleration[1] = 2;
    REQUIRE(px4.run());
    CHECK(u[1] + u[2] > u[0] + u[3] + 0.02f);
  }
}

TEST_CASE("PX4: without a model nothing is commanded; a refused sample is counted, the good one before it flies on") {
  Px4Core empty(&test_clock);
  pinnquad_px4::ActuatorMotors motors;
  pinnquad_px4::PinnquadStatus status;
  CHECK_FALSE(empty.ready());
  CHECK_FALSE(empty.run(motors, status));
  CHECK(motors.timestamp == 0);

  Px4 px4;
  REQUIRE(px4.run());
  px4.attitude.q[2] = not_asked;
  px4.local.v_xy_valid = false;
  CHECK(px4.core.take(px4.attitude) == Status::not_finite);
  CHECK(px4.core.take(px4.local) == Status::out_of_range);
  px4.attitude.q[2] = 0.5f;
  CHECK(px4.core.take(px4.attitude) == Status::not_unit_quaternion);
  px4.rates.xyz[0] = 1e30f;
  CHECK(px4.core.take(px4.rates) == Status::out_of_range);
  for (int i = 0; i < 3; ++i) {
    px4.set_point.position[i] = px4.set_point.velocity[i] = px4.set_point.acceleration[i] = not_asked;
  }
  CHECK(px4.core.take(px4.set_point) == Status::not_finite);
  CHECK(px4.core.run(px4.motors, px4.status));
  CHECK(px4.reaction() == Reaction::flies);
  CHECK(px4.status.refused_samples == 4);
}

TEST_CASE("PX4: a model that is refused changes no bit of what flies; one that is accepted does") {
  Px4 px4;
  px4.set_point.position[0] = 0.5f;
  REQUIRE(px4.run());
  const pinnquad_px4::ActuatorMotors before = px4.motors;
  const auto same_commands = [&] {
    REQUIRE(px4.run());
    return std::memcmp(px4.motors.control, before.control, sizeof before.control) == 0;
  };
  CHECK(same_commands());
  const Block corrupt = corrupt_block<DemoQuadModel>(), wrong = wrong_block<DemoQuadModel>();
  CHECK(px4.core.offer_model(corrupt.data(), corrupt.size()) == Status::block_corrupt);
  CHECK(same_commands());
  CHECK(px4.core.offer_model(wrong.data(), wrong.size()) == Status::self_test_failed);
  CHECK(same_commands());
  CHECK(static_cast<Status>(px4.status.status) == Status::ok);
  const Block other = other_block<DemoQuadModel>();
  CHECK(px4.core.offer_model(other.data(), other.size()) == Status::ok);
  CHECK_FALSE(px4.core.model_settled());
  CHECK(px4.core.offer_model(other.data(), other.size()) == Status::out_of_range);  // the last one is not yet taken
  CHECK_FALSE(same_commands());
  CHECK(px4.core.model_settled());
}

TEST_CASE("PX4: silence, step by step: holds, levels, keeps, gives up") {
  const auto last_at = [](std::uint64_t rates_age, std::uint64_t attitude_age, std::uint64_t local_age,
                          std::uint64_t set_point_age) {
    Px4 px4;
    REQUIRE(px4.run(10'000'000));
    const std::uint64_t now_us = 20'000'000;
    px4.rates.timestamp_sample = now_us - rates_age;
    px4.attitude.timestamp_sample = now_us - attitude_age;
    px4.local.timestamp_sample = now_us - local_age;
    px4.set_point.timestamp = now_us - set_point_age;
    CHECK(px4.core.take(px4.rates) == Status::ok);
    CHECK(px4.core.take(px4.attitude) == Status::ok);
    CHECK(px4.core.take(px4.local) == Status::ok);
    CHECK(px4.core.take(px4.set_point) == Status::ok);
    clock_us = now_us;
    static_cast<void>(px4.core.run(px4.motors, px4.status));
    return px4.reaction();
  };
  const pinnquad::autopilot::CoreSettings limits;
  const std::uint64_t longest_us = limits.local_us + limits.level_us;
  CHECK(last_at(limits.body_rates_us, limits.attitude_us, limits.local_us, limits.set_point_us) == Reaction::flies);
  CHECK(last_at(0, 0, 0, limits.set_point_us + 1) == Reaction::holds_position);
  CHECK(last_at(0, 0, limits.local_us + 1, limits.set_point_us + 1) == Reaction::levels);
  CHECK(last_at(0, 0, longest_us, 0) == Reaction::levels);
  CHECK(last_at(0, 0, longest_us + 1, 0) == Reaction::gives_up);
  CHECK(last_at(limits.body_rates_us + 1, 0, 0, 0) == Reaction::gives_up);  // its last commands are 10 s old
  CHECK(last_at(0, limits.attitude_us + 1, 0, 0) == Reaction::gives_up);
  CHECK(last_at(0, 0, static_cast<std::uint64_t>(-1), 0) == Reaction::gives_up);  // a stamp of the future
}

TEST_CASE(
    "Crazyflie: each error is answered by the motors that mend it; M1 front right, M2 rear right, M3 rear left, M4 "
    "front left") {
  Crazyflie cf;
  const float* m = cf.m;
  SUBCASE("at rest on its set point: hovers") {
    REQUIRE(cf.step());
    for (int i = 0; i < 4; ++i) CHECK(m[i] == doctest::Approx(1 / 2.25).epsilon(0.06));
  }
  SUBCASE("rolled right: the right motors lift") {
    cf.state.attitude_quaternion[0] = std::sin(0.2f), cf.state.attitude_quaternion[3] = std::cos(0.2f);
    REQUIRE(cf.step());
    CHECK(m[0] + m[1] > m[2] + m[3] + 0.02f);
  }
  SUBCASE("nose down: the front motors lift") {
    cf.state.attitude_quaternion[1] = std::sin(0.2f), cf.state.attitude_quaternion[3] = std::cos(0.2f);
    REQUIRE(cf.step());
    CHECK(m[0] + m[3] > m[1] + m[2] + 0.02f);
  }
  SUBCASE("pitching up at 100 deg/s: the rear motors lift") {
    cf.state.gyro[1] = -100;
    REQUIRE(cf.step());
    CHECK(m[1] + m[2] > m[0] + m[3] + 0.02f);
  }
  SUBCASE("yaw wanted to the left: the motors that turn clockwise push left") {
    cf.set_point.yaw = 40;
    REQUIRE(cf.step());
    CHECK(m[1] + m[3] > m[0] + m[2] + 0.005f);
  }
  SUBCASE("turning to the left asked at a rate: the same") {
    cf.set_point.mode_yaw = crazyflie_mode_velocity;
    cf.set_point.yaw_rate = 60;
    REQUIRE(cf.step());
    CHECK(m[1] + m[3] > m[0] + m[2] + 0.005f);
  }
  SUBCASE("place ahead: the rear motors lift") {
    cf.set_point.position[0] = 1;
    REQUIRE(cf.step());
    CHECK(m[1] + m[2] > m[0] + m[3] + 0.02f);
  }
  SUBCASE("velocity to the left, in the body, nose to the left (y): the world's -x; the right motors lift") {
    const float half = std::sqrt(0.5f);
    cf.state.attitude_quaternion[2] = cf.state.attitude_quaternion[3] = half;
    cf.set_point.yaw = 90;
    for (std::uint8_t& mode : cf.set_point.mode) mode = crazyflie_mode_velocity;
    cf.set_point.velocity_body = true;
    cf.set_point.velocity[1] = 1;
    REQUIRE(cf.step());
    CHECK(m[0] + m[1] > m[2] + m[3] + 0.02f);
  }
  SUBCASE("off, or flown by hand: not this controller's") {
    for (std::uint8_t& mode : cf.set_point.mode) mode = crazyflie_mode_disable;
    CHECK_FALSE(cf.step());
    for (int i = 0; i < 4; ++i) CHECK(m[i] == 0);
  }
}

TEST_CASE("whatever comes in, what goes out is a command within its limits") {
  std::mt19937 engine(11);
  const auto hostile = [&engine](float usual) {
    const auto bits = static_cast<std::uint32_t>(engine());
    if (bits % 8 != 0) return usual + 1e-3f * static_cast<float>(bits % 2001) - 1.0f;
    float value = 0;
    const auto any = static_cast<std::uint32_t>(engine());
    std::memcpy(&value, &any, sizeof value);
    return value;
  };
  Px4 px4;
  Crazyflie cf;
  const pinnquad::autopilot::CoreSettings limits;
  int px4_answers = 0, cf_answers = 0;
  for (std::uint64_t tick = 0; tick < 30'000; ++tick) {
    for (float& v : px4.rates.xyz) v = hostile(0);
    px4.attitude.q[0] = engine() % 64 == 0 ? hostile(1) : 1;
    for (float* v : {&px4.local.x, &px4.local.y, &px4.local.z, &px4.local.vx, &px4.local.vy, &px4.local.vz})
      *v = hostile(0);
    for (float* v : {px4.set_point.position, px4.set_point.velocity, px4.set_point.acceleration, px4.set_point.jerk}) {
      for (int i = 0; i < 3; ++i) v[i] = hostile(0);
    }
    px4.set_point.yaw = hostile(0);
    px4.set_point.yawspeed = hostile(0);
    if (px4.run(10'000'000 + 1000 * tick)) {
      ++px4_answers;
      bool sound = true;
      for (const float u : px4.motors.control) sound &= u >= limits.lowest_command && u <= limits.highest_command;
      REQUIRE(sound);
    }
    for (float& v : cf.state.gyro) v = hostile(0);
    for (float& v : cf.state.position) v = hostile(0);
    for (float& v : cf.state.velocity) v = hostile(0);
    for (float* v : {cf.set_point.position, cf.set_point.velocity, cf.set_point.acceleration}) {
      for (int i = 0; i < 3; ++i) v[i] = hostile(0);
    }
    cf.set_point.yaw = hostile(0);
    cf.set_point.yaw_rate = hostile(0);
    if (cf.step(static_cast<std::uint32_t>(10'000 + 2 * tick))) {
      ++cf_answers;
      bool sound = true;
      for (const float u : cf.m) sound &= u >= limits.lowest_command && u <= limits.highest_command;
      REQUIRE(sound);
    }
  }
  CHECK(px4_answers > 15'000);
  CHECK(cf_answers > 15'000);
  CHECK(px4.status.refused_samples > 3'000);
}

TEST_CASE("another thread changes models while the module flies: each answer is one model's, whole") {
  Px4 px4;
  px4.set_point.position[0] = 0.5f;
  using Control = std::array<float, 4>;
  const auto control = [&px4] {
    Control u{};
    REQUIRE(px4.run());
    std::memcpy(u.data(), px4.motors.control, sizeof u);
    return u;
  };
  const Block first = sound_block<DemoQuadModel>(), other = other_block<DemoQuadModel>();
  const Control of_first = control();
  REQUIRE(px4.core.offer_model(other.data(), other.size()) == Status::ok);
  const Control of_other = control();
  REQUIRE(of_first != of_other);

  std::atomic<bool> over{false};
  int swaps = 0, refused = 0;
  std::thread loader([&] {
    while (!over.load()) {
      const Block& next = swaps % 2 == 0 ? first : other;
      const Status status = px4.core.offer_model(next.data(), next.size());
      if (status == Status::ok) ++swaps;
      if (status != Status::ok && status != Status::out_of_range) ++refused;
    }
  });
  int by_first = 0, by_other = 0, by_neither = 0;
  for (const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(300);
       std::chrono::steady_clock::now() < end || by_first == 0 || by_other == 0;) {
    const Control u = control();
    ++(u == of_first ? by_first : u == of_other ? by_other : by_neither);
  }
  over = true;
  loader.join();
  MESSAGE(swaps, " swaps, ", by_first, " answers of the first model, ", by_other, " of the other");
  CHECK(by_neither == 0);
  CHECK(refused == 0);
  CHECK(swaps >= 2);
}
