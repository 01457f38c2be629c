// SPDX-License-Identifier: MIT
// The controller that px4_module and crazyflie_app share: state and set point -> wanted accelerations (FlightController)
// -> motor commands (the network behind its guard, the formula where it declines) -> output limits.
// NED, FRD, SI units; no heap, no exceptions, no clock of its own.
#pragma once

#include <cmath>

#include "flight_stacks/core_record.hpp"
#include "flight_stacks/inputs.hpp"
#include "flight_stacks/model_slots.hpp"

namespace flight_stacks {

/// What neither rotor nor sound network asks for: the formula is asked instead.
struct AbsurdCommands {
  static constexpr double lower = -0.5;
  static constexpr double upper = 1.5;
};

struct OutputLimits {
  float lower = 0.02f;  ///< rotors keep turning
  float upper = 1.0f;
};

/// What a step did, and why.
struct StepReport {
  Reaction reaction{Reaction::gives_up};
  bool body_rates_stale{false};
  bool attitude_stale{false};
  bool local_stale{false};
  bool set_point_stale{false};
  pinnquad::Status status{pinnquad::Status::ok};  ///< of outer loop and inverse; ok where neither was asked
  pinnquad::Status cause{pinnquad::Status::ok};   ///< what the network alone came to
  float worst_excess{0};                          ///< how far outside its envelope, in half-widths; 0 inside
  int worst_feature{-1};                          ///< which feature, -1 if none

  /// As bits: 1 body rates, 2 attitude, 4 position and velocity, 8 set point.
  std::uint8_t stale_inputs() const noexcept {
    return static_cast<std::uint8_t>((body_rates_stale ? 1 : 0) | (attitude_stale ? 2 : 0) | (local_stale ? 4 : 0) |
                                     (set_point_stale ? 8 : 0));
  }
};

/// `Shape` says what a model block must hold: an exported header. `View` opens the block; on the ground it may be one whose
/// network is known at run time alone (tools/model/replay_core.hpp).
template <class Shape, class View = pinnquad::ModelView<Shape>>
class NeuralController {
 public:
  using Vehicle = pinnquad::Quadrotor<float, pinnquad::QuadraticDrag>;
  using Formula = pinnquad::AnalyticInverse<Vehicle>;
  using Guard =
      pinnquad::Extend<pinnquad::TrainingGuard, pinnquad::RefuseCommands<AbsurdCommands>, pinnquad::Fallback<Formula>>;
  using Inverse = pinnquad::InverseDynamics<View, Guard>;
  static_assert(std::is_same_v<typename Shape::Scalar, float>, "flight stacks fly float models");

  explicit NeuralController(const AgeLimits& ages = {}, const OutputLimits& outputs = {},
                            const pinnquad::FlightGains<float>& gains = {}) noexcept
      : NeuralController(pinnquad::airframe_value<typename Shape::Vehicle, float>(), ages, outputs, gains) {}
  /// Of an airframe that is known at run time alone.
  explicit NeuralController(const pinnquad::Airframe<float>& airframe, const AgeLimits& ages = {},
                            const OutputLimits& outputs = {}, const pinnquad::FlightGains<float>& gains = {}) noexcept
      : ages_(ages),
        outputs_(outputs),
        vehicle_(airframe),
        outer_loop_(gains, pinnquad::flight_limits(vehicle_.airframe(), 1.0f, gains)),
        models_(Guard(Formula(vehicle_))) {}
  NeuralController(const NeuralController&) = delete;  // slots are pointed to
  NeuralController& operator=(const NeuralController&) = delete;

  /// At boot, and in flight from another thread: see ModelSlots::offer().
  pinnquad::Status offer_model(const void* block, std::size_t length) noexcept {
    const pinnquad::Status status = models_.offer(block, length);
    if (status == pinnquad::Status::ok && !ready_) ready_ = true;  // not written in flight: the control thread reads it
    return status;
  }
  /// True once a model was accepted.
  bool ready() const noexcept { return ready_; }
  bool model_settled() const noexcept { return models_.settled(); }

