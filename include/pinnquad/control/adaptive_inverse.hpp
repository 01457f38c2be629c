// SPDX-License-Identifier: MIT
// An inverse that learns in flight: u = inverse(motion wanted) + A b. The bias b of its signed sums comes from its own
// past: commands that the rotors have followed - commands of the inverse for the motion that they made
// (control/motion_bias.hpp). A is the inverse of the signs. The bias does not depend on the motion asked for: what is
// proven of the inverse's slopes holds as it is, and its bounds widen by the bias' own.
// With the filtered motion of each tick in place of the means of two periods, and the rigid body as inverse, this is
// incremental nonlinear dynamic inversion (INDI; Smeur, Chu and de Croon 2016).
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/control/flown_motion.hpp"
#include "pinnquad/control/motion_bias.hpp"
#include "pinnquad/control/tick_clock.hpp"

namespace pinnquad {

namespace detail {
template <class Policy, class Scalar>
using ObservedCall = decltype(std::declval<Policy&>().observed(std::declval<const State<Scalar>&>(),
                                                               std::declval<const Accelerations<Scalar>&>(),
                                                               std::uint64_t{}, std::declval<Commands<Scalar>&>()));
template <class Policy, class Scalar>
using LearnCall = decltype(std::declval<Policy&>().learn(std::uint64_t{}, bool{}, std::declval<const State<Scalar>&>(),
                                                         std::declval<const Commands<Scalar>&>()));
template <class Policy, class Scalar>
using AcrossCall = decltype(std::declval<const Policy&>().across_m_s2(std::declval<const State<Scalar>&>()));
}  // namespace detail

/// True for a feed-forward policy that learns from what was flown:
///   void learn(std::uint64_t now_us, bool known, const State<S>&, const Commands<S>&) noexcept
template <class Policy, class Scalar>
inline constexpr bool learns_in_flight = is_detected<detail::LearnCall, Policy, Scalar>;

/// True for one that knows of an acceleration across the thrust, which no rotor makes: NED, to be taken from what is
/// asked for.
///   Vector3<S> across_m_s2(const State<S>&) const noexcept
template <class Policy, class Scalar>
inline constexpr bool knows_across = is_detected<detail::AcrossCall, Policy, Scalar>;

namespace detail {
template <class Policy>
using AcrossVaries = decltype(Policy::across_varies);
template <class Policy, class Scalar>
constexpr bool varying_across() noexcept {
  if constexpr (is_detected<AcrossVaries, Policy>) {
    return Policy::across_varies;
  } else {
    return knows_across<Policy, Scalar>;
  }
}
}  // namespace detail

/// True where it depends on the state: so unless the policy says `static constexpr bool across_varies = false`.
template <class Policy, class Scalar>
inline constexpr bool across_varies = detail::varying_across<Policy, Scalar>();

/// The acceleration that the policy knows of; zero of one that knows of none.
template <class Scalar, class Policy>
Vector3<Scalar> across_of(const Policy& policy, const State<Scalar>& state) noexcept {
  if constexpr (knows_across<Policy, Scalar>) {
    return policy.across_m_s2(state);
  } else {
    static_cast<void>(policy), static_cast<void>(state);
    return Vector3<Scalar>::Zero();
  }
}

/// A feed-forward policy around another one. `Motion`: what makes one instant of what was flown, FlownMotion or
/// FilteredMotion.
template <class Scalar, class FeedForward, class Motion = FlownMotion<Scalar>>
class AdaptiveInverse {
  static_assert(is_feed_forward<FeedForward, Scalar>,
                "pinnquad: AdaptiveInverse's second argument is no feed-forward policy (control/feed_forward.hpp)");
  static_assert(!is_feed_forward<FeedForward, Scalar> || is_detected<detail::NoexceptFeedForward, FeedForward, Scalar>,
                "pinnquad: the inverse of an AdaptiveInverse flies: its operator() must be noexcept "
                "(control/feed_forward.hpp)");

 public:
  /// The bias is the same in every state.
  static constexpr bool across_varies = pinnquad::across_varies<FeedForward, Scalar>;

  AdaptiveInverse(const FeedForward& inverse, const Airframe<Scalar>& airframe,
                  const BiasSettings<Scalar>& settings = {}, const Motion& motion = Motion{}) noexcept
      : inverse_(inverse), bias_(airframe, settings), motion_(motion) {}

  const FeedForward& inverse() const noexcept { return inverse_; }
  const MotionBias<Scalar>& bias() const noexcept { return bias_; }
  /// True where the flight asks for more than the bias may make good.
  bool at_bound() const noexcept { return bias_.status() == Status::limited; }
  void reset() noexcept {
    bias_.reset();
    motion_.interrupt();
  }
  /// For a reset of the estimator: the open window is of two frames.
  void interrupt() noexcept { motion_.interrupt(); }

  /// The inverse's commands and Status, with the bias.
  Status operator()(const State<Scalar>& state, const Accelerations<Scalar>& wanted, std::uint64_t time_us,
                    Commands<Scalar>& commands) noexcept {
    Commands<Scalar> said{};
    const Status status = inverse_(state, wanted, time_us, said);
    if (!has_output(status)) return status;
    bias_.add_to(said);
    commands = said;
    return status;
  }

