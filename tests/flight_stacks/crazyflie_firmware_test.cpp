// SPDX-License-Identifier: MIT
// The Crazyflie app's own glue (examples/crazyflie_app/src/out_of_tree_controller.c), flown by a stand-in of the
// firmware's stabilizer loop: time stamps as each estimator sets them, the PID controller's output held between its
// slower steps, forces clipped motor by motor over the platform's greatest thrust, the supervisor's rule of who is
// flying.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <deque>
#include <fstream>
#include <string>
#include <vector>

#include "core_log.h"
#include "crazyflie/block_room.hpp"
#include "crazyflie/firmware.h"
#include "model_blocks.hpp"
#include "models/crazyflie_2_1.hpp"
#include "pinnquad/control/autopilot/inputs.hpp"
#include "pinnquad/core/rotation.hpp"
#include "pinnquad/flight.hpp"

namespace {

using namespace pinnquad::autopilot::test;
using pinnquad::Vector3;

enum class Estimator { kalman, complementary, ukf };

std::uint32_t tick_ms = 0;
float battery_V = 3.9f;

/// The firmware calls it flying until 2 s have passed since any motor turned above the idle thrust, which is 0 on this
/// platform. It looks at the motors 25 times a second.
struct Supervisor {
  std::uint32_t above_idle_ms = 0;
  bool flying = false;

  void update(const control_t& control, std::uint32_t step) {
    if (step % 40 != 0) return;
    bool above_idle = control.controlMode == controlModeLegacy && control.thrust > 0;
    for (const float force : control.normalizedForces) {
      above_idle = above_idle || (control.controlMode == controlModeForce && 65535 * force >= 1);
    }
    if (above_idle) above_idle_ms = tick_ms;
    flying = above_idle_ms != 0 && tick_ms - above_idle_ms < 2000;
  }
} supervisor;
std::jmp_buf app_waits;

/// Of the PID controller: an integrator, so that a cold one is not a warm one, written at 500 Hz as the firmware's is.
struct Pid {
  long steps = 0;
  float integral = 0;
} pid, twin;

/// Without a height to hold its thrust is the pilot's.
void step_pid(Pid& of, control_t* control, const setpoint_t* setpoint, const state_t* state, stabilizerStep_t step) {
  ++of.steps;
  control->controlMode = controlModeLegacy;
  if (step % 2 != 0) return;  // what was written stays
  of.integral += 0.1f * (1.0f - state->position.z);
  control->roll = static_cast<std::int16_t>(7 + of.integral);
  control->pitch = 8;
  control->yaw = 9;
  control->thrust = setpoint->mode.z == modeDisable ? setpoint->thrust : 30000 + of.integral;
}

/// A uSD card as the deck driver writes it, of the events that config.txt names: a head that says their variables,
/// then each with its time, then a checksum.
class Card {
 public:
  void trigger(const eventtrigger& event) {
    std::size_t id = 0;
    while (id < events_.size() && events_[id] != &event) ++id;
    if (id == events_.size()) events_.push_back(&event);
    add(body_, static_cast<std::uint16_t>(id));
    add(body_, std::uint64_t{tick_ms} * 1000);
    body_.append(static_cast<const char*>(event.payload), event.payloadSize);
    ++count_;
  }
  void clear() { events_.clear(), body_.clear(), count_ = 0; }
  int count() const { return count_; }

  std::string file() const {
    static constexpr char letter[] = "?BHIbhif";
    static constexpr unsigned size[] = {0, 1, 2, 4, 1, 2, 4, 4};
    std::string text = "\xbc";
    add(text, std::uint16_t{2});
    add(text, static_cast<std::uint16_t>(events_.size()));
    for (std::size_t id = 0; id < events_.size(); ++id) {
      const eventtrigger& event = *events_[id];
      add(text, static_cast<std::uint16_t>(id));
      text += event.name + std::string(1, '\0');
      add(text, std::uint16_t{event.numPayloadVariables});
      unsigned bytes = 0;
      for (int i = 0; i < event.numPayloadVariables; ++i) {
        const eventtriggerPayloadDesc& variable = event.payloadDesc[i];
        text += std::string(variable.name) + "(" + letter[variable.type] + ")" + std::string(1, '\0');
        bytes += size[variable.type];
      }
      CHECK(bytes == event.payloadSize);  // packed as it is described
    }
    text += body_;
    add(text, pinnquad::crc32(reinterpret_cast<const unsigned char*>(text.data()), text.size()));
    return text;
  }

