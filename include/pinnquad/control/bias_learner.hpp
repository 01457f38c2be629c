// SPDX-License-Identifier: MIT
// The biases of an inverse and of the one in reserve behind it (control/motion_bias.hpp), learnt in flight from one
// flown motion: when they learn, wait, follow, stay or are forgotten, which of the two answers, and the command
// residual of what the bias cannot explain. A loop (control/adaptive_inverse.hpp) and the autopilots' core fly it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pinnquad/control/flown_motion.hpp"
#include "pinnquad/control/flown_trust.hpp"
#include "pinnquad/control/motion_bias.hpp"
#include "pinnquad/control/tick_clock.hpp"

namespace pinnquad::detail {

/// `inverses`: 1, or 2 with one in reserve. `Motion`: FlownMotion or FilteredMotion. `Trust`: FlownTrust's; its motion
/// is a FlownMotion of float.
template <class Scalar, std::size_t inverses, class Motion = FlownMotion<Scalar>, class Trust = void>
class BiasLearner {
  static_assert(inverses == 1 || inverses == 2);

 public:
  /// A tick of a loop: what is known of the commands that were in force until it.
  struct Tick {
    std::uint64_t now_us{0};
    bool known{false};      ///< the commands since the tick before drove the motors, in flight, and the state is fresh
    bool in_flight{true};   ///< and the vehicle is not in other hands
    bool freezes{false};    ///< the commands were not all of an answer, or the ground may bear the vehicle
    bool on_ground{false};  ///< its thrust has gone
  };

  /// The reserve answers once the bias of the first inverse has been at the bound of a sum for so long while the
  /// reserve's has not, time within the bound taking off a ninth of itself; until it has been below half of its bound
  /// for clear_s, time beyond that taken off. Forces across the thrust are no inverse's fault, and do not count.
  static constexpr Scalar raise_s = Scalar(0.5), clear_s = Scalar(2);

  BiasLearner(const Airframe<Scalar>& airframe, const BiasSettings<Scalar>& settings, const Motion& motion) noexcept
      : motion_(motion), biases_(filled(MotionBias<Scalar>(airframe, settings))) {}

  /// It is told each sample of velocity and body rates before the tick.
  Motion& motion() noexcept { return motion_; }
  const Motion& motion() const noexcept { return motion_; }
  const MotionBias<Scalar>& own() const noexcept { return biases_.front(); }
  MotionBias<Scalar>& own() noexcept { return biases_.front(); }
  /// The reserve's; own() where there is none.
  const MotionBias<Scalar>& last() const noexcept { return biases_.back(); }
  MotionBias<Scalar>& last() noexcept { return biases_.back(); }
  /// The acceleration across the thrust, whoever answers.
  Vector3<Scalar> across_m_s2() const noexcept { return last().across_ahead_m_s2(); }
  const FlownTrust<Trust>& trust() const noexcept { return trust_; }
  FlownTrust<Trust>& trust() noexcept { return trust_; }
  /// True while the bias of the first inverse has been at its bound for too long.
  bool handed_over() const noexcept { return handed_over_; }
  /// True where the flight asks for more than the bias that is flown may make good.
  bool at_bound() const noexcept { return (handed_over_ ? last() : own()).status() == Status::limited; }

  void time_constants(const SignedSums<Scalar>& times_s) noexcept {
    for (MotionBias<Scalar>& bias : biases_) bias.time_constants(times_s);
  }
  /// The first inverse is another one: what was learnt of it is forgotten, unless a replay has just given it.
  void another_model() noexcept {
    if (!given_) own().reset();
    hand_over(false);
    trust_.reset();
  }
  void reset() noexcept {
    for (MotionBias<Scalar>& bias : biases_) bias.reset();
    motion_.interrupt();
    hand_over(false);
    trust_.reset();
  }
  /// Goes on from what was logged.
  void hand_over(bool handed_over) noexcept {
    for_s_ = handed_over == handed_over_ ? for_s_ : Scalar(0);
    handed_over_ = handed_over;
  }
  /// The biases are those of the next tick: its learn() learns nothing.
  void give() noexcept { given_ = true; }

  /// One tick, before the inverses are asked: the state, and the commands in force since the tick before. The biases
  /// learn where a motion is complete. Where the tick freezes they stay as they are; without a motion, or an answer,
  /// they wait; on the ground they are forgotten. Of each inverse:
  ///   Status inverse(const MotionInputs<Scalar>&, Commands<Scalar>& said, Vector3<Scalar>& known) noexcept
  /// its own answer to a motion, and the acceleration across the thrust that it knows of, NED, 0 before the call.
  template <class... Inverse>
  void learn(const Tick& tick, const State<Scalar>& state, const Commands<Scalar>& commands,
             const Inverse&... inverse) noexcept {
    static_assert(sizeof...(Inverse) == inverses);
    const Scalar step_s = clock_.step_s(tick.now_us);
    if (!tick.in_flight) {
      hand_over(false);
      for_s_ = Scalar(0);
      trust_.reset();
    }
    const bool complete = motion_.tick(tick.now_us, tick.known, state, commands);
    if (tick.freezes) motion_.interrupt();
    if (given_) {
      given_ = false;
    } else if (tick.on_ground) {
      for (MotionBias<Scalar>& bias : biases_) bias.reset();
    } else if (tick.freezes) {
      for (MotionBias<Scalar>& bias : biases_) bias.freeze();
    } else if (complete) {
      compare(tick.now_us, step_s, inverse...);
    } else {
      for (MotionBias<Scalar>& bias : biases_) bias.wait(step_s);
    }
    if constexpr (inverses == 2) {
      if (tick.known) choose(step_s);
    }
  }