  /// One tick, before the inverse is asked: the state, and the commands in force since the tick before, first for an
  /// inverse that learns too. `known`: these drove the motors, in flight, off their ends. The bias learns where a
  /// motion is complete and the inverse answers for it by itself; else it waits.
  void learn(std::uint64_t now_us, bool known, const State<Scalar>& state, const Commands<Scalar>& commands) noexcept {
    const Scalar step_s = clock_.step_s(now_us);
    if constexpr (learns_in_flight<FeedForward, Scalar>) inverse_.learn(now_us, known, state, commands);
    const bool learnt = motion_.tick(now_us, known, state, commands) && compare(now_us, state.position_m, step_s);
    if (!learnt) bias_.wait(step_s);
    motion_.velocity(now_us, state.velocity_m_s);
    motion_.body_rates(now_us, state.body_rates_rad_s);
  }

  /// d, beside what the inverse knows of.
  Vector3<Scalar> across_m_s2(const State<Scalar>& state) const noexcept {
    return bias_.across_m_s2() + across_of(inverse_, state);
  }
  /// The inverse's.
  FallbackCount count() const noexcept { return fallback_count(inverse_); }

 private:
  /// False where the inverse has no answer of its own, or the residual is no number.
  PINNQUAD_NOINLINE bool compare(std::uint64_t now_us, const Vector3<Scalar>& position_m, Scalar step_s) noexcept {
    const MotionInputs<Scalar>& motion = motion_.motion();
    State<Scalar> state;
    state.position_m = position_m;
    state.attitude = motion.attitude;
    state.velocity_m_s = body_to_world<Scalar>(motion.attitude, motion.velocity_m_s);
    state.body_rates_rad_s = motion.body_rates_rad_s;
    const Accelerations<Scalar> flown{motion.linear_acceleration_m_s2, motion.angular_acceleration_rad_s2};
    Commands<Scalar> said{};
    Status status = Status::ok;
    if constexpr (is_detected<detail::ObservedCall, FeedForward, Scalar>) {
      status = inverse_.observed(state, flown, now_us, said);
    } else {
      status = inverse_(state, flown, now_us, said);
    }
    return status == Status::ok &&
           has_output(bias_.learn(motion, motion_.flown(), said, motion_.period_s(step_s), across_of(inverse_, state)));
  }

  FeedForward inverse_;
  MotionBias<Scalar> bias_;
  Motion motion_;
  detail::TickClock<Scalar> clock_;
};

/// Two that learn: the first answers; where it declines, or has needed a bias beyond its bound for `patience_s` in all,
/// the second does, by its own bias, until the first has needed none beyond it for as long at a stretch. A bias that
/// is at its bound now and then lacks as much on the mean as one that stays there: nine times as long within the bound
/// makes good what was beyond it.
template <class Scalar, class First, class Second>
class InverseWithReserve {
 public:
  static constexpr bool across_varies =
      pinnquad::across_varies<First, Scalar> || pinnquad::across_varies<Second, Scalar>;

  InverseWithReserve(const First& first, const Second& second, Scalar patience_s = Scalar(0.5)) noexcept
      : first_(first), second_(second), patience_s_(patience_s) {}

  const First& first() const noexcept { return first_; }
  const Second& second() const noexcept { return second_; }
  bool handed_over() const noexcept { return handed_over_; }
  /// True where the inverse that answers is at its bound.
  bool at_bound() const noexcept { return handed_over_ ? second_.at_bound() : first_.at_bound(); }

  /// `fell_back` where the second answers.
  Status operator()(const State<Scalar>& state, const Accelerations<Scalar>& wanted, std::uint64_t time_us,
                    Commands<Scalar>& commands) noexcept {
    const Status status = handed_over_ ? Status::distrusted : first_(state, wanted, time_us, commands);
    if (has_output(status)) return status;
    return has_output(second_(state, wanted, time_us, commands)) ? Status::fell_back : status;
  }

  void learn(std::uint64_t now_us, bool known, const State<Scalar>& state, const Commands<Scalar>& commands) noexcept {
    first_.learn(now_us, known, state, commands);
    second_.learn(now_us, known, state, commands);
    const Scalar step_s = clock_.step_s(now_us);
    const bool beyond = first_.at_bound() && !second_.at_bound();
    if (beyond != handed_over_) {
      for_s_ += step_s;
    } else {
      for_s_ -= handed_over_ ? for_s_ : step_s / Scalar(9);
      if (for_s_ < Scalar(0)) for_s_ = Scalar(0);
    }
    if (for_s_ < patience_s_) return;
    handed_over_ = beyond;
    for_s_ = Scalar(0);
  }

  Vector3<Scalar> across_m_s2(const State<Scalar>& state) const noexcept {
    return handed_over_ ? second_.across_m_s2(state) : first_.across_m_s2(state);
  }
  /// The first one's.
  FallbackCount count() const noexcept { return first_.count(); }

 private:
  First first_;
  Second second_;
  Scalar patience_s_;
  detail::TickClock<Scalar> clock_;
  Scalar for_s_{0};  ///< time that has said otherwise
  bool handed_over_ = false;
};

}  // namespace pinnquad