 private:
  template <class Number>
  static void add(std::string& to, Number number) {
    for (std::size_t i = 0; i < sizeof number; ++i) to += static_cast<char>(number >> (8 * i) & 0xffu);
  }

  std::vector<const eventtrigger*> events_;
  std::string body_;
  int count_ = 0;
} card;

/// The stabilizer's loop around the app, and the vehicle.
class Firmware {
 public:
  using Vehicle = pinnquad::Quadrotor<double, pinnquad::QuadraticDrag>;
  using Model = CrazyflieModel;

  /// In the air another controller has flown it until now; else it has stood for long.
  explicit Firmware(Estimator estimator, bool in_the_air = true)
      : estimator_(estimator), vehicle_(pinnquad::airframe_value<Model::Vehicle, double>()) {
    static bool booted = false;  // the app has one controller, in static memory
    if (!booted) {
      const Block block = sound_block<Model>();
      REQUIRE(block.size() <= 32768);
      std::memcpy(pinnquad_model_block, block.data(), block.size());
      controllerOutOfTreeInit();
      REQUIRE(controllerOutOfTreeTest());
      if (setjmp(app_waits) == 0) appMain();
      booted = true;
    }
    tick_ms += 100'000;  // whatever came before is stale
    pid = twin = {};
    body_.body.position_m = {0, 0, -1};
    const double hover = 1 / vehicle_.airframe().thrust_to_weight();
    body_.rotors = {hover, hover, hover, hover};
    supervisor.above_idle_ms = in_the_air ? tick_ms : 0;
    supervisor.flying = in_the_air;
    setpoint_ = {};
    run(20);  // off: whoever gave up may fly again
    place(1);
  }

  void place(float z) {
    setpoint_ = {};
    setpoint_.mode.x = setpoint_.mode.y = setpoint_.mode.z = setpoint_.mode.yaw = modeAbs;
    setpoint_.position.z = z;
  }
  void off() { setpoint_ = {}; }
  void all_by_hand(float thrust) {
    setpoint_ = {};
    setpoint_.thrust = thrust;
  }
  /// As cmd_full_state sends it: the yaw is in the quaternion alone, its norm is that of a compressed one.
  void full_state(float yaw_rad, float norm) {
    place(1);
    setpoint_.mode.yaw = modeDisable;
    setpoint_.mode.quat = modeAbs;
    setpoint_.attitudeQuaternion = {0, 0, norm * std::sin(yaw_rad / 2), norm * std::cos(yaw_rad / 2)};
  }
  void attitude_by_hand() {  // height hold: roll and pitch are the pilot's
    setpoint_.mode.x = setpoint_.mode.y = modeDisable;
  }
  void estimator_stops() { stopped_ = true; }
  void gyro_stops() { gyro_stopped_ = true; }

  void run(int ms, bool flies = false) {
    for (int i = 0; i < ms; ++i) {
      ++tick_ms;
      ++step_;
      if (!gyro_stopped_) sensors_.interruptTimestamp = std::uint64_t{tick_ms} * 1000 - 300;
      sense();
      if (!stopped_) estimate();
      setpoint_.timestamp = tick_ms / 10 * 10;  // a commander at 100 Hz
      supervisor.update(control_, step_);
      controllerOutOfTree(&control_, &setpoint_, &sensors_, &state_, step_);
      step_pid(twin, &twin_control_, &setpoint_, &state_, step_);
      if (by_network()) ++ticks_by_network_;
      ++ticks_;
      for (const float f : control_.normalizedForces) {
        if (by_network() && f > most_force_) most_force_ = f;
      }
      if (flies) fly();
    }
  }