  /// Commands of the inverse that answers, with its bias. Each is `Status inverse(Commands<Scalar>&) noexcept`.
  /// Its own Status, or `fell_back` where the reserve answered; the commands are untouched where none did. `cause`:
  /// that of the first inverse, `distrusted` where it was not asked.
  template <class Own, class... Reserve>
  Status answer(Commands<Scalar>& commands, Status& cause, const Own& own_inverse,
                const Reserve&... reserve) const noexcept {
    static_assert(1 + sizeof...(Reserve) == inverses);
    Commands<Scalar> said{};
    cause = trust_.trusted() && !handed_over_ ? own_inverse(said) : Status::distrusted;
    if (has_output(cause)) {
      own().add_to(said);
      commands = said;
      return cause;
    }
    if (!(has_output(reserve(said)) || ...)) return cause;
    last().add_to(said);
    commands = said;
    return Status::fell_back;
  }

 private:
  static std::array<MotionBias<Scalar>, inverses> filled(const MotionBias<Scalar>& bias) noexcept {
    if constexpr (inverses == 2) {
      return {bias, bias};
    } else {
      return {bias};
    }
  }

  /// Where the first inverse declines the motion that was flown, its bias moves with the reserve's, as the vehicle has
  /// changed for both: it would be of another time when it answers again.
  template <class Own, class... Reserve>
  PINNQUAD_NOINLINE void compare(std::uint64_t now_us, Scalar step_s, const Own& own_inverse,
                                 const Reserve&... reserve) noexcept {
    const SignedSums<Scalar> before = last().sums();
    const bool moved = (teach(last(), step_s, reserve) || ...);
    Commands<Scalar> said{};
    Vector3<Scalar> known = Vector3<Scalar>::Zero();
    if (own_inverse(motion_.motion(), said, known) != Status::ok) {
      if (moved) {
        own().follow(before, last().sums());
      } else {
        own().wait(step_s);
      }
      return;
    }
    if constexpr (FlownTrust<Trust>::known) {
      Commands<Scalar> with_bias = said;
      own().add_to(with_bias);
      trust_.judge(now_us, motion_.period_us(), with_bias, motion_.flown());
    } else {
      static_cast<void>(now_us);
    }
    take(own(), step_s, said, known);
  }
  template <class Inverse>
  bool teach(MotionBias<Scalar>& bias, Scalar step_s, const Inverse& inverse) noexcept {
    Commands<Scalar> said{};
    Vector3<Scalar> known = Vector3<Scalar>::Zero();
    if (inverse(motion_.motion(), said, known) == Status::ok) return take(bias, step_s, said, known);
    bias.wait(step_s);
    return false;
  }
  bool take(MotionBias<Scalar>& bias, Scalar step_s, const Commands<Scalar>& said,
            const Vector3<Scalar>& known) noexcept {
    const Status status = bias.learn(motion_.motion(), motion_.flown(), said, motion_.period_s(step_s), known);
    if (has_output(status)) return true;
    bias.wait(step_s);
    return false;
  }

  /// A step above 0.1 s is a gap.
  void choose(Scalar step_s) noexcept {
    constexpr Scalar at_bound = Scalar(0.99), half = Scalar(0.5), longest_s = Scalar(0.1);
    if (!(step_s > Scalar(0) && step_s <= longest_s)) return;
    const Scalar share = own().share_of_bound();
    const bool turns = handed_over_ ? share < half : share >= at_bound && last().share_of_bound() < at_bound;
    const Scalar less_s = for_s_ - (handed_over_ ? step_s : step_s / Scalar(9));
    for_s_ = turns ? for_s_ + step_s : (less_s > Scalar(0) ? less_s : Scalar(0));
    if (for_s_ >= (handed_over_ ? clear_s : raise_s)) hand_over(!handed_over_);
  }

  Motion motion_;
  std::array<MotionBias<Scalar>, inverses> biases_;
  FlownTrust<Trust> trust_{};
  TickClock<Scalar> clock_;
  Scalar for_s_{0};  ///< time that has said otherwise
  bool handed_over_ = false;
  bool given_ = false;
};

}  // namespace pinnquad::detail
