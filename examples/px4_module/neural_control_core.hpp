// SPDX-License-Identifier: MIT
// The module without PX4: messages in, motor commands and a status message out. Pure C++17; the glue
// (pinnquad_control.cpp) copies the fields of the uORB messages of the same names.
#pragma once

#include <algorithm>
#include <cmath>

#include "pinnquad/control/autopilot/neural_controller.hpp"
#include "propulsion.hpp"

namespace pinnquad_px4 {

// Of PX4's messages, the fields that are used: names, units and frames are theirs. Times are in us since boot.

struct VehicleAttitude {
  std::uint64_t timestamp_sample{0};
  float q[4]{1, 0, 0, 0};  ///< (w, x, y, z), FRD -> NED
};

struct VehicleAngularVelocity {
  std::uint64_t timestamp_sample{0};
  float xyz[3]{};  ///< FRD, rad/s
};

/// The counters go up by one when the estimator moved its estimate by the delta beside them.
struct VehicleLocalPosition {
  std::uint64_t timestamp_sample{0};
  bool xy_valid{false};
  bool z_valid{false};
  bool v_xy_valid{false};
  bool v_z_valid{false};
  float x{0};  ///< NED, m
  float y{0};
  float z{0};
  float vx{0};  ///< NED, m/s
  float vy{0};
  float vz{0};
  std::uint8_t xy_reset_counter{0};
  std::uint8_t z_reset_counter{0};
  std::uint8_t vxy_reset_counter{0};
  std::uint8_t vz_reset_counter{0};
  std::uint8_t heading_reset_counter{0};
  float delta_xy[2]{};     ///< m
  float delta_z{0};        ///< m
  float delta_vxy[2]{};    ///< m/s
  float delta_vz{0};       ///< m/s
  float delta_heading{0};  ///< rad
};

/// NaN: not asked for.
struct TrajectorySetpoint {
  std::uint64_t timestamp{0};
  float position[3]{};      ///< NED, m
  float velocity[3]{};      ///< NED, m/s
  float acceleration[3]{};  ///< NED, m/s^2
  float jerk[3]{};          ///< NED, m/s^3
  float yaw{0};             ///< rad
  float yawspeed{0};        ///< rad/s
};

struct BatteryStatus {
  std::uint64_t timestamp{0};
  bool connected{false};
  float voltage_v{0};  ///< V; 0: not known
};

/// Thrust of each motor over its greatest, 0..1. The motor order of a PX4 quadrotor in X is pinnquad's.
struct ActuatorMotors {
  std::uint64_t timestamp{0};
  std::uint64_t timestamp_sample{0};
  float control[4]{};
};

/// PX4's vehicle_thrust_setpoint and vehicle_torque_setpoint, FRD, normalised.
struct BodySetpoints {
  float thrust[3]{};
  float torque[3]{};
};

/// The set points by which PX4's allocator would set these motors. PX4's land detector and its estimate of the hover
/// thrust read them, and no motors. The thrust is the mean control. The scale of the torques is the allocator's own for
/// a quadrotor in X; other places of the rotors share it.
template <class Scalar>
BodySetpoints body_setpoints(const ActuatorMotors& motors, const pinnquad::Airframe<Scalar>& airframe) noexcept {
  Scalar x_m(0), y_m(0);
  for (const auto& rotor : airframe.rotors) {
    x_m = std::max(x_m, std::abs(rotor.x_m));
    y_m = std::max(y_m, std::abs(rotor.y_m));
  }
  constexpr float share = 0.25f, root_2 = 1.41421356f;
  BodySetpoints all;
  for (std::size_t i = 0; i < pinnquad::rotor_count; ++i) {
    const auto& rotor = airframe.rotors[i];
    const float u = share * motors.control[i];
    all.thrust[2] -= u;
    if (y_m > Scalar(0)) all.torque[0] -= root_2 * u * static_cast<float>(rotor.y_m / y_m);
    if (x_m > Scalar(0)) all.torque[1] += root_2 * u * static_cast<float>(rotor.x_m / x_m);
    all.torque[2] += rotor.spin == pinnquad::Spin::counter_clockwise ? u : -u;
  }
  return all;
}

/// The module's report (msg/PinnquadStatus.msg).
struct PinnquadStatus {
  std::uint64_t timestamp{0};
  std::uint32_t inference_time_us{0};  ///< of the step, outer loop and inverse
  std::uint32_t asked{0};              ///< predictions since the start
  std::uint32_t refused_samples{0};
  float fallback_share{0};   ///< of the predictions
  float envelope_excess{0};  ///< how far the worst feature lay outside, in half-widths of its range
  std::int8_t envelope_feature{-1};
  std::uint8_t reaction{0};      ///< pinnquad::autopilot::Reaction
  std::uint8_t status{0};        ///< pinnquad::Status
  std::uint8_t cause{0};         ///< pinnquad::Status of the network alone
  std::uint8_t stale_inputs{0};  ///< bit 0 body rates, 1 attitude, 2 local position, 3 set point, 4 battery voltage
  std::uint8_t bias_status{0};   ///< pinnquad::Status of the network's bias
};

/// `Model` is an exported header; the weights come as a model block. `Controller`: one that records its inputs
/// (pinnquad/control/autopilot/recorded_controller.hpp), where the module logs it.
template <class Model, class Controller = pinnquad::autopilot::NeuralController<Model>>
class NeuralControl {
 public:
  using ClockUs = std::uint64_t (*)();