  bool by_network() const { return control_.controlMode == controlModeForce; }
  bool as_the_twin() const {
    return control_.controlMode == controlModeLegacy && control_.roll == twin_control_.roll &&
           control_.pitch == twin_control_.pitch && control_.yaw == twin_control_.yaw &&
           !(control_.thrust < twin_control_.thrust) && !(control_.thrust > twin_control_.thrust);
  }
  double weight_N() const { return vehicle_.airframe().mass_kg * vehicle_.site().gravity_m_s2; }
  double total_thrust_N() const {
    double sum = 0;
    for (const float f : control_.normalizedForces)
      sum += static_cast<double>(f < 0 ? 0 : (f > 1 ? 1 : f) * THRUST_MAX);
    return sum;
  }
  const Vehicle& vehicle() const { return vehicle_; }
  double height_m() const { return -body_.body.position_m[2]; }
  float most_force() const { return most_force_; }
  long ticks() const { return ticks_; }
  long ticks_by_network() const { return ticks_by_network_; }

 private:
  void sense() {
    constexpr double deg = 57.29577951308232;
    const Vector3<double>& w = body_.body.body_rates_rad_s;
    sensors_.gyro = {static_cast<float>(w[0] * deg), static_cast<float>(-w[1] * deg), static_cast<float>(-w[2] * deg)};
  }
  /// Every estimator's state has noise of its own; Kalman writes at its task's pace, the complementary one at 250 and
  /// 100 Hz.
  void estimate() {
    noise_ = 1e-6f * static_cast<float>(tick_ms % 7);
    const bool attitude_now = estimator_ != Estimator::complementary || step_ % 4 == 0;
    const bool position_now = estimator_ == Estimator::complementary ? step_ % 10 == 0 : step_ % 4 == 0;
    if (attitude_now) {
      const pinnquad::Quaternion<double> q = pinnquad::swap_enu_flu_ned_frd(body_.body.attitude);
      state_.attitudeQuaternion = {static_cast<float>(q.x) + noise_, static_cast<float>(q.y), static_cast<float>(q.z),
                                   static_cast<float>(q.w)};
      if (estimator_ == Estimator::ukf) state_.attitude.timestamp = tick_ms;
    }
    if (position_now) {
      const Vector3<double>&p = body_.body.position_m, &v = body_.body.velocity_m_s;
      state_.position = {0, static_cast<float>(p[1]) + noise_, static_cast<float>(p[0]), static_cast<float>(-p[2])};
      state_.velocity = {0, static_cast<float>(v[1]), static_cast<float>(v[0]), static_cast<float>(-v[2])};
      if (estimator_ == Estimator::ukf) state_.position.timestamp = tick_ms;
    }
  }
  /// M1 front right, M2 rear right, M3 rear left, M4 front left; pinnquad: front right, rear left, front left, rear
  /// right.
  void fly() {
    constexpr int motor_of_rotor[4] = {0, 2, 3, 1};
    pinnquad::Commands<double> u{};
    for (std::size_t i = 0; i < 4; ++i) {
      const float force = control_.normalizedForces[motor_of_rotor[i]];
      u[i] = static_cast<double>(force < 0 ? 0 : (force > 1 ? 1 : force)) * static_cast<double>(THRUST_MAX) /
             vehicle_.airframe().max_rotor_thrust_N();
    }
    REQUIRE(vehicle_.step(body_, u, 1e-3) == pinnquad::Status::ok);
  }

  Estimator estimator_;
  Vehicle vehicle_;
  pinnquad::VehicleState<double> body_{};
  setpoint_t setpoint_{};
  sensorData_t sensors_{};
  state_t state_{};
  control_t control_{}, twin_control_{};
  stabilizerStep_t step_ = 0;
  float noise_ = 0, most_force_ = 0;
  bool stopped_ = false, gyro_stopped_ = false;
  long ticks_ = 0, ticks_by_network_ = 0;
};

}  // namespace

extern "C" {
uint32_t xTaskGetTickCount(void) { return tick_ms; }
float pmGetBatteryVoltage(void) { return battery_V; }
uint64_t usecTimestamp(void) { return std::uint64_t{tick_ms} * 1000; }
void eventTrigger(const eventtrigger* event) { card.trigger(*event); }
void vTaskDelay(uint32_t) { std::longjmp(app_waits, 1); }
bool supervisorIsFlying(void) { return supervisor.flying; }
bool supervisorAreMotorsAllowedToRun(void) { return true; }
void controllerPidInit(void) { pid = {}; }
bool controllerPidTest(void) { return true; }
void controllerPid(control_t* control, const setpoint_t* setpoint, const sensorData_t*, const state_t* state,
                   stabilizerStep_t step) {
  step_pid(pid, control, setpoint, state, step);
}
}