  /// Each input: `not_finite`, `out_of_range`, `not_unit_quaternion` for a sample that is refused.
  pinnquad::Status body_rates(std::uint64_t time_us, const pinnquad::Vector3<float>& rates_rad_s) noexcept {
    return rates_.accept(time_us, rates_rad_s, check_sample(rates_rad_s));
  }
  /// Normalised, where the norm is within unit_quaternion_tolerance of 1.
  pinnquad::Status attitude(std::uint64_t time_us, const pinnquad::Quaternion<float>& q) noexcept {
    using pinnquad::Status;
    const float numbers[4] = {q.w, q.x, q.y, q.z};
    if (!pinnquad::all_finite(numbers, 4)) return attitude_.accept(time_us, q, Status::not_finite);
    if (!pinnquad::is_unit(q)) return attitude_.accept(time_us, q, Status::not_unit_quaternion);
    return attitude_.accept(time_us, pinnquad::normalized(q), Status::ok);
  }
  pinnquad::Status local(std::uint64_t time_us, const LocalState& state) noexcept {
    const pinnquad::Status position = check_sample(state.position_m);
    return local_.accept(time_us, state,
                         position == pinnquad::Status::ok ? check_sample(state.velocity_m_s) : position);
  }
  /// A number that is not finite is not asked for, axis by axis, as in PX4's trajectory set point. `not_finite` if it asks for no
  /// position, no velocity and no acceleration.
  pinnquad::Status set_point(std::uint64_t time_us, const pinnquad::TrajectoryPoint<float>& wanted) noexcept {
    pinnquad::Status checked = pinnquad::Status::not_finite;
    for (const auto* v : {&wanted.position_m, &wanted.velocity_m_s, &wanted.acceleration_m_s2, &wanted.jerk_m_s3}) {
      for (int i = 0; i < 3; ++i) {
        if (!pinnquad::is_finite((*v)[i])) continue;
        if ((*v)[i] > most_plausible || (*v)[i] < -most_plausible) {
          return set_point_.accept(time_us, wanted, pinnquad::Status::out_of_range);
        }
        if (v != &wanted.jerk_m_s3) checked = pinnquad::Status::ok;
      }
    }
    return set_point_.accept(time_us, wanted, checked);
  }

  /// One tick: motor commands in the airframe's rotor order, within the output limits. `commands` is untouched where
  /// the reaction is gives_up. The time between two calls does not matter; `now_us` is of the samples' clock.
  Reaction step(std::uint64_t now_us, pinnquad::Commands<float>& commands, StepReport& report) noexcept {
    report = {};
    const Inverse* inverse = models_.take();
    checksum_ = models_.checksum(inverse);
    Reaction reaction = inverse == nullptr ? Reaction::gives_up : judge_ages(now_us, report);
    if (reaction <= Reaction::levels) {
      pinnquad::Commands<float> answer{};
      report.status = ask(*inverse, reaction, answer, report);
      if (pinnquad::has_output(report.status)) {
        last_commands_ = within_limits(answer);
        answered_us_ = now_us;
        answered_ = true;
      } else {
        reaction = Reaction::keeps_commands;
      }
    }
    if (reaction == Reaction::keeps_commands && !(answered_ && now_us - answered_us_ <= ages_.keep_us)) {
      reaction = Reaction::gives_up;
    }
    if (reaction != Reaction::gives_up) commands = last_commands_;
    report.reaction = reaction;
    return reaction;
  }

  /// A tick in which the stack asks nothing: off, or flown by hand. For who writes down every tick (recorded_controller.hpp).
  void skip(std::uint64_t /*now_us*/) noexcept {}

