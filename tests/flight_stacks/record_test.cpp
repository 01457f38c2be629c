// SPDX-License-Identifier: MIT
// Records of a core (pinnquad/control/autopilot/core_record.hpp): the messages have its numbers, a recorded core
// answers as any other, inputs are there as they came, refused ones too.
#include <doctest/doctest.h>

#include <cstring>
#include <random>
#include <sstream>

#include "model_blocks.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/core/rotation.hpp"
#include "record_csv.hpp"
#include "stacks.hpp"

namespace {

using namespace pinnquad::autopilot::test;
using pinnquad::Status;
using pinnquad::autopilot::CoreRecord;
using pinnquad::autopilot::CoreSettings;
using pinnquad::autopilot::Reaction;

std::uint64_t clock_us = 0;
std::uint64_t test_clock() { return clock_us; }

template <class Number>
std::string type_name() {
  return std::is_floating_point_v<Number>
             ? "float" + std::to_string(8 * sizeof(Number))
             : (std::is_signed_v<Number> ? "int" : "uint") + std::to_string(8 * sizeof(Number));
}

/// "uint64 timestamp", "float32[3] position_m", ...: of the record.
template <class Record>
std::vector<std::string> fields() {
  std::vector<std::string> all;
  const Record record{};
  Record::each_number(record, [&all](const char* name, const char*, const auto& value) {
    using Value = std::remove_reference_t<decltype(value)>;
    using Number = std::remove_cv_t<std::remove_all_extents_t<std::remove_cv_t<Value>>>;
    const std::string count = std::is_array_v<Value> ? "[" + std::to_string(std::extent_v<Value>) + "]" : "";
    all.push_back(type_name<Number>() + count + " " + name);
  });
  return all;
}

/// Of a PX4 message.
std::vector<std::string> fields(const std::string& file) {
  std::ifstream text(std::string(PINNQUAD_PX4_MESSAGES) + "/" + file);
  REQUIRE(text.good());
  std::vector<std::string> all;
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string type, name;
    if (!(words >> type >> name)) continue;
    CAPTURE(name);
    // what PX4's generator takes: small letters, digits, single underscores
    CHECK(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos);
    CHECK(name.find("__") == std::string::npos);
    all.push_back(type + " " + name);
  }
  return all;
}

using Recording =
    pinnquad_px4::NeuralControl<DemoQuadModel,
                                pinnquad::autopilot::Recorded<pinnquad::autopilot::NeuralController<DemoQuadModel>>>;
using Plain = pinnquad_px4::NeuralControl<DemoQuadModel>;

}  // namespace

TEST_CASE("PX4's messages have the numbers of the records, in their order") {
  CHECK(fields("PinnquadRecord.msg") == fields<CoreRecord>());
  CHECK(fields("PinnquadSettings.msg") == fields<CoreSettings>());
}

TEST_CASE("a recorded core answers as a plain one, and its record says what it answered") {
  const Block block = sound_block<DemoQuadModel>();
  Recording recorded(&test_clock);
  Plain plain(&test_clock);
  REQUIRE(recorded.offer_model(block.data(), block.size()) == Status::ok);
  REQUIRE(plain.offer_model(block.data(), block.size()) == Status::ok);
  std::mt19937_64 engine(3);
  const auto draw = [&engine](double half) { return static_cast<float>(pinnquad::uniform(engine, -half, half)); };
  const std::uint32_t checksum = pinnquad::crc32(block.data(), block.size() - 4);
  for (std::uint32_t tick = 1; tick <= 2000; ++tick) {
    clock_us = 1'000'000 + 1000 * tick;
    pinnquad_px4::VehicleAngularVelocity rates;
    pinnquad_px4::VehicleAttitude attitude;
    pinnquad_px4::VehicleLocalPosition local;
    pinnquad_px4::TrajectorySetpoint wanted;
    rates.timestamp_sample = attitude.timestamp_sample = local.timestamp_sample = wanted.timestamp = clock_us;
    local.xy_valid = local.z_valid = local.v_xy_valid = local.v_z_valid = true;
    for (float& w : rates.xyz) w = draw(4);
    if (tick % 7 == 0) rates.xyz[1] = std::numeric_limits<float>::quiet_NaN();
    const auto turned = pinnquad::from_euler<float>({draw(0.6), draw(0.6), draw(3)});
    attitude.q[0] = turned.w, attitude.q[1] = turned.x, attitude.q[2] = turned.y, attitude.q[3] = turned.z;
    local.x = draw(2), local.y = draw(2), local.z = draw(2);
    wanted.position[0] = draw(3);
    unsigned came = 0;
    const auto take = [&](const auto& message, unsigned bit, bool now) {
      if (!now) return;
      came |= bit;
      CHECK(recorded.take(message) == plain.take(message));
    };
    take(rates, pinnquad::autopilot::body_rates_bit, tick % 3 != 0);
    take(attitude, pinnquad::autopilot::attitude_bit, tick % 5 != 0);
    take(local, pinnquad::autopilot::local_bit, tick % 200 < 50);
    take(wanted, pinnquad::autopilot::set_point_bit, tick % 900 < 300);
    pinnquad_px4::ActuatorMotors motors, others;
    pinnquad_px4::PinnquadStatus status, other;
    const bool has_commands = recorded.run(motors, status);
    REQUIRE(plain.run(others, other) == has_commands);
    const CoreRecord& record = recorded.controller().record();
    CHECK(record.timestamp == clock_us);
    CHECK(record.tick == tick);
    CHECK(record.came == came);
    CHECK(record.model == checksum);
    CHECK(record.asked == 1);
    CHECK(record.reaction == other.reaction);
    CHECK(record.status == other.status);
    CHECK(record.cause == other.cause);
    CHECK(record.stale_inputs == other.stale_inputs);
    CHECK(record.refused_samples == other.refused_samples);
    CHECK(record.envelope_feature == other.envelope_feature);
    CHECK(record.bias_status == other.bias_status);
    CHECK(std::memcmp(&record.envelope_excess, &other.envelope_excess, sizeof(float)) == 0);
    if (has_commands) {
      CHECK(std::memcmp(motors.control, others.control, sizeof motors.control) == 0);
      CHECK(std::memcmp(record.commands, others.control, sizeof record.commands) == 0);
    } else {
      CHECK(pinnquad::is_finite(record.commands[0]) == false);
    }
    if ((came & pinnquad::autopilot::body_rates_bit) != 0) {
      CHECK(record.body_rates_us == clock_us);
      CHECK(std::memcmp(record.body_rates_rad_s, rates.xyz, sizeof rates.xyz) == 0);  // NaN too
    }
    if ((came & pinnquad::autopilot::attitude_bit) != 0) {
      CHECK(std::memcmp(record.attitude, attitude.q, sizeof attitude.q) == 0);
    }
    if ((came & pinnquad::autopilot::local_bit) != 0) CHECK(record.position_m[0] == local.x);
    if ((came & pinnquad::autopilot::set_point_bit) != 0) CHECK(record.wanted_position_m[0] == wanted.position[0]);
  }
}

