// SPDX-License-Identifier: MIT
// The Crazyflie's units, frames and motor order on one side, the shared controller on the other.
#pragma once

#include <cmath>
#include <limits>

#include "neural_control_core.h"
#include "pinnquad/control/autopilot/neural_controller.hpp"

namespace pinnquad_crazyflie {

inline constexpr float rad_per_deg = 0.017453292519943295f;

/// Rotor of pinnquad for each motor. M1 front right, M2 rear right, M3 rear left, M4 front left; M1 and M3 turn
/// counter-clockwise seen from above.
inline constexpr std::size_t rotor_of_motor[4] = {0, 3, 1, 2};

/// `Controller`: one that records its inputs (pinnquad/control/autopilot/recorded_controller.hpp), where the app logs
/// it.
template <class Model, class Controller = pinnquad::autopilot::NeuralController<Model>>
class NeuralControl {
 public:
  /// With the settings that the controller is made with.
  template <class... Settings>
  explicit NeuralControl(const Settings&... settings) noexcept : controller_(settings...) {}

  pinnquad::Status offer_model(const void* block, std::size_t length) noexcept {
    return controller_.offer_model(block, length);
  }
  bool ready() const noexcept { return controller_.ready(); }
  const Controller& controller() const noexcept { return controller_; }

  /// `forces`: 4 of them, untouched where it has none.
  PINNQUAD_ALWAYS_INLINE bool step(std::uint32_t now_ms, const CrazyflieState& state, const CrazyflieSetpoint& setpoint,
                                   float* forces, CrazyflieReport& report) noexcept {
    why_ = {};
    bool has_commands = false;
    const pinnquad::autopilot::Learning learning = pinnquad::autopilot::learning_of(state.learning);
    if (asks_for_a_place(setpoint)) {
      controller_.situation({state.drives_motors, state.landed, learning});
      take(state);
      static_cast<void>(controller_.battery_voltage(in_us(now_ms), state.battery_voltage));
      take(setpoint);
      has_commands = controller_.step(in_us(now_ms), commands_, why_) != pinnquad::autopilot::Reaction::gives_up;
    } else {
      controller_.situation({false, state.landed, learning});
      controller_.skip(in_us(now_ms));
    }
    controller_.describe(why_, report);
    report.lift = controller_.lift();
    if (!has_commands) return false;
    for (std::size_t motor = 0; motor < 4; ++motor) forces[motor] = commands_[rotor_of_motor[motor]];
    return true;
  }

 private:
  static std::uint64_t in_us(std::uint32_t time_ms) noexcept { return std::uint64_t{time_ms} * 1000; }
  static pinnquad::Vector3<float> ned(const float (&v)[3]) noexcept {
    return pinnquad::swap_enu_ned<float>({v[0], v[1], v[2]});
  }
  /// Where one axis is the pilot's, attitude and thrust are asked for, which this controller does not fly.
  static bool asks_for_a_place(const CrazyflieSetpoint& s) noexcept {
    return s.mode[0] != crazyflie_mode_disable && s.mode[1] != crazyflie_mode_disable &&
           s.mode[2] != crazyflie_mode_disable;
  }

  /// From x, counter-clockwise, whatever the norm; NaN for a quaternion of zeros.
  static float yaw_rad(const float (&xyzw)[4]) noexcept {
    const pinnquad::Quaternion<float> q{xyzw[3], xyzw[0], xyzw[1], xyzw[2]};
    if (!(pinnquad::squared_norm(q) > 0)) return std::numeric_limits<float>::quiet_NaN();
    const pinnquad::Heading<float> heading = pinnquad::heading(q);
    return std::atan2(heading.sine, heading.cosine);
  }

  // what is refused is counted by the controller, and ages
  void take(const CrazyflieState& s) noexcept {
    const pinnquad::Vector3<float> gyro(s.gyro[0] * rad_per_deg, s.gyro[1] * rad_per_deg, s.gyro[2] * rad_per_deg);
    const pinnquad::Quaternion<float> q{s.attitude_quaternion[3], s.attitude_quaternion[0], s.attitude_quaternion[1],
                                        s.attitude_quaternion[2]};
    heading_ = pinnquad::heading(q);
    static_cast<void>(controller_.body_rates(in_us(s.gyro_timestamp), pinnquad::swap_flu_frd<float>(gyro)));
    static_cast<void>(controller_.attitude(in_us(s.attitude_timestamp), pinnquad::swap_enu_flu_ned_frd(q)));
    static_cast<void>(controller_.local(in_us(s.position_timestamp), {ned(s.position), ned(s.velocity)}));
  }

  /// NaN where a mode does not ask.
  void take(const CrazyflieSetpoint& s) noexcept {
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    constexpr float quarter_turn = 1.5707963267948966f;
    float velocity[3] = {s.velocity[0], s.velocity[1], s.velocity[2]};
    if (s.velocity_body) {
      velocity[0] = heading_.cosine * s.velocity[0] - heading_.sine * s.velocity[1];
      velocity[1] = heading_.sine * s.velocity[0] + heading_.cosine * s.velocity[1];
    }
    float position[3] = {none, none, none};
    for (std::size_t i = 0; i < 3; ++i) {
      if (s.mode[i] == crazyflie_mode_abs) position[i] = s.position[i];
      if (s.mode[i] == crazyflie_mode_disable) velocity[i] = none;
    }
    pinnquad::TrajectoryPoint<float> wanted;
    wanted.position_m = ned(position);
    wanted.velocity_m_s = ned(velocity);
    wanted.acceleration_m_s2 = ned(s.acceleration);
    // yaw counts from x (east) counter-clockwise there, from north clockwise here
    const bool by_quaternion = s.mode_yaw == crazyflie_mode_disable && s.mode_quat == crazyflie_mode_abs;
    wanted.yaw_rad = s.mode_yaw == crazyflie_mode_abs ? quarter_turn - s.yaw * rad_per_deg : none;
    if (by_quaternion) wanted.yaw_rad = quarter_turn - yaw_rad(s.attitude_quaternion);
    wanted.yaw_rate_rad_s = s.mode_yaw != crazyflie_mode_disable || by_quaternion ? -s.yaw_rate * rad_per_deg : none;
    static_cast<void>(controller_.set_point(in_us(s.timestamp), wanted));
  }

  Controller controller_;
  pinnquad::autopilot::StepReport why_{};  ///< of the last step; here, not on the stack of a task that has little
  pinnquad::Commands<float> commands_{};
  pinnquad::Heading<float> heading_{};  ///< of the body in the firmware's world
};

}  // namespace pinnquad_crazyflie