  /// What it was made with.
  CoreSettings settings() const noexcept {
    const auto us = [](std::uint64_t time_us) noexcept { return static_cast<std::uint32_t>(time_us); };
    const pinnquad::FlightGains<float>& gains = outer_loop_.gains();
    CoreSettings all;
    all.body_rates_us = us(ages_.body_rates_us);
    all.attitude_us = us(ages_.attitude_us);
    all.local_us = us(ages_.local_us);
    all.set_point_us = us(ages_.set_point_us);
    all.keep_us = us(ages_.keep_us);
    all.level_us = us(ages_.level_us);
    all.lowest_command = outputs_.lower;
    all.highest_command = outputs_.upper;
    all.position_1_s = gains.position_1_s;
    all.velocity_1_s = gains.velocity_1_s;
    all.tilt_1_s = gains.tilt_1_s;
    all.yaw_1_s = gains.yaw_1_s;
    all.roll_pitch_rate_1_s = gains.roll_pitch_rate_1_s;
    all.yaw_rate_1_s = gains.yaw_rate_1_s;
    return all;
  }

  /// Of the block whose model the last step asked; 0: none.
  std::uint32_t model_checksum() const noexcept { return checksum_; }

  /// How often the network was asked since the start, and what it came to; the rest fell back to the formula.
  const pinnquad::FallbackCount& count() const noexcept { return count_; }
  std::uint32_t refused_samples() const noexcept {
    return rates_.refused() + attitude_.refused() + local_.refused() + set_point_.refused();
  }
  /// Fills what both stacks publish, in messages whose fields have the same names.
  template <class Message>
  void describe(const StepReport& report, Message& message) const noexcept {
    message.asked = count_.asked;
    message.refused_samples = refused_samples();
    message.fallback_share =
        count_.asked > 0 ? static_cast<float>(count_.fallbacks()) / static_cast<float>(count_.asked) : 0.0f;
    message.envelope_excess = report.worst_excess;
    message.envelope_feature = static_cast<std::int8_t>(report.worst_feature);
    message.reaction = static_cast<std::uint8_t>(report.reaction);
    message.status = static_cast<std::uint8_t>(report.status);
    message.cause = static_cast<std::uint8_t>(report.cause);
    message.stale_inputs = report.stale_inputs();
  }
  const Vehicle& vehicle() const noexcept { return vehicle_; }

 private:
  Reaction judge_ages(std::uint64_t now_us, StepReport& report) noexcept {
    report.body_rates_stale = !rates_.fresh(now_us, ages_.body_rates_us);
    report.attitude_stale = !attitude_.fresh(now_us, ages_.attitude_us);
    report.local_stale = !local_.fresh(now_us, ages_.local_us);
    report.set_point_stale = !set_point_.fresh(now_us, ages_.set_point_us);
    if (!report.set_point_stale) holding_ = false;
    if (report.body_rates_stale || report.attitude_stale) return Reaction::keeps_commands;
    if (report.local_stale) {
      return local_.fresh(now_us, ages_.local_us + ages_.level_us) ? Reaction::levels : Reaction::gives_up;
    }
    return report.set_point_stale ? Reaction::holds_position : Reaction::flies;
  }

  pinnquad::State<float> state() const noexcept {
    return {local_.value().position_m, local_.value().velocity_m_s, attitude_.value(), rates_.value()};
  }

