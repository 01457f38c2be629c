// SPDX-License-Identifier: MIT
// Both glues with a model of a window and of the battery voltage: the voltage comes from PX4's battery_status and from
// the Crazyflie's pm.
#include <doctest/doctest.h>

#include <cmath>
#include <csetjmp>
#include <cstring>

#include "core_log.h"
#include "crazyflie/block_room.hpp"
#include "crazyflie/firmware.h"
#include "model_blocks.hpp"
#include "pinnquad/control/autopilot/inputs.hpp"
#include "world.hpp"

namespace {

using namespace pinnquad::autopilot::test;
using pinnquad::Status;
using pinnquad::autopilot::voltage_bit;

std::uint32_t tick_ms = 1000;
float battery_V = 3.9f;
std::jmp_buf app_waits;
CrazyflieCoreRecord logged{};

/// The network's own status in a step that was logged.
template <class Record>
Status cause_of(const Record& record) {
  return static_cast<Status>(record.cause);
}

}  // namespace

extern "C" {
uint32_t xTaskGetTickCount(void) { return tick_ms; }
float pmGetBatteryVoltage(void) { return battery_V; }
uint64_t usecTimestamp(void) { return std::uint64_t{tick_ms} * 1000; }
void eventTrigger(const eventtrigger* event) {
  if (std::strcmp(event->name, "pinnquad_record") == 0) std::memcpy(&logged, event->payload, sizeof logged);
}
void vTaskDelay(uint32_t) { std::longjmp(app_waits, 1); }
bool supervisorIsFlying(void) { return true; }
bool supervisorAreMotorsAllowedToRun(void) { return true; }
void controllerPidInit(void) {}
bool controllerPidTest(void) { return true; }
void controllerPid(control_t*, const setpoint_t*, const sensorData_t*, const state_t*, stabilizerStep_t) {}
}

TEST_CASE("PX4: the voltage of battery_status, while the battery is connected and its voltage known") {
  Px4World world;
  world.start_and_fly();
  uORB::Subscription record_sub{ORB_ID(pinnquad_record)};
  uORB::Publication<battery_status_s> battery{ORB_ID(battery_status)};
  pinnquad_record_s record{};
  const auto after = [&](int ms, bool connected, float volts) {
    for (int i = 0; i < ms; i += 200) {
      battery.publish({World::now_us, connected, -1, volts});
      world.run(200);
    }
    REQUIRE(record_sub.update(&record));
    return cause_of(record);
  };
  CHECK(after(400, false, 15.5f) == Status::not_finite);
  CHECK(record.stale_inputs == voltage_bit);
  CHECK(after(400, true, 0) == Status::not_finite);
  CHECK(after(400, true, 15.5f) == Status::ok);
  CHECK(record.battery_voltage == 15.5f);
  CHECK(World::now_us - record.voltage_us == 200'000);
  CHECK(record.stale_inputs == 0);
  CHECK(world.last.control[0] > 0.3f);
  CHECK(after(1800, false, 15.5f) == Status::ok);
  CHECK(after(400, false, 15.5f) == Status::not_finite);
}

TEST_CASE("Crazyflie: the voltage of pm, in every step") {
  const Block block = sound_block<TrainedQuadModel>();
  REQUIRE(block.size() <= 32768);
  std::memcpy(pinnquad_model_block, block.data(), block.size());
  if (setjmp(app_waits) == 0) appMain();
  controllerOutOfTreeInit();
  setpoint_t setpoint{};
  setpoint.mode.x = setpoint.mode.y = setpoint.mode.z = setpoint.mode.yaw = modeAbs;
  sensorData_t sensors{};
  state_t state{};
  state.attitudeQuaternion.w = 1;
  control_t control{};
  const auto run = [&](int ms) {
    for (int i = 0; i < ms; ++i) {
      ++tick_ms;
      sensors.interruptTimestamp = std::uint64_t{tick_ms} * 1000;
      state.attitude.timestamp = state.position.timestamp = setpoint.timestamp = tick_ms;
      controllerOutOfTree(&control, &setpoint, &sensors, &state, tick_ms);
    }
    return cause_of(logged);
  };
  CHECK(run(100) == Status::warming_up);
  CHECK(run(100) == Status::ok);
  CHECK(float{logged.battery_voltage} == 3.9f);
  CHECK(tick_ms - std::uint32_t{logged.voltage_ms} < 2);
  CHECK(control.controlMode == controlModeForce);
  battery_V = 0;
  CHECK(run(1900) == Status::ok);
  CHECK(run(200) == Status::not_finite);
  CHECK(unsigned{logged.stale_inputs} == voltage_bit);
  CHECK(control.controlMode == controlModeForce);
  battery_V = 3.8f;
  CHECK(run(20) == Status::warming_up);
  CHECK(run(200) == Status::ok);
}