TEST_CASE("with every estimator, stamped or not, the network takes control and keeps it") {
  for (const Estimator estimator : {Estimator::kalman, Estimator::complementary, Estimator::ukf}) {
    CAPTURE(static_cast<int>(estimator));
    Firmware firmware(estimator);
    firmware.run(20);
    CHECK(firmware.by_network());
    const long before = firmware.ticks_by_network(), ticks = firmware.ticks();
    firmware.run(2000);
    CHECK(firmware.ticks_by_network() - before == firmware.ticks() - ticks);
  }
}

TEST_CASE(
    "at rest the forces carry the weight on the platform's scale; it hovers where it should, no motor beyond its end") {
  Firmware firmware(Estimator::kalman);
  firmware.run(40);
  REQUIRE(firmware.by_network());
  const double weight_N = firmware.vehicle().airframe().mass_kg * 9.80665;
  CHECK(firmware.total_thrust_N() == doctest::Approx(weight_N).epsilon(0.06));
  firmware.run(6000, true);
  CHECK(firmware.height_m() == doctest::Approx(1.0).epsilon(0.03));
  firmware.place(3);  // as much thrust as there is
  firmware.run(4000, true);
  CHECK(firmware.height_m() == doctest::Approx(3.0).epsilon(0.03));
  CHECK(firmware.most_force() <= 1.0f + 1e-6f);
  CHECK(firmware.most_force() > 0.8f);
}

TEST_CASE("an estimator that stops is noticed; the PID controller that takes over is warm, to the bit") {
  for (const Estimator estimator : {Estimator::kalman, Estimator::complementary, Estimator::ukf}) {
    CAPTURE(static_cast<int>(estimator));
    Firmware firmware(estimator);
    firmware.run(1001, false);
    REQUIRE(firmware.by_network());
    firmware.estimator_stops();
    int until_ms = 0;
    for (; firmware.by_network() && until_ms < 500; ++until_ms) firmware.run(1);
    CHECK(until_ms >= 40);
    CHECK(until_ms <= 70);  // attitude stale after 20 ms, commands kept for 40
    CHECK(pid.steps == twin.steps);
    for (int i = 0; i < 5; ++i) {  // between the PID's own steps too
      CHECK(firmware.as_the_twin());
      firmware.run(1);
    }
    firmware.run(200);
    CHECK_FALSE(firmware.by_network());  // until it was off, or by hand
  }
}

TEST_CASE("a gyro that stops is stale by its own time: the network keeps its commands for a while, then gives up") {
  Firmware firmware(Estimator::kalman);
  firmware.run(100);
  REQUIRE(firmware.by_network());
  firmware.gyro_stops();
  firmware.run(100);
  CHECK_FALSE(firmware.by_network());
  CrazyflieCoreRecord record{};
  pinnquad_flight_record(&record);
  CHECK(record.stale_inputs == pinnquad::autopilot::body_rates_bit);
}

TEST_CASE("no command asks for more than the platform's motors have") {
  const Firmware firmware(Estimator::kalman);
  CrazyflieCoreSettings settings{};
  pinnquad_flight_settings(tick_ms, &settings);
  const double most_N =
      static_cast<double>(settings.highest_command) * firmware.vehicle().airframe().max_rotor_thrust_N();
  REQUIRE(firmware.vehicle().airframe().max_rotor_thrust_N() > static_cast<double>(THRUST_MAX));
  CHECK(most_N == doctest::Approx(static_cast<double>(THRUST_MAX)).epsilon(1e-5));
}

TEST_CASE("roll and pitch by hand are not the network's, whatever the height is") {
  Firmware firmware(Estimator::kalman);
  firmware.run(100);
  REQUIRE(firmware.by_network());
  firmware.attitude_by_hand();
  firmware.run(2);
  CHECK(firmware.as_the_twin());
  firmware.place(1);
  firmware.run(20);
  CHECK(firmware.by_network());
}

