// SPDX-License-Identifier: MIT
// State and set point that an autopilot's core was given, their ages, and the point that it flies to.
#pragma once

#include <cmath>

#include "pinnquad/control/autopilot/core_record.hpp"
#include "pinnquad/control/autopilot/inputs.hpp"
#include "pinnquad/control/autopilot/take_off.hpp"
#include "pinnquad/core/attributes.hpp"

namespace pinnquad::autopilot::detail {

/// The last good sample of each input. NED, FRD, SI units.
class StateSamples {
 public:
  /// Each `not_finite`, `out_of_range` or `not_unit_quaternion` for a sample that is refused. rad/s, FRD.
  Status body_rates(std::uint64_t time_us, const Vector3<float>& rates_rad_s) noexcept {
    return rates_.accept(time_us, rates_rad_s, check_sample(rates_rad_s));
  }
  /// Body -> world; normalised, where the norm is within unit_quaternion_tolerance of 1.
  Status attitude(std::uint64_t time_us, const Quaternion<float>& q) noexcept {
    const float numbers[4] = {q.w, q.x, q.y, q.z};
    if (!all_finite(numbers, 4)) return attitude_.accept(time_us, q, Status::not_finite);
    if (!is_unit(q)) return attitude_.accept(time_us, q, Status::not_unit_quaternion);
    return attitude_.accept(time_us, normalized(q), Status::ok);
  }
  Status local(std::uint64_t time_us, const LocalState& state) noexcept {
    Status checked = check_sample(state.position_m);
    if (checked == Status::ok) checked = check_sample(state.velocity_m_s);
    return local_.accept(time_us, state, checked);
  }
  Status set_point(std::uint64_t time_us, const TrajectoryPoint<float>& wanted) noexcept {
    return set_point_.accept(time_us, wanted, check_set_point(wanted));
  }
  std::uint32_t refused() const noexcept {
    return rates_.refused() + attitude_.refused() + local_.refused() + set_point_.refused();
  }

  State<float> state() const noexcept {
    return {local_.value().position_m, local_.value().velocity_m_s, attitude_.value(), rates_.value()};
  }

  /// The next place to hold is that of its moment.
  void hold_anew() noexcept { holding_ = false; }
  /// The held place and the set point move with a step of the estimate.
  void jump(const LocalState& by, float yaw_rad) noexcept {
    TrajectoryPoint<float> wanted = set_point_.value();
    wanted.position_m += by.position_m;
    wanted.yaw_rad += yaw_rad;
    set_point_.replace(wanted);
    held_position_m_ += by.position_m;
    held_yaw_rad_ += yaw_rad;
  }

  /// The reaction that the samples' ages allow; sets StepReport::stale_inputs.
  Reaction judge_ages(std::uint64_t now_us, const CoreSettings& settings, bool voltage_is_fresh,
                      StepReport& report) noexcept {
    const auto bit_if = [](bool stale, std::uint8_t bit) noexcept { return stale ? bit : std::uint8_t{0}; };
    report.stale_inputs =
        static_cast<std::uint8_t>(bit_if(!rates_.fresh(now_us, settings.body_rates_us), body_rates_bit) |
                                  bit_if(!attitude_.fresh(now_us, settings.attitude_us), attitude_bit) |
                                  bit_if(!local_.fresh(now_us, settings.local_us), local_bit) |
                                  bit_if(!set_point_.fresh(now_us, settings.set_point_us), set_point_bit) |
                                  bit_if(!voltage_is_fresh, voltage_bit));
    if (!report.stale(set_point_bit)) holding_ = false;
    if (report.stale(body_rates_bit | attitude_bit)) return Reaction::keeps_commands;
    if (report.stale(local_bit)) {
      return local_.fresh(now_us, std::uint64_t{settings.local_us} + settings.level_us) ? Reaction::levels
                                                                                        : Reaction::gives_up;
    }
    return report.stale(set_point_bit) ? Reaction::holds_position : Reaction::flies;
  }

  /// For take-off and landing. It climbs for 10 cm, 0.1 m/s or 0.1 m/s^2: less is an estimate's noise.
  VerticalMotion vertical_motion(Reaction reaction, float expected_fall_m_s2, float position_1_s) const noexcept {
    constexpr float noise = 0.1f;
    VerticalMotion motion;
    const Vector3<float>& velocity = local_.value().velocity_m_s;
    motion.sink_m_s = velocity[2];
    motion.along_m_s = std::sqrt(velocity[0] * velocity[0] + velocity[1] * velocity[1]);
    motion.expected_fall_m_s2 = expected_fall_m_s2;
    if (reaction != Reaction::flies) return motion;
    const TrajectoryPoint<float>& wanted = set_point_.value();
    const float below_m = wanted.position_m[2] - local_.value().position_m[2], sink_m_s = wanted.velocity_m_s[2];
    motion.asks_to_climb = below_m < -noise || sink_m_s < -noise || wanted.acceleration_m_s2[2] < -noise;
    if (is_finite(below_m)) motion.asked_sink_m_s = position_1_s * below_m;
    if (is_finite(sink_m_s)) motion.asked_sink_m_s += sink_m_s;
    return motion;
  }

  /// The point of a trajectory that a reaction flies to; where nothing is asked for, the vehicle's own motion. Out of
  /// line: its stack is free again below the inverse.
  PINNQUAD_NOINLINE TrajectoryPoint<float> target(Reaction reaction, const State<float>& now) noexcept {
    TrajectoryPoint<float> point;
    const Heading<float> heading = pinnquad::heading(now.attitude);
    point.yaw_rad = std::atan2(heading.sine, heading.cosine);
    if (reaction == Reaction::levels) {  // no errors: no feedback of what is not known
      point.position_m = now.position_m;
      point.velocity_m_s = now.velocity_m_s;
      return point;
    }
    if (reaction == Reaction::holds_position) {
      if (!holding_) {
        held_position_m_ = now.position_m;
        held_yaw_rad_ = point.yaw_rad;
        holding_ = true;
      }
      point.position_m = held_position_m_;
      point.yaw_rad = held_yaw_rad_;
      return point;
    }
    return completed(set_point_.value(), now, point.yaw_rad);
  }

 private:
  Input<Vector3<float>> rates_;
  Input<Quaternion<float>> attitude_;
  Input<LocalState> local_;
  Input<TrajectoryPoint<float>> set_point_;
  Vector3<float> held_position_m_ = Vector3<float>::Zero();
  float held_yaw_rad_ = 0;
  bool holding_ = false;
};

}  // namespace pinnquad::autopilot::detail
