// SPDX-License-Identifier: MIT
// A controller that records its inputs and answers (core_record.hpp), for a module that logs them. It is a type of its
// own: a module that logs nothing pays nothing.
#pragma once

#include <limits>

#include "pinnquad/control/autopilot/core_record.hpp"
#include "pinnquad/control/autopilot/neural_controller.hpp"

namespace pinnquad::autopilot {

/// `Controller`: a NeuralController, whose answers stay the same.
template <class Controller>
class Recorded : public Controller {
 public:
  using Controller::Controller;

  Status body_rates(std::uint64_t time_us, const Vector3<float>& rates_rad_s) noexcept {
    note(body_rates_bit);
    record_.body_rates_us = time_us;
    copy(rates_rad_s, record_.body_rates_rad_s);
    return Controller::body_rates(time_us, rates_rad_s);
  }
  Status attitude(std::uint64_t time_us, const Quaternion<float>& q) noexcept {
    note(attitude_bit);
    record_.attitude_us = time_us;
    record_.attitude[0] = q.w;
    record_.attitude[1] = q.x;
    record_.attitude[2] = q.y;
    record_.attitude[3] = q.z;
    return Controller::attitude(time_us, q);
  }
  Status local(std::uint64_t time_us, const LocalState& state) noexcept {
    note(local_bit);
    record_.local_us = time_us;
    copy(state.position_m, record_.position_m);
    copy(state.velocity_m_s, record_.velocity_m_s);
    return Controller::local(time_us, state);
  }
  Status set_point(std::uint64_t time_us, const TrajectoryPoint<float>& wanted) noexcept {
    note(set_point_bit);
    record_.set_point_us = time_us;
    copy(wanted.position_m, record_.wanted_position_m);
    copy(wanted.velocity_m_s, record_.wanted_velocity_m_s);
    copy(wanted.acceleration_m_s2, record_.wanted_acceleration_m_s2);
    copy(wanted.jerk_m_s3, record_.wanted_jerk_m_s3);
    record_.wanted_yaw_rad = wanted.yaw_rad;
    record_.wanted_yaw_rate_rad_s = wanted.yaw_rate_rad_s;
    return Controller::set_point(time_us, wanted);
  }

  /// A model that does not ask for it has nothing to record.
  Status battery_voltage(std::uint64_t time_us, float volts) noexcept {
    if constexpr (Controller::asks_for_voltage) {
      note(voltage_bit);
      record_.voltage_us = time_us;
      record_.battery_voltage = volts;
    }
    return Controller::battery_voltage(time_us, volts);
  }

  void jump(const LocalState& by, float yaw_rad) noexcept {
    begin();
    Controller::jump(by, yaw_rad);
    for (int i = 0; i < 3; ++i) {
      record_.jump_position_m[i] += by.position_m[i];
      record_.jump_velocity_m_s[i] += by.velocity_m_s[i];
    }
    record_.jump_yaw_rad += yaw_rad;
  }

  Reaction step(std::uint64_t now_us, Commands<float>& commands, StepReport& report) noexcept {
    const Reaction reaction = Controller::step(now_us, commands, report);
    finish(now_us, report, 1);
    if (reaction != Reaction::gives_up) {
      for (std::size_t i = 0; i < commands.size(); ++i) record_.commands[i] = commands[i];
    }
    return reaction;
  }
  void skip(std::uint64_t now_us) noexcept {
    Controller::skip(now_us);
    finish(now_us, {}, 0);
  }

  /// The last tick.
  const CoreRecord& record() const noexcept { return record_; }

 private:
  static void copy(const Vector3<float>& from, float (&to)[3]) noexcept {
    for (int i = 0; i < 3; ++i) to[i] = from[i];
  }
  void begin() noexcept {
    if (finished_) {
      record_.came = 0;
      record_.jump_yaw_rad = 0;
      for (int i = 0; i < 3; ++i) record_.jump_position_m[i] = record_.jump_velocity_m_s[i] = 0;
    }
    finished_ = false;
  }
  PINNQUAD_NOINLINE void note(std::uint8_t bit) noexcept {
    begin();
    record_.came = static_cast<std::uint8_t>(record_.came | bit);
  }
  /// Out of line: its stack is free while the controller steps.
  PINNQUAD_NOINLINE void finish(std::uint64_t now_us, const StepReport& report, std::uint8_t asked) noexcept {
    begin();
    finished_ = true;
    record_.timestamp = now_us;
    ++record_.tick;
    record_.model = Controller::model_checksum();
    record_.refused_samples = Controller::refused_samples();
    record_.asked = asked;
    record_.drives_motors = Controller::situation().drives_motors ? 1 : 0;
    record_.landed = Controller::situation().landed ? 1 : 0;
    record_.learning = static_cast<std::uint8_t>(Controller::learning());
    record_.learnt = Controller::learnt();
    record_.lift = Controller::lift();
    const auto &own = Controller::bias().learnt(), &analytic = Controller::analytic_bias().learnt();
    for (std::size_t k = 0; k < own.sums.size(); ++k) {
      record_.bias_sums[k] = own.sums[k];
      record_.analytic_bias_sums[k] = analytic.sums[k];
    }
    copy(analytic.across_m_s2, record_.bias_across_m_s2);
    for (int i = 0; i < 2; ++i) record_.bias_across_rate_m_s3[i] = analytic.across_rate_m_s3[i];
    record_.bias_noise = own.roll_pitch_noise;
    record_.analytic_bias_noise = analytic.roll_pitch_noise;
    record_.bias_across_noise_m_s2 = analytic.across_noise_m_s2;
    record_.bias_waited_s = own.waited_s;
    record_.analytic_bias_waited_s = analytic.waited_s;
    record_.bias_status = static_cast<std::uint8_t>(own.status);
    record_.analytic_bias_status = static_cast<std::uint8_t>(analytic.status);
    record_.reaction = static_cast<std::uint8_t>(report.reaction);
    record_.status = static_cast<std::uint8_t>(report.status);
    record_.cause = static_cast<std::uint8_t>(report.cause);
    record_.stale_inputs = report.stale_inputs;
    record_.envelope_feature = static_cast<std::int8_t>(report.worst_feature);
    record_.envelope_excess = report.worst_excess;
    record_.squared_distance = report.squared_distance;
    record_.innovation = Controller::command_residual();
    record_.trusted = Controller::trusted() ? 1 : 0;
    for (float& u : record_.commands) u = std::numeric_limits<float>::quiet_NaN();
  }

  CoreRecord record_{};
  bool finished_ = false;
};

}  // namespace pinnquad::autopilot
