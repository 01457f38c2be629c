// SPDX-License-Identifier: MIT
// The controller of an autopilot's core: state and set point -> wanted accelerations (FlightController) -> motor
// commands (the network behind its guard, the analytic inverse where it declines) -> output limits.
// examples/px4_module and examples/crazyflie_app fly it. NED, FRD, SI units; no clock of its own.
#pragma once

#include <cmath>

#include "pinnquad/control/autopilot/core_settings.hpp"
#include "pinnquad/control/autopilot/inputs.hpp"
#include "pinnquad/control/autopilot/model_inputs.hpp"
#include "pinnquad/control/autopilot/model_slots.hpp"
#include "pinnquad/control/autopilot/take_off.hpp"
#include "pinnquad/control/bias_learner.hpp"
#include "pinnquad/control/desaturate.hpp"
#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/control/leaning.hpp"
#include "pinnquad/control/onboard/onboard_inverse.hpp"
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
  using Learner = BiasLearner<float, 2, FlownMotion<float>, Trust>;
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
                 FlownMotion<float>({FlownMotionSettings<float>{}.period_us,
                                     vehicle_.airframe().rise_time_constant_s(0), settings.state_delay_s})),
        take_off_(settings.take_off_s),
        onboard_(detail::onboard_of<Onboard>(vehicle_.airframe(), settings)) {
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
    const Status status = rates_.accept(time_us, rates_rad_s, detail::check_sample(rates_rad_s));
    if (status == Status::ok) learner_.motion().body_rates(time_us, rates_rad_s);
    return status;
  }
  /// Body -> world; normalised, where the norm is within unit_quaternion_tolerance of 1.
  Status attitude(std::uint64_t time_us, const Quaternion<float>& q) noexcept {
    const float numbers[4] = {q.w, q.x, q.y, q.z};
    if (!all_finite(numbers, 4)) return attitude_.accept(time_us, q, Status::not_finite);
    if (!is_unit(q)) return attitude_.accept(time_us, q, Status::not_unit_quaternion);
    return attitude_.accept(time_us, normalized(q), Status::ok);
  }
  Status local(std::uint64_t time_us, const LocalState& state) noexcept {
    Status checked = detail::check_sample(state.position_m);
    if (checked == Status::ok) checked = detail::check_sample(state.velocity_m_s);
    const Status status = local_.accept(time_us, state, checked);
    if (status == Status::ok) learner_.motion().velocity(time_us, state.velocity_m_s);
    return status;
  }
  /// A number that is not finite is not asked for, axis by axis, as in PX4's trajectory set point.
  Status set_point(std::uint64_t time_us, const TrajectoryPoint<float>& wanted) noexcept {
    return set_point_.accept(time_us, wanted, detail::check_set_point(wanted));
  }

  /// Of the pack under load, for a model that asks for it: `not_finite`, or `out_of_range` for what is none.
  Status battery_voltage(std::uint64_t time_us, float volts) noexcept { return model_inputs_.voltage(time_us, volts); }

  /// Given before each step, by a stack that knows. Until then the commands drive nothing and the vehicle is in the
  /// air. A controller that takes over holds the place of that moment.
  void situation(const Situation& now) noexcept {
    if (now.drives_motors && !situation_.drives_motors) holding_ = false;
    situation_ = now;
  }
  const Situation& situation() const noexcept { return situation_; }

  /// A reset of the estimator, the step of its estimate: the held place and the set point move with it.
  void jump(const LocalState& by, float yaw_rad) noexcept {
    TrajectoryPoint<float> wanted = set_point_.value();
    wanted.position_m += by.position_m;
    wanted.yaw_rad += yaw_rad;
    set_point_.replace(wanted);
    held_position_m_ += by.position_m;
    held_yaw_rad_ += yaw_rad;
    learner_.motion().interrupt();
    model_inputs_.clear();
    jumped_ = true;
  }

  /// Of the network's commands. What its network does not answer for it does not learn. Of the learner's, where it
  /// answers.
  const MotionBias<float>& bias() const noexcept {
    if constexpr (has_onboard) {
      if (learns()) return onboard_.bias();
    }
    return learner_.own();
  }
  /// The vehicle as it is learnt: its certificate, candidate, rows.
  const auto& onboard() const noexcept { return onboard_; }
  /// The use of the learner that the last situation asked for; off without one.
  Learning learning() const noexcept { return has_onboard ? situation_.learning : Learning::off; }
  /// CoreRecord::learnt.
  std::uint8_t learnt() const noexcept {
    unsigned bits = seen_flight_ ? CoreRecord::seen_flight : 0u;
    if constexpr (has_onboard) {
      for (std::size_t k = 0; k < 4; ++k) bits |= onboard_.certificate()[k].proven ? 1u << k : 0u;
    }
    return static_cast<std::uint8_t>(bits);
  }
  /// Of the analytic inverse's commands; and the acceleration across the thrust, whoever answers.
  const MotionBias<float>& analytic_bias() const noexcept { return learner_.last(); }
  /// Share of the thrust that it uses, 0 to 1: below 1 at take-off and landing.
  float lift() const noexcept { return take_off_.lift(); }
  /// Mean error of the model's commands, bias included, about the flown motion; 0 without limits of trust.
  float command_residual() const noexcept { return learner_.trust().command_residual(); }
  /// False while the command residual is above its limit.
  bool trusted() const noexcept { return learner_.trust().trusted(); }
  const Learner& learner() const noexcept { return learner_; }
  /// Goes on from a logged tick (replay).
  void resume(const CoreRecord& logged) noexcept {
    resume_biases(logged);
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
    resume_biases(logged);
    learner_.give();
  }

  /// One tick: motor commands in the airframe's rotor order, within the output limits. `commands` is untouched where
  /// the reaction is gives_up. `now_us` is of the samples' clock; any time may lie between two calls.
  Reaction step(std::uint64_t now_us, Commands<float>& commands, StepReport& report) noexcept {
    report = {};
    model_inputs_.tick(now_us);
    const Inverse* inverse = models_.take();
    if (checksum_ != models_.checksum(inverse)) take_model(*inverse);
    Reaction reaction = inverse == nullptr ? Reaction::gives_up : judge_ages(now_us, report);
    take_off_.update(now_us, situation_, vertical_motion(reaction));
    limit_demand();
    learn(now_us, reaction, inverse);
    if (reaction <= Reaction::levels) {
      Commands<float> answer{};
      report.status =
          learns() ? ask_onboard(now_us, reaction, answer, report) : ask(*inverse, reaction, answer, report);
      if (has_output(report.status)) {
        last_commands_ = desaturate(vehicle_.rotors(), answer, range());
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
  std::uint32_t refused_samples() const noexcept {
    return rates_.refused() + attitude_.refused() + local_.refused() + set_point_.refused() + model_inputs_.refused();
  }
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
  CommandRange<float> range() const noexcept { return {settings_.lowest_command, settings_.highest_command}; }

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

  Reaction judge_ages(std::uint64_t now_us, StepReport& report) noexcept {
    const auto bit_if = [](bool stale, std::uint8_t bit) noexcept { return stale ? bit : std::uint8_t{0}; };
    report.stale_inputs =
        static_cast<std::uint8_t>(bit_if(!rates_.fresh(now_us, settings_.body_rates_us), body_rates_bit) |
                                  bit_if(!attitude_.fresh(now_us, settings_.attitude_us), attitude_bit) |
                                  bit_if(!local_.fresh(now_us, settings_.local_us), local_bit) |
                                  bit_if(!set_point_.fresh(now_us, settings_.set_point_us), set_point_bit) |
                                  bit_if(!model_inputs_.voltage_is_fresh(), voltage_bit));
    if (!report.stale(set_point_bit)) holding_ = false;
    if (report.stale(body_rates_bit | attitude_bit)) return Reaction::keeps_commands;
    if (report.stale(local_bit)) {
      return local_.fresh(now_us, std::uint64_t{settings_.local_us} + settings_.level_us) ? Reaction::levels
                                                                                          : Reaction::gives_up;
    }
    return report.stale(set_point_bit) ? Reaction::holds_position : Reaction::flies;
  }

  void resume_biases(const CoreRecord& logged) noexcept {
    const auto sums = [](const float(&b)[4]) noexcept { return SignedSums<float>{b[0], b[1], b[2], b[3]}; };
    const Vector3<float> across(logged.bias_across_m_s2);
    const Vector3<float> rate(logged.bias_across_rate_m_s3[0], logged.bias_across_rate_m_s3[1], 0);
    if (logged.learning != 0) {  // it is the learner's that was logged
      learner_.own().reset();
    } else {
      learner_.own().resume(sums(logged.bias_sums), across, rate, {logged.bias_noise, logged.bias_across_noise_m_s2},
                            logged.bias_waited_s, static_cast<Status>(logged.bias_status));
    }
    learner_.last().resume(sums(logged.analytic_bias_sums), across, rate,
                           {logged.analytic_bias_noise, logged.bias_across_noise_m_s2}, logged.analytic_bias_waited_s,
                           static_cast<Status>(logged.analytic_bias_status));
  }

  bool learns() const noexcept { return learning() != Learning::off; }

  /// A tick of the vehicle that is learnt, and of the demand's limits, which are those of what flies.
  PINNQUAD_NOINLINE void learn_vehicle(const typename Learner::Tick& tick) noexcept {
    if constexpr (has_onboard) {
      constexpr std::uint64_t longest_us = 100'000;
      const std::uint64_t step_us = tick.now_us - learnt_us_;
      learnt_us_ = tick.now_us;
      if (learnt_before_ && !learns()) learner_.another_model();  // the network's again
      learnt_before_ = learns();
      if (!learns()) return;
      learner_.own().reset();  // the network is not asked
      const bool known = tick.known && !tick.freezes && !jumped_;
      if (situation_.learning != Learning::excites) {
        excited_us_ = 0;
      } else if (known) {
        excited_us_ += step_us < longest_us ? step_us : longest_us;
      }
      onboard_.excite(situation_.learning == Learning::excites && excited_us_ < excited_for_us);
      onboard_.freeze(situation_.learning == Learning::frozen);
      onboard_.learn(tick.now_us, known, state(), last_commands_);
      seen_flight_ = seen_flight_ || known;
    } else {
      static_cast<void>(tick);
    }
  }
  /// The demand's limits are those of the vehicle as it flies, after the rows until the tick before. Out of line, and
  /// not below learn(): it takes more stack than a tick of the learner.
  PINNQUAD_NOINLINE void limit_demand() noexcept {
    if constexpr (has_onboard) {
      const std::uint32_t rows = learns() ? onboard_.rows() + 1 : 0;
      if (rows == limits_rows_) return;
      limits_rows_ = rows;
      outer_loop_ = detail::outer_loop(settings_, learns() ? onboard_.airframe() : vehicle_.airframe(),
                                       vehicle_.site().gravity_m_s2);
    }
  }

  State<float> state() const noexcept {
    return {local_.value().position_m, local_.value().velocity_m_s, attitude_.value(), rates_.value()};
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
    learner_.learn(tick, state(), last_commands_, network, analytic);
  }

  /// It climbs for 10 cm, 0.1 m/s or 0.1 m/s^2: less is an estimate's noise.
  detail::VerticalMotion vertical_motion(Reaction reaction) const noexcept {
    constexpr float noise = 0.1f;
    detail::VerticalMotion motion;
    const Vector3<float>& velocity = local_.value().velocity_m_s;
    motion.sink_m_s = velocity[2];
    motion.along_m_s = std::sqrt(velocity[0] * velocity[0] + velocity[1] * velocity[1]);
    motion.expected_fall_m_s2 = expected_m_s2_[2];
    if (reaction != Reaction::flies) return motion;
    const TrajectoryPoint<float>& wanted = set_point_.value();
    const float below_m = wanted.position_m[2] - local_.value().position_m[2], sink_m_s = wanted.velocity_m_s[2];
    motion.asks_to_climb = below_m < -noise || sink_m_s < -noise || wanted.acceleration_m_s2[2] < -noise;
    if (is_finite(below_m)) motion.asked_sink_m_s = settings_.position_1_s * below_m;
    if (is_finite(sink_m_s)) motion.asked_sink_m_s += sink_m_s;
    return motion;
  }

  /// The point of a trajectory that a reaction flies to; where nothing is asked for, the vehicle's own motion.
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
    return detail::completed(set_point_.value(), now, point.yaw_rad);
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
      const State<float> now = state();
      Accelerations<float> wanted;
      const Status outer = want_leaning(reaction, now, wanted);
      if (outer != Status::ok) return outer;
      report.cause = onboard_(now, wanted, now_us, commands);
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
    const State<float> now = state();
    Accelerations<float> wanted;
    TrajectoryPoint<float> point = target(reaction, now);
    // a vehicle that levels: thrust alone, so that level stays level
    if (reaction != Reaction::levels) point.acceleration_m_s2 -= learner_.across_m_s2();
    const Status outer = demand(now, point, wanted);
    if (outer == Status::ok) motion = motion_inputs(now, wanted);
    return outer;
  }
  /// That of a vehicle that is learnt, which knows its drag.
  PINNQUAD_NOINLINE Status want_leaning(Reaction reaction, const State<float>& now,
                                        Accelerations<float>& wanted) noexcept {
    TrajectoryPoint<float> point = target(reaction, now);
    if constexpr (has_onboard) {
      if (reaction != Reaction::levels) point = leaning(onboard_, now, point, vehicle_.site().gravity_m_s2);
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
  detail::Input<Vector3<float>> rates_;
  detail::Input<Quaternion<float>> attitude_;
  detail::Input<LocalState> local_;
  detail::Input<TrajectoryPoint<float>> set_point_;
  Vector3<float> held_position_m_ = Vector3<float>::Zero();
  float held_yaw_rad_ = 0;
  bool holding_ = false;
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
  static constexpr std::uint64_t excited_for_us = 10'000'000;
  std::conditional_t<has_onboard, Onboard, detail::NoOnboard> onboard_;
  std::uint64_t learnt_us_ = 0, excited_us_ = 0;
  std::uint32_t limits_rows_ = 0;  ///< the limits are those after one row less; 0: of the airframe
  bool learnt_before_ = false, seen_flight_ = false;
};

}  // namespace pinnquad::autopilot
