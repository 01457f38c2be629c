// SPDX-License-Identifier: MIT
// The controller of an autopilot's core: state and set point -> wanted accelerations (FlightController) -> motor
// commands (the network behind its guard, the analytic inverse where it declines) -> output limits.
// examples/px4_module and examples/crazyflie_app fly it. NED, FRD, SI units; no clock of its own.
#pragma once

#include "pinnquad/control/autopilot/core_settings.hpp"
#include "pinnquad/control/autopilot/inputs.hpp"
#include "pinnquad/control/autopilot/learnt_vehicle.hpp"
#include "pinnquad/control/autopilot/model_inputs.hpp"
#include "pinnquad/control/autopilot/model_slots.hpp"
#include "pinnquad/control/autopilot/state_samples.hpp"
#include "pinnquad/control/autopilot/take_off.hpp"
#include "pinnquad/control/bias_learner.hpp"
#include "pinnquad/control/desaturate.hpp"
#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/control/leaning.hpp"
#include "pinnquad/inference/analytic_inverse.hpp"
#include "pinnquad/inference/guard.hpp"

namespace pinnquad::autopilot {

/// `Shape`: an exported header, whose blocks it flies. `View` opens a block; on the ground its network may be known at
/// run time alone (tools/model/replay_core.hpp). `VehicleType`: a Quadrotor, airframe and effects of the analytic
/// inverse. `Trust`: the struct of trust.hpp beside the model (docs/trust.md), beyond whose limits the analytic inverse
/// flies; void: neither distance nor command residual is measured. `Onboard`: OnboardInverse<float>, which answers in
/// the model's place while the stack asks it to learn (docs/onboard.md); void: a controller that pays nothing for it.
template <class Shape, class View = ModelView<Shape>, class VehicleType = Quadrotor<float, QuadraticDrag>,
          class Trust = void, class Onboard = void>
class NeuralController {
  static constexpr bool trusts = pinnquad::detail::FlownTrust<Trust>::known;
  static constexpr bool has_onboard = !std::is_void_v<Onboard>;
  using ModelInputs = detail::ModelInputs<typename Shape::Features>;

 public:
  /// False: the voltage is of no use to the model, and battery_voltage() does nothing.
  static constexpr bool asks_for_voltage = ModelInputs::asks_for_voltage;
  using Vehicle = VehicleType;
  using Analytic = AnalyticInverse<Vehicle>;
  /// Without Fallback: step() asks the analytic inverse itself, below which the network's stack is free again.
  using NetworkGuard =
      std::conditional_t<trusts, Extend<TrainingGuard, JointDistance<Trust>, RefuseCommands<detail::AbsurdCommands>>,
                         Extend<TrainingGuard, RefuseCommands<detail::AbsurdCommands>>>;
  using Inverse = InverseDynamics<View, NetworkGuard>;
  using Learner = pinnquad::detail::BiasLearner<float, 2, FlownMotion<float>, Trust>;
  static_assert(std::is_same_v<typename Shape::Scalar, float>, "flight stacks fly float models");
  static_assert(!trusts || ModelInputs::of_motion_alone,
                "pinnquad: limits of trust are those of a model of the present motion alone: fly one with a window or "
                "a column without them (docs/trust.md)");