TEST_CASE("a record names the model that flew, from the tick that took it") {
  const Block first = sound_block<DemoQuadModel>(), second = other_block<DemoQuadModel>();
  const Block corrupt = corrupt_block<DemoQuadModel>(), wrong = wrong_block<DemoQuadModel>();
  const auto checksum = [](const Block& block) { return pinnquad::crc32(block.data(), block.size() - 4); };
  Recording core(&test_clock);
  pinnquad_px4::ActuatorMotors motors;
  pinnquad_px4::PinnquadStatus status;
  const auto flown = [&] {
    static_cast<void>(core.run(motors, status));
    return core.controller().record().model;
  };
  CHECK(flown() == 0);
  REQUIRE(core.offer_model(first.data(), first.size()) == Status::ok);
  CHECK(flown() == checksum(first));
  REQUIRE(core.offer_model(corrupt.data(), corrupt.size()) == Status::block_corrupt);
  REQUIRE(core.offer_model(wrong.data(), wrong.size()) == Status::self_test_failed);
  CHECK(flown() == checksum(first));
  REQUIRE(core.offer_model(second.data(), second.size()) == Status::ok);
  CHECK(core.controller().record().model == checksum(first));
  CHECK(flown() == checksum(second));
  REQUIRE(core.offer_model(first.data(), first.size()) == Status::ok);
  CHECK(flown() == checksum(first));
}

TEST_CASE("flown by hand nothing is asked, and the record says so") {
  CrazyflieStack stack;
  const Block block = sound_block<CrazyflieModel>();
  REQUIRE(stack.offer(block.data(), block.size()) == Status::ok);
  stack.set_point(1'000'000, {});
  static_cast<void>(stack.run(1'000'000));
  CHECK(stack.record().asked == 1);
  CHECK(stack.record().tick == 1);
  stack.fly_by_hand(true);
  CHECK_FALSE(stack.run(1'002'000).has_commands);
  CHECK(stack.record().asked == 0);
  CHECK(stack.record().tick == 2);
  CHECK(stack.record().came == 0);
  CHECK(static_cast<Reaction>(stack.record().reaction) == Reaction::gives_up);
}

TEST_CASE("settings are those that the controller was made with") {
  CoreSettings made;
  made.attitude_us = 12'000;
  made.lowest_command = 0.1f;
  made.highest_command = 0.9f;
  made.tilt_1_s = 7;
  const pinnquad::autopilot::NeuralController<DemoQuadModel> controller(made);
  const CoreSettings settings = controller.settings();
  CHECK(settings.attitude_us == 12'000);
  CHECK(settings.body_rates_us == 10'000);
  CHECK(settings.lowest_command == 0.1f);
  CHECK(settings.highest_command == 0.9f);
  CHECK(settings.tilt_1_s == 7);
  CHECK(settings.position_1_s == pinnquad::FlightGains<float>{}.position_1_s);
}