  /// `clock` is that of the messages: hrt_absolute_time.
  /// With the settings that the controller is made with.
  template <class... Settings>
  explicit NeuralControl(ClockUs clock, const Settings&... settings) noexcept
      : clock_(clock), controller_(settings...) {}

  /// Before the module registers its mode, and with the next model in flight, from another thread: opens the block,
  /// checks every number, replays the golden vectors. The module may register once this was ok.
  pinnquad::Status offer_model(const void* block, std::size_t length) noexcept {
    return controller_.offer_model(block, length);
  }
  bool ready() const noexcept { return controller_.ready(); }
  /// True once run() has taken the model accepted last: the memory of the one before may be written.
  bool model_settled() const noexcept { return controller_.model_settled(); }

  pinnquad::Status take(const VehicleAngularVelocity& m) noexcept {
    rates_us_ = m.timestamp_sample;
    return controller_.body_rates(m.timestamp_sample, {m.xyz[0], m.xyz[1], m.xyz[2]});
  }
  pinnquad::Status take(const VehicleAttitude& m) noexcept {
    return controller_.attitude(m.timestamp_sample, {m.q[0], m.q[1], m.q[2], m.q[3]});
  }
  /// `out_of_range` where the estimator itself calls a part of it invalid. Before the set point of the same tick: what
  /// was asked for before a reset moves with it.
  pinnquad::Status take(const VehicleLocalPosition& m) noexcept {
    take_resets(m);
    if (!(m.xy_valid && m.z_valid && m.v_xy_valid && m.v_z_valid)) return pinnquad::Status::out_of_range;
    return controller_.local(m.timestamp_sample, {{m.x, m.y, m.z}, {m.vx, m.vy, m.vz}});
  }
  /// On the ground a place less than 0.4 m above it does not ask to take off: PX4's estimate wanders by that while it
  /// stands. A speed does.
  pinnquad::Status take(const TrajectorySetpoint& m) noexcept {
    constexpr float least_climb_m = 0.4f;
    pinnquad::TrajectoryPoint<float> wanted;
    wanted.position_m = vector(m.position);
    const bool stands = has_local_ && !(controller_.lift() > 0);
    if (stands && wanted.position_m[2] < local_.z && wanted.position_m[2] > local_.z - least_climb_m) {
      wanted.position_m[2] = local_.z;
    }
    wanted.velocity_m_s = vector(m.velocity);
    wanted.acceleration_m_s2 = vector(m.acceleration);
    wanted.jerk_m_s3 = vector(m.jerk);
    wanted.yaw_rad = m.yaw;
    wanted.yaw_rate_rad_s = m.yawspeed;
    return controller_.set_point(m.timestamp, wanted);
  }