  /// The point of a trajectory that a reaction flies to; what was not asked for is what the vehicle does already.
  pinnquad::TrajectoryPoint<float> target(Reaction reaction, const pinnquad::State<float>& now) noexcept {
    pinnquad::TrajectoryPoint<float> point;
    const pinnquad::Heading<float> heading = pinnquad::heading(now.attitude);
    point.yaw_rad = std::atan2(heading.sine, heading.cosine);
    if (reaction == Reaction::levels) {  // no errors: no feedback of what is not known
      point.position_m = now.position_m;
      point.velocity_m_s = now.velocity_m_s;
      return point;
    }
    if (reaction == Reaction::holds_position) {
      if (!holding_) {
        held_.position_m = now.position_m;
        held_.yaw_rad = point.yaw_rad;
        holding_ = true;
      }
      return held_;
    }
    const pinnquad::TrajectoryPoint<float>& wanted = set_point_.value();
    for (int i = 0; i < 3; ++i) {
      const bool place = pinnquad::is_finite(wanted.position_m[i]);
      point.position_m[i] = place ? wanted.position_m[i] : now.position_m[i];
      point.velocity_m_s[i] = or_else(wanted.velocity_m_s[i], place ? 0.0f : now.velocity_m_s[i]);
      point.acceleration_m_s2[i] = or_else(wanted.acceleration_m_s2[i], 0.0f);
      point.jerk_m_s3[i] = or_else(wanted.jerk_m_s3[i], 0.0f);
    }
    point.acceleration_m_s2 = outer_loop_.limited(point.acceleration_m_s2);
    point.yaw_rad = or_else(wanted.yaw_rad, point.yaw_rad);
    point.yaw_rate_rad_s = or_else(wanted.yaw_rate_rad_s, 0.0f);
    return point;
  }

  static float or_else(float value, float otherwise) noexcept { return pinnquad::is_finite(value) ? value : otherwise; }

  /// Outer loop, then the inverse. The network answers the whole demand, feed-forward and feedback together.
  pinnquad::Status ask(const Inverse& inverse, Reaction reaction, pinnquad::Commands<float>& commands,
                       StepReport& report) noexcept {
    const pinnquad::State<float> now = state();
    pinnquad::TrackingDemand<float> demand;
    const pinnquad::Status outer = outer_loop_(now, target(reaction, now), demand);
    if (outer != pinnquad::Status::ok) return outer;
    pinnquad::Accelerations<float> wanted;
    wanted.linear_m_s2 = demand.reference.linear_m_s2 + demand.feedback_acceleration_m_s2;
    wanted.angular_rad_s2 = demand.reference.angular_rad_s2 + demand.feedback_angular_acceleration_rad_s2;
    // rotors make no lateral force: what gravity and rotation leave of it is what the network has seen
    const float gravity = vehicle_.site().gravity_m_s2;
    const pinnquad::Vector3<float> free = pinnquad::body_derivative<float>(now, {0.0f, 0.0f, gravity});
    wanted.linear_m_s2[0] = free[0];
    wanted.linear_m_s2[1] = free[1];
    typename Inverse::Report why;
    const pinnquad::Status status = inverse.predict(pinnquad::motion_inputs(now, wanted), commands, why);
    count_.add(why.cause);
    report.cause = why.cause;
    report.worst_feature = why.worst_feature;
    if (why.worst_feature >= 0) report.worst_excess = why.excess[static_cast<std::size_t>(why.worst_feature)];
    return status;
  }

  pinnquad::Commands<float> within_limits(const pinnquad::Commands<float>& commands) const noexcept {
    pinnquad::Commands<float> result = pinnquad::keep_torque(vehicle_.rotors(), commands);
    for (float& u : result) u = u < outputs_.lower ? outputs_.lower : (u > outputs_.upper ? outputs_.upper : u);
    return result;
  }

  AgeLimits ages_;
  OutputLimits outputs_;
  Vehicle vehicle_;
  pinnquad::FlightController<float> outer_loop_;
  ModelSlots<Inverse> models_;
  Input<pinnquad::Vector3<float>> rates_;
  Input<pinnquad::Quaternion<float>> attitude_;
  Input<LocalState> local_;
  Input<pinnquad::TrajectoryPoint<float>> set_point_;
  pinnquad::TrajectoryPoint<float> held_;
  bool holding_ = false;
  pinnquad::Commands<float> last_commands_{};
  std::uint64_t answered_us_ = 0;
  bool answered_ = false;
  bool ready_ = false;
  std::uint32_t checksum_ = 0;
  pinnquad::FallbackCount count_{};
};

}  // namespace flight_stacks
