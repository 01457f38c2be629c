// SPDX-License-Identifier: MIT
// The two example modules as a simulated flight sees them: samples in NED, FRD and SI go in, commands in the airframe's
// rotor order come out. Each speaks to its core in the messages, units and frames of its flight stack, converted here
// by hand.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "crazyflie_app/src/neural_control_core.hpp"
#include "models/crazyflie_2_1.hpp"
#include "models/demo_quadrotor.hpp"
#include "pinnquad/control/autopilot/recorded_controller.hpp"
#include "pinnquad/core/rotation.hpp"
#include "px4_module/neural_control_core.hpp"

namespace pinnquad::autopilot::test {

/// The result of a step of any stack.
struct Answer {
  bool has_commands = false;
  std::array<double, 4> commands{};
  Reaction reaction{Reaction::gives_up};
  pinnquad::Status status{}, cause{};
  unsigned stale_inputs = 0;
  unsigned refused_samples = 0;
  float fallback_share = 0;
};

template <class Report>
Answer answer_of(bool has_commands, const Report& report) {
  Answer answer;
  answer.has_commands = has_commands;
  answer.reaction = static_cast<Reaction>(report.reaction);
  answer.status = static_cast<pinnquad::Status>(report.status);
  answer.cause = static_cast<pinnquad::Status>(report.cause);
  answer.stale_inputs = report.stale_inputs;
  answer.refused_samples = report.refused_samples;
  answer.fallback_share = report.fallback_share;
  return answer;
}

/// PX4: 1 kHz.
template <class ModelType, class Controller = NeuralController<ModelType>>
class Px4StackOf {
 public:
  using Model = ModelType;
  static constexpr const char* name = "px4_module";
  static constexpr int period_ms = 1;

  template <class... Settings>
  explicit Px4StackOf(const Settings&... settings) : core_(&Px4StackOf::clock, settings...) {}

  pinnquad::Status offer(const void* block, std::size_t length) { return core_.offer_model(block, length); }
  bool ready() const { return core_.ready(); }
  const CoreRecord& record() const { return core_.controller().record(); }
  const auto& controller() const { return core_.controller(); }
  CoreSettings settings() const { return core_.controller().settings(); }

  void rates(std::uint64_t time_us, const pinnquad::Vector3<double>& w) {
    pinnquad_px4::VehicleAngularVelocity m;
    m.timestamp_sample = time_us;
    for (int i = 0; i < 3; ++i) m.xyz[i] = static_cast<float>(w[i]);
    static_cast<void>(core_.take(m));
  }
  void attitude(std::uint64_t time_us, const pinnquad::Quaternion<double>& q) {
    pinnquad_px4::VehicleAttitude m;
    m.timestamp_sample = time_us;
    m.q[0] = static_cast<float>(q.w), m.q[1] = static_cast<float>(q.x);
    m.q[2] = static_cast<float>(q.y), m.q[3] = static_cast<float>(q.z);
    static_cast<void>(core_.take(m));
  }
  void local(std::uint64_t time_us, const pinnquad::Vector3<double>& p, const pinnquad::Vector3<double>& v) {
    pinnquad_px4::VehicleLocalPosition m;
    m.timestamp_sample = time_us;
    m.xy_valid = m.z_valid = m.v_xy_valid = m.v_z_valid = true;
    m.x = static_cast<float>(p[0]), m.y = static_cast<float>(p[1]), m.z = static_cast<float>(p[2]);
    m.vx = static_cast<float>(v[0]), m.vy = static_cast<float>(v[1]), m.vz = static_cast<float>(v[2]);
    static_cast<void>(core_.take(m));
  }
  void set_point(std::uint64_t time_us, const pinnquad::TrajectoryPoint<double>& point) {
    pinnquad_px4::TrajectorySetpoint m;
    m.timestamp = time_us;
    for (int i = 0; i < 3; ++i) {
      m.position[i] = static_cast<float>(point.position_m[i]);
      m.velocity[i] = static_cast<float>(point.velocity_m_s[i]);
      m.acceleration[i] = static_cast<float>(point.acceleration_m_s2[i]);
      m.jerk[i] = static_cast<float>(point.jerk_m_s3[i]);
    }
    m.yaw = static_cast<float>(point.yaw_rad);
    m.yawspeed = static_cast<float>(point.yaw_rate_rad_s);
    static_cast<void>(core_.take(m));
  }

  void battery(std::uint64_t time_us, double volts) {
    pinnquad_px4::BatteryStatus m;
    m.timestamp = time_us;
    m.connected = true;
    m.voltage_v = static_cast<float>(volts);
    static_cast<void>(core_.take(m));
  }

  /// The module runs unselected too.
  void fly_by_hand(bool /*by_hand*/) {}
  void situation(const Situation& now) { core_.situation(now); }

  Answer run(std::uint64_t now_us) {
    now_us_ = now_us;
    pinnquad_px4::ActuatorMotors motors;
    pinnquad_px4::PinnquadStatus status;
    Answer answer = answer_of(core_.run(motors, status), status);
    for (std::size_t i = 0; i < 4; ++i) answer.commands[i] = static_cast<double>(motors.control[i]);
    return answer;
  }

 private:
  static std::uint64_t clock() { return now_us_; }
  static inline std::uint64_t now_us_ = 0;