  explicit NeuralController(const CoreSettings& settings = {}) noexcept
      : NeuralController(Vehicle(airframe_value<typename Shape::Vehicle, float>()), settings) {}
  /// For an airframe that is known at run time alone, or effects with values of their own.
  explicit NeuralController(const Vehicle& vehicle, const CoreSettings& settings = {}) noexcept
      : settings_(detail::with_effects(settings, vehicle)),
        vehicle_(vehicle),
        analytic_(vehicle_),
        outer_loop_(detail::outer_loop(settings, vehicle_.airframe(), vehicle_.site().gravity_m_s2)),
        models_(NetworkGuard{}),
        learner_(vehicle_.airframe(), detail::bias_settings(settings),
                 FlownMotion<float>(25'000, vehicle_.airframe().rise_time_constant_s(0), settings.state_delay_s)),
        take_off_(settings.take_off_s),
        learnt_(vehicle_.airframe(), settings) {
    settings_.distance_limit = settings_.innovation_limit = 0;
    if constexpr (trusts) {
      settings_.distance_limit = static_cast<float>(NetworkGuard::Distribution::squared_distance_limit);
      settings_.innovation_limit = static_cast<float>(Trust::command_residual_limit);
    }
  }
  NeuralController(const NeuralController&) = delete;  // slots are pointed to
  NeuralController& operator=(const NeuralController&) = delete;

  /// ModelSlots::offer(), at boot, and in flight from another thread. A model of other training data than that of the
  /// limits of trust is `block_incompatible`.
  Status offer_model(const void* block, std::size_t length) noexcept {
    const Status status = models_.offer(block, length, pinnquad::detail::training_data<Trust>());
    if (status == Status::ok && !ready_) ready_ = true;  // not written in flight: the control thread reads it
    return status;
  }
  /// True once a model was accepted.
  bool ready() const noexcept { return ready_; }
  bool model_settled() const noexcept { return models_.settled(); }

  /// Inputs, each `not_finite`, `out_of_range` or `not_unit_quaternion` for a sample that is refused. rad/s, FRD.
  Status body_rates(std::uint64_t time_us, const Vector3<float>& rates_rad_s) noexcept {
    const Status status = samples_.body_rates(time_us, rates_rad_s);
    if (status == Status::ok) learner_.motion().body_rates(time_us, rates_rad_s);
    return status;
  }
  /// Body -> world; normalised, where the norm is within unit_quaternion_tolerance of 1.
  Status attitude(std::uint64_t time_us, const Quaternion<float>& q) noexcept { return samples_.attitude(time_us, q); }
  Status local(std::uint64_t time_us, const LocalState& state) noexcept {
    const Status status = samples_.local(time_us, state);
    if (status == Status::ok) learner_.motion().velocity(time_us, state.velocity_m_s);
    return status;
  }
  /// A number that is not finite is not asked for, axis by axis, as in PX4's trajectory set point. Snap and the yaw's
  /// acceleration are not taken: no flight stack sends them, no record holds them.
  Status set_point(std::uint64_t time_us, const TrajectoryPoint<float>& wanted) noexcept {
    return samples_.set_point(time_us, wanted);
  }

  /// Takes the voltage of the pack under load, for a model that asks for it. `not_finite`, `out_of_range`: refused.
  Status battery_voltage(std::uint64_t time_us, float volts) noexcept { return model_inputs_.voltage(time_us, volts); }

  /// Given before each step, by a stack that knows. Until then the commands drive nothing and the vehicle is in the
  /// air. A controller that takes over holds the place of that moment.
  void situation(const Situation& now) noexcept {
    if (now.drives_motors && !situation_.drives_motors) samples_.hold_anew();
    situation_ = now;
  }
  const Situation& situation() const noexcept { return situation_; }

  /// A reset of the estimator, the step of its estimate: the held place and the set point move with it.
  void jump(const LocalState& by, float yaw_rad) noexcept {
    samples_.jump(by, yaw_rad);
    learner_.motion().interrupt();
    model_inputs_.clear();
    jumped_ = true;
  }

  /// The bias of the network's commands, which learns nothing where its network does not answer; the learner's bias
  /// where that one answers.
  const pinnquad::detail::MotionBias<float>& bias() const noexcept {
    if constexpr (has_onboard) {
      if (learns()) return learnt_.onboard().bias();
    }
    return learner_.own();
  }
  /// The vehicle as it is learnt: its certificate, candidate, rows.
  const auto& onboard() const noexcept { return learnt_.onboard(); }
  /// The use of the learner that the last situation asked for; off without one.
  Learning learning() const noexcept { return has_onboard ? situation_.learning : Learning::off; }
  /// CoreRecord::learnt.
  std::uint8_t learnt() const noexcept { return static_cast<std::uint8_t>(learnt_.bits()); }
  /// Bias of the analytic inverse's commands, and the acceleration across the thrust, whoever answers.
  const pinnquad::detail::MotionBias<float>& analytic_bias() const noexcept { return learner_.last(); }
  /// Share of the thrust that it uses, 0 to 1: below 1 at take-off and landing.
  float lift() const noexcept { return take_off_.lift(); }
  /// Mean error of the model's commands, bias included, about the flown motion; 0 without limits of trust.
  float command_residual() const noexcept { return learner_.trust().command_residual(); }
  /// False while the command residual is above its limit.
  bool trusted() const noexcept { return learner_.trust().trusted(); }
  const Learner& learner() const noexcept { return learner_; }
  /// Goes on from a logged tick (replay).
  void resume(const CoreRecord& logged) noexcept {
    detail::resume_biases(logged, learner_);
    learner_.trust().resume(logged.innovation, logged.trusted != 0);
    // where the command residual is below its limit, `distrusted` is the bias that stood at its bound
    if (logged.trusted != 0 && logged.reaction <= static_cast<std::uint8_t>(Reaction::levels) && logged.asked != 0) {
      learner_.hand_over(logged.cause == static_cast<std::uint8_t>(Status::distrusted));
    }
    take_off_.resume(logged.lift);
    if (logged.asked != 0 && logged.reaction <= static_cast<std::uint8_t>(Reaction::levels)) {
      for (std::size_t i = 0; i < last_commands_.size(); ++i) last_commands_[i] = logged.commands[i];
      answered(logged.timestamp);
    }
  }

  /// The biases of a logged tick, before its step: it learns nothing then. For a replay that lacks the ticks before.
  void give_biases(const CoreRecord& logged) noexcept {
    detail::resume_biases(logged, learner_);
    learner_.give();
  }

  /// One tick: motor commands in the airframe's rotor order, within the output limits. `commands` is untouched where
  /// the reaction is gives_up. `now_us` is of the samples' clock; any time may lie between two calls.
  Reaction step(std::uint64_t now_us, Commands<float>& commands, StepReport& report) noexcept {
    report = {};
    model_inputs_.tick(now_us);
    const Inverse* inverse = models_.take();
    if (checksum_ != models_.checksum(inverse)) take_model(*inverse);
    Reaction reaction = inverse == nullptr
                            ? Reaction::gives_up
                            : samples_.judge_ages(now_us, settings_, model_inputs_.voltage_is_fresh(), report);
    take_off_.update(now_us, situation_, samples_.vertical_motion(reaction, expected_m_s2_[2], settings_.position_1_s));
    limit_demand();
    learn(now_us, reaction, inverse);
    if (reaction <= Reaction::levels) {
      Commands<float> answer{};
      report.status =
          learns() ? ask_onboard(now_us, reaction, answer, report) : ask(*inverse, reaction, answer, report);
      if (has_output(report.status)) {
        last_commands_ = desaturate(vehicle_.rotors(), answer, settings_.lowest_command, settings_.highest_command);
        const float lift = take_off_.lift();
        const float idle = settings_.lowest_command;
        for (float& u : last_commands_) u = lift < 1.0f ? idle + lift * (u - idle) : u;
        answered(now_us);
      } else {
        reaction = Reaction::keeps_commands;
      }
    }
    if (reaction == Reaction::keeps_commands && !(answered_ && now_us - answered_us_ <= settings_.keep_us)) {
      reaction = Reaction::gives_up;
    }
    if (reaction != Reaction::gives_up) commands = last_commands_;
    report.reaction = reaction;
    return reaction;
  }

  /// A tick in which the stack asks nothing: off, or flown by hand. A controller that records has one per tick.
  void skip(std::uint64_t now_us) noexcept {
    take_off_.skip(situation_);
    learn(now_us, Reaction::gives_up, nullptr);
  }

  /// The settings that it was made with, its vehicle's effects and the limits of trust.
  const CoreSettings& settings() const noexcept { return settings_; }

  /// Checksum of the block whose model the last step asked; 0: none.
  std::uint32_t model_checksum() const noexcept { return checksum_; }

  /// The network's answers since the start, by Status.
  const FallbackCount& count() const noexcept { return count_; }
  std::uint32_t refused_samples() const noexcept { return samples_.refused() + model_inputs_.refused(); }
  /// Fills a message of PX4 or the Crazyflie: their fields have the same names.
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
    message.stale_inputs = report.stale_inputs;
    message.bias_status = static_cast<std::uint8_t>(bias().status());
  }
  const Vehicle& vehicle() const noexcept { return vehicle_; }

 private:
  /// The last commands are of this tick.
  void answered(std::uint64_t now_us) noexcept {
    answered_us_ = now_us;
    answered_ = true;
  }

  /// Not that of the last tick. A replay's first tick has the biases already.
  PINNQUAD_NOINLINE void take_model(const Inverse& inverse) noexcept {
    if (checksum_ != 0) learner_.another_model();
    checksum_ = models_.checksum(&inverse);
    const BiasSettings<float> own = pinnquad::bias_settings<float>(inverse.model().facts);
    learner_.time_constants(detail::bias_time_constants_s(settings_, own));
  }

  bool learns() const noexcept { return learning() != Learning::off; }

  /// A tick of the vehicle that is learnt, and of the demand's limits, which are those of what flies.
  PINNQUAD_NOINLINE void learn_vehicle(const typename Learner::Tick& tick) noexcept {
    if constexpr (has_onboard) {
      if (learnt_.hands_back(tick.now_us, learning())) learner_.another_model();
      if (!learns()) return;
      learner_.own().reset();  // the network is not asked
      learnt_.learn(tick.now_us, learning(), tick.known && !tick.freezes && !jumped_, samples_.state(), last_commands_);
    } else {
      static_cast<void>(tick);
    }
  }
  /// The demand's limits are those of the vehicle as it flies, after the rows until the tick before. Out of line, and
  /// not below learn(): it takes more stack than a tick of the learner.
  PINNQUAD_NOINLINE void limit_demand() noexcept {
    if constexpr (has_onboard) {
      if (!learnt_.another_vehicle(learns())) return;
      outer_loop_ = detail::outer_loop(settings_, learns() ? learnt_.onboard().airframe() : vehicle_.airframe(),
                                       vehicle_.site().gravity_m_s2);
    }
  }

  /// A tick for the biases. Out of line, as target() is.
  PINNQUAD_NOINLINE void learn(std::uint64_t now_us, Reaction reaction, const Inverse* inverse) noexcept {
    typename Learner::Tick tick;
    tick.now_us = now_us;
    tick.in_flight = situation_.in_flight();
    tick.known = tick.in_flight && answered_ && reaction <= Reaction::holds_position;
    tick.freezes = tick.known && (take_off_.lift() < 1.0f || take_off_.may_stand());
    tick.on_ground = !(take_off_.lift() > 0);
    const auto network = [this, inverse](const MotionInputs<float>& motion, Commands<float>& said,
                                         Vector3<float>&) noexcept {
      return learns() ? Status::distrusted : inverse->observed(model_inputs_.lasting(motion), said);
    };
    const auto analytic = [this](const MotionInputs<float>& motion, Commands<float>& said, Vector3<float>&) noexcept {
      return analytic_(motion, said);
    };
    learn_vehicle(tick);
    jumped_ = false;
    learner_.learn(tick, samples_.state(), last_commands_, network, analytic);
  }

  /// Outer loop, then the inverse. The network answers the whole demand, feed-forward and feedback together. Fresh,
  /// finite inputs always get an answer: the demand is limited (want()), never refused. An analytic inverse declines
  /// where an effect of its vehicle has no answer.
  Status ask(const Inverse& inverse, Reaction reaction, Commands<float>& commands, StepReport& report) noexcept {
    MotionInputs<float> wanted;
    const Status outer = want(reaction, wanted);
    if (outer != Status::ok) return outer;
    const typename Inverse::Inputs& inputs = model_inputs_.take(wanted);
    const Status status = learner_.answer(
        commands, report.cause,
        [&](Commands<float>& said) noexcept { return ask_network(inverse, inputs, said, report); },
        // not refused for its size: the demand is limited, and desaturate() brings what is left into the range
        [&](Commands<float>& said) noexcept { return analytic_(wanted, said); });
    count_.add(report.cause);
    return status;
  }

  /// The vehicle that is learnt, and the analytic inverse where it declines.
  PINNQUAD_NOINLINE Status ask_onboard([[maybe_unused]] std::uint64_t now_us, [[maybe_unused]] Reaction reaction,
                                       [[maybe_unused]] Commands<float>& commands,
                                       [[maybe_unused]] StepReport& report) noexcept {
    if constexpr (has_onboard) {
      const State<float> now = samples_.state();
      Accelerations<float> wanted;
      const Status outer = want_leaning(reaction, now, wanted);
      if (outer != Status::ok) return outer;
      report.cause = learnt_.onboard()(now, wanted, now_us, commands);
      count_.add(report.cause);
      if (has_output(report.cause)) return report.cause;
      Commands<float> said{};
      if (!has_output(analytic_(motion_inputs(now, wanted), said))) return report.cause;
      learner_.last().add_to(said);
      commands = said;
      return Status::fell_back;
    } else {
      return Status::out_of_range;
    }
  }

  PINNQUAD_NOINLINE static Status ask_network(const Inverse& inverse, const typename Inverse::Inputs& inputs,
                                              Commands<float>& commands, StepReport& report) noexcept {
    typename Inverse::Report why;
    const Status status = inverse.predict(inputs, commands, why);
    report.worst_feature = why.worst_feature;
    report.squared_distance = why.squared_distance;
    if (why.worst_feature >= 0) report.worst_excess = why.excess[static_cast<std::size_t>(why.worst_feature)];
    return status;
  }

  /// The motion that a reaction wants. Out of line, as target() is: its stack is free again below network and analytic
  /// inverse, where the stack is deepest.
  PINNQUAD_NOINLINE Status want(Reaction reaction, MotionInputs<float>& motion) noexcept {
    const State<float> now = samples_.state();
    Accelerations<float> wanted;
    TrajectoryPoint<float> point = samples_.target(reaction, now);
    // a vehicle that levels: thrust alone, so that level stays level
    if (reaction != Reaction::levels) point.acceleration_m_s2 -= learner_.across_m_s2();
    const Status outer = demand(now, point, wanted);
    if (outer == Status::ok) motion = motion_inputs(now, wanted);
    return outer;
  }
  /// The wanted motion of a vehicle that is learnt: it knows its drag.
  PINNQUAD_NOINLINE Status want_leaning(Reaction reaction, const State<float>& now,
                                        Accelerations<float>& wanted) noexcept {
    TrajectoryPoint<float> point = samples_.target(reaction, now);
    if constexpr (has_onboard) {
      if (reaction != Reaction::levels) point = leaning(learnt_.onboard(), now, point, vehicle_.site().gravity_m_s2);
    }
    return demand(now, point, wanted);
  }
  PINNQUAD_ALWAYS_INLINE Status demand(const State<float>& now, const TrajectoryPoint<float>& point,
                                       Accelerations<float>& wanted) noexcept {
    Accelerations<float> feedback;
    const Status outer = outer_loop_(now, point, wanted, feedback);
    if (outer == Status::ok) expected_m_s2_ = world_acceleration<float>(now, wanted.linear_m_s2);
    return outer;
  }

  CoreSettings settings_;
  Vehicle vehicle_;
  Analytic analytic_;
  FlightController<float> outer_loop_;
  ModelSlots<Inverse> models_;
  detail::StateSamples samples_;
  Commands<float> last_commands_{};
  Learner learner_;
  Vector3<float> expected_m_s2_ = Vector3<float>::Zero();  ///< of the last answer, NED
  Situation situation_{};
  detail::TakeOff take_off_;
  std::uint64_t answered_us_ = 0;
  bool answered_ = false;
  bool ready_ = false;
  bool jumped_ = false;
  ModelInputs model_inputs_;
  std::uint32_t checksum_ = 0;
  FallbackCount count_{};
  detail::LearntVehicle<Onboard> learnt_;
};

}  // namespace pinnquad::autopilot