  /// For a model that asks for it; `out_of_range` of a battery that is not there.
  pinnquad::Status take(const BatteryStatus& m) noexcept {
    return m.connected ? controller_.battery_voltage(m.timestamp, m.voltage_v) : pinnquad::Status::out_of_range;
  }

  /// The motors' owner, and whether the vehicle stands (vehicle_status, vehicle_land_detected).
  void situation(const pinnquad::autopilot::Situation& now) noexcept { controller_.situation(now); }

  /// Before the first run(): what makes PX4's controls of the model's commands. The controller's output limits are
  /// thrusts, too.
  void propulsion(const Propulsion& propulsion) noexcept { propulsion_ = propulsion; }

  /// battery_status.scale, where the parameter asks for it.
  void battery_scale(float scale) noexcept { propulsion_.battery_scale(scale); }

  const Controller& controller() const noexcept { return controller_; }

  /// One tick, after the messages. False: the module has no commands, nothing is to be published to the motors, and
  /// PX4's own controllers must take over. `status` is written either way.
  bool run(ActuatorMotors& motors, PinnquadStatus& status) noexcept {
    const std::uint64_t start_us = clock_();
    pinnquad::Commands<float> commands{};
    pinnquad::autopilot::StepReport report;
    const pinnquad::autopilot::Reaction reaction = controller_.step(start_us, commands, report);
    const std::uint64_t end_us = clock_();
    controller_.describe(report, status);
    status.timestamp = end_us;
    status.inference_time_us = static_cast<std::uint32_t>(end_us - start_us);
    if (reaction == pinnquad::autopilot::Reaction::gives_up) return false;
    motors.timestamp = end_us;
    motors.timestamp_sample = rates_us_;
    propulsion_.controls(commands, motors.control);
    return true;
  }

 private:
  static pinnquad::Vector3<float> vector(const float (&v)[3]) noexcept { return {v[0], v[1], v[2]}; }

  void take_resets(const VehicleLocalPosition& m) noexcept {
    pinnquad::autopilot::LocalState by;
    float turned_rad = 0;
    bool jumps = false;
    const auto reset = [&](std::uint8_t counter, std::uint8_t before) noexcept {
      const bool moved = has_local_ && counter != before;
      jumps = jumps || moved;
      return moved;
    };
    if (reset(m.xy_reset_counter, local_.xy_reset_counter)) {
      by.position_m[0] = m.delta_xy[0];
      by.position_m[1] = m.delta_xy[1];
    }
    if (reset(m.z_reset_counter, local_.z_reset_counter)) by.position_m[2] = m.delta_z;
    if (reset(m.vxy_reset_counter, local_.vxy_reset_counter)) {
      by.velocity_m_s[0] = m.delta_vxy[0];
      by.velocity_m_s[1] = m.delta_vxy[1];
    }
    if (reset(m.vz_reset_counter, local_.vz_reset_counter)) by.velocity_m_s[2] = m.delta_vz;
    if (reset(m.heading_reset_counter, local_.heading_reset_counter)) turned_rad = m.delta_heading;
    local_ = m;
    has_local_ = true;
    if (jumps && pinnquad::all_finite(by.position_m) && pinnquad::all_finite(by.velocity_m_s) &&
        pinnquad::is_finite(turned_rad)) {
      controller_.jump(by, turned_rad);
    }
  }

  ClockUs clock_;
  Controller controller_;
  Propulsion propulsion_{};
  VehicleLocalPosition local_{};  ///< the last one, whose counters the next is compared with
  bool has_local_ = false;
  std::uint64_t rates_us_ = 0;
};

}  // namespace pinnquad_px4