  pinnquad_px4::NeuralControl<Model, Recorded<Controller>> core_;
};

/// The paper's quadrotor.
using Px4Stack = Px4StackOf<DemoQuadModel>;

/// As a training writes it that chose time constants of the bias.
struct QuickCrazyflieModel : CrazyflieModel {
  static constexpr std::array<float, 4> bias_time_constants_s = {{0.2f, 0.2f, 0.2f, 0.2f}};
};

/// Crazyflie's firmware: 500 Hz; x east, y north, z up; degrees.
template <class ModelType, class Controller = NeuralController<ModelType>>
class CrazyflieStackOf {
 public:
  using Model = ModelType;
  static constexpr const char* name = "crazyflie_app";
  static constexpr int period_ms = 2;

  template <class... Settings>
  explicit CrazyflieStackOf(const Settings&... settings) : core_(settings...) {}

  pinnquad::Status offer(const void* block, std::size_t length) { return core_.offer_model(block, length); }
  bool ready() const { return core_.ready(); }
  const CoreRecord& record() const { return core_.controller().record(); }
  const auto& controller() const { return core_.controller(); }
  CoreSettings settings() const { return core_.controller().settings(); }

  void rates(std::uint64_t time_us, const pinnquad::Vector3<double>& w) {
    state_.gyro_timestamp = in_ms(time_us);
    state_.gyro[0] = static_cast<float>(w[0] * pinnquad::degrees_per_radian);
    state_.gyro[1] = static_cast<float>(-w[1] * pinnquad::degrees_per_radian);
    state_.gyro[2] = static_cast<float>(-w[2] * pinnquad::degrees_per_radian);
  }
  /// Through matrices: columns are the body's axes forward, left and up; rows east, north and up.
  void attitude(std::uint64_t time_us, const pinnquad::Quaternion<double>& q) {
    pinnquad::Matrix<double, 3, 3> ned, enu;
    for (int axis = 0; axis < 3; ++axis) {
      pinnquad::Vector3<double> unit = pinnquad::Vector3<double>::Zero();
      unit[axis] = 1;
      ned.col(axis) = pinnquad::body_to_world(pinnquad::normalized(q), unit);
    }
    constexpr double sign[3] = {1, -1, -1};
    for (int axis = 0; axis < 3; ++axis) {
      enu(0, axis) = sign[axis] * ned(1, axis);
      enu(1, axis) = sign[axis] * ned(0, axis);
      enu(2, axis) = -sign[axis] * ned(2, axis);
    }
    pinnquad::Quaternion<double> turned = pinnquad::from_rotation_matrix(enu);
    const double norm = std::sqrt(pinnquad::squared_norm(q));
    state_.attitude_timestamp = in_ms(time_us);
    state_.attitude_quaternion[0] = static_cast<float>(norm * turned.x);
    state_.attitude_quaternion[1] = static_cast<float>(norm * turned.y);
    state_.attitude_quaternion[2] = static_cast<float>(norm * turned.z);
    state_.attitude_quaternion[3] = static_cast<float>(norm * turned.w);
  }
  void local(std::uint64_t time_us, const pinnquad::Vector3<double>& p, const pinnquad::Vector3<double>& v) {
    state_.position_timestamp = in_ms(time_us);
    world(p, state_.position);
    world(v, state_.velocity);
  }
  void set_point(std::uint64_t time_us, const pinnquad::TrajectoryPoint<double>& point) {
    setpoint_ = {};
    setpoint_.timestamp = in_ms(time_us);
    world(point.position_m, setpoint_.position);
    world(point.velocity_m_s, setpoint_.velocity);
    world(point.acceleration_m_s2, setpoint_.acceleration);
    setpoint_.yaw = static_cast<float>(90.0 - point.yaw_rad * pinnquad::degrees_per_radian);
    setpoint_.yaw_rate = static_cast<float>(-point.yaw_rate_rad_s * pinnquad::degrees_per_radian);
    for (std::uint8_t& mode : setpoint_.mode) mode = crazyflie_mode_abs;
    setpoint_.mode_yaw = crazyflie_mode_abs;
  }

  /// Of each tick.
  void battery(std::uint64_t /*time_us*/, double volts) { state_.battery_voltage = static_cast<float>(volts); }

  void fly_by_hand(bool by_hand) { by_hand_ = by_hand; }
  void situation(const Situation& now) {
    state_.drives_motors = now.drives_motors;
    state_.landed = now.landed;
    state_.learning = static_cast<std::uint8_t>(now.learning);
  }

  Answer run(std::uint64_t now_us) {
    float m[4] = {};
    CrazyflieReport report{};
    CrazyflieSetpoint asked = setpoint_;
    if (by_hand_) {
      for (std::uint8_t& mode : asked.mode) mode = crazyflie_mode_disable;
    }
    Answer answer = answer_of(core_.step(in_ms(now_us), state_, asked, m, report), report);
    // pinnquad: front right, rear left, front left, rear right; M1..M4 front right, rear right, rear left, front left
    answer.commands = {static_cast<double>(m[0]), static_cast<double>(m[2]), static_cast<double>(m[3]),
                       static_cast<double>(m[1])};
    return answer;
  }

 private:
  static std::uint32_t in_ms(std::uint64_t time_us) { return static_cast<std::uint32_t>(time_us / 1000); }
  static void world(const pinnquad::Vector3<double>& ned, float (&enu)[3]) {
    enu[0] = static_cast<float>(ned[1]);
    enu[1] = static_cast<float>(ned[0]);
    enu[2] = static_cast<float>(-ned[2]);
  }

  pinnquad_crazyflie::NeuralControl<Model, Recorded<Controller>> core_;
  CrazyflieState state_{};
  CrazyflieSetpoint setpoint_{};
  bool by_hand_ = false;
};

using CrazyflieStack = CrazyflieStackOf<CrazyflieModel>;

}  // namespace pinnquad::autopilot::test