TEST_CASE("on the ground the motors idle until a place above is asked for") {
  Firmware firmware(Estimator::kalman, false);
  const auto idles_for = [&](int ms) {
    double most_N = 0;
    for (int i = 0; i < ms; ++i) {
      firmware.run(1);
      if (firmware.by_network()) most_N = std::max(most_N, firmware.total_thrust_N());
    }
    CHECK(firmware.by_network());
    CHECK(most_N < 0.12 * firmware.weight_N());
  };
  idles_for(5000);  // the supervisor calls it flying for these motors alone
  CHECK(supervisor.flying);
  SUBCASE("off and back") {
    firmware.off();
    firmware.run(500);
    CHECK(supervisor.flying);
    firmware.place(1);
    idles_for(3000);
    firmware.off();
    firmware.run(3000);
    CHECK_FALSE(supervisor.flying);
    firmware.place(1);
    idles_for(3000);
  }
  firmware.place(2);
  firmware.run(300);
  const double early_N = firmware.total_thrust_N();
  firmware.run(900);
  CHECK(early_N < 0.6 * firmware.total_thrust_N());
  CHECK(firmware.total_thrust_N() > firmware.weight_N());
  firmware.place(1);  // in the air: nothing idles, however long it is asked for
  firmware.run(3000);
  CHECK(firmware.total_thrust_N() > 0.8 * firmware.weight_N());
}

TEST_CASE("taken over in the air all of the thrust is there at once, a moment after it idled on the ground too") {
  Firmware firmware(Estimator::kalman);
  const auto has_all_of_it = [&] {
    firmware.place(1);
    firmware.run(4);
    REQUIRE(firmware.by_network());
    CHECK(firmware.total_thrust_N() > 0.8 * firmware.weight_N());
  };
  has_all_of_it();
  firmware.attitude_by_hand();
  firmware.run(100);
  has_all_of_it();
  firmware.all_by_hand(40000);
  firmware.run(5000);
  has_all_of_it();
  Firmware stood(Estimator::kalman, false);
  stood.run(1000);
  REQUIRE(stood.by_network());
  stood.all_by_hand(50000);
  stood.run(500);
  stood.place(1);
  stood.run(4);
  REQUIRE(stood.by_network());
  CHECK(stood.total_thrust_N() > 0.8 * stood.weight_N());
}

TEST_CASE("a full-state set point's yaw is that of its quaternion, whatever the norm of that") {
  Firmware firmware(Estimator::kalman);
  const auto wanted_yaw_rad = [] {
    CrazyflieCoreRecord record{};
    pinnquad_flight_record(&record);
    return static_cast<double>(record.wanted_yaw_rad);
  };
  for (const float yaw_rad : {0.0f, 0.7f, -1.2f}) {
    for (const float norm : {1.0f, 0.9f}) {
      CAPTURE(yaw_rad);
      CAPTURE(norm);
      firmware.full_state(yaw_rad, norm);
      firmware.run(20);
      CHECK(wanted_yaw_rad() == doctest::Approx(1.5707963267948966 - static_cast<double>(yaw_rad)).epsilon(1e-5));
    }
  }
  firmware.full_state(0, 0);  // none: the heading is kept
  firmware.run(20);
  CHECK(std::isnan(wanted_yaw_rad()));
}

/// The file is for `pinnquad replay`, which runs it through the core again (flight_stacks.crazyflie_log).
TEST_CASE("what the core received and answered goes to the uSD card, each step, with its settings each second") {
  Firmware firmware(Estimator::kalman);
  firmware.run(40);
  card.clear();
  firmware.run(3000, true);
  firmware.place(2);
  firmware.run(3000, true);
  firmware.attitude_by_hand();
  firmware.run(100);
  firmware.place(1);
  firmware.estimator_stops();
  firmware.run(200);
  const int settings = card.count() - 6300 / 2;  // six or seven whole seconds end in 6.3 s
  CHECK((settings == 6 || settings == 7));
  CrazyflieCoreRecord record{};
  pinnquad_flight_record(&record);
  CHECK(std::uint32_t{record.timestamp_ms} == tick_ms);
  CHECK(static_cast<pinnquad::autopilot::Reaction>(record.reaction) == pinnquad::autopilot::Reaction::gives_up);
  const std::string file = card.file();
  const Block block = sound_block<CrazyflieModel>();
  std::ofstream("flight_stacks_crazyflie.usd", std::ios::binary) << file;
  std::ofstream model("flight_stacks_crazyflie.block", std::ios::binary);
  model.write(reinterpret_cast<const char*>(block.data()), static_cast<std::streamsize>(block.size()));
  CHECK(model.good());
}
