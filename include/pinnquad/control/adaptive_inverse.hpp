// SPDX-License-Identifier: MIT
// An inverse that learns in flight: u = inverse(motion wanted) + A b. The bias b of its signed sums comes from its own
// past: commands that the rotors have followed - commands of the inverse for the motion that they made
// (control/bias_learner.hpp). A is the inverse of the signs. The bias does not depend on the motion asked for: what is
// proven of the inverse's slopes holds as it is, and its bounds widen by the bias' own.
// With the filtered motion of each tick in place of the means of two periods, and the rigid body as inverse, this is
// incremental nonlinear dynamic inversion (INDI; Smeur, Chu and de Croon 2016).
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "pinnquad/control/bias_learner.hpp"
#include "pinnquad/control/feed_forward.hpp"

namespace pinnquad {

namespace detail {
struct NoReserve {};
}  // namespace detail

/// A feed-forward policy around another one. `Motion`: what makes one instant of what was flown, FlownMotion or
/// FilteredMotion. `Reserve`: a policy that answers, with a bias of its own, where the inverse declines or its bias
/// stands at its bound. It knows of the same acceleration across the thrust.
template <class Scalar, class FeedForward, class Motion = FlownMotion<Scalar>, class Reserve = detail::NoReserve>
class AdaptiveInverse {
  static constexpr bool reserves = !std::is_same_v<Reserve, detail::NoReserve>;
  static_assert(is_feed_forward<FeedForward, Scalar>,
                "pinnquad: AdaptiveInverse's second argument is no feed-forward policy (control/feed_forward.hpp)");
  static_assert(!is_feed_forward<FeedForward, Scalar> || is_detected<detail::NoexceptFeedForward, FeedForward, Scalar>,
                "pinnquad: the inverse of an AdaptiveInverse flies: its operator() must be noexcept "
                "(control/feed_forward.hpp)");
  static_assert(detail::require_whole_policy<FeedForward, Scalar>());

 public:
  using Learner = detail::BiasLearner<Scalar, reserves ? 2 : 1, Motion>;
  /// The bias is the same in every state.
  static constexpr bool across_varies = pinnquad::across_varies<FeedForward, Scalar>;

  AdaptiveInverse(const FeedForward& inverse, const Airframe<Scalar>& airframe,
                  const BiasSettings<Scalar>& settings = {}, const Motion& motion = Motion{},
                  const Reserve& reserve = Reserve{}) noexcept
      : inverse_(inverse), reserve_(reserve), learner_(airframe, settings, motion) {}

  const FeedForward& inverse() const noexcept { return inverse_; }
  const Learner& learner() const noexcept { return learner_; }
  const detail::MotionBias<Scalar>& bias() const noexcept { return learner_.own(); }
  bool at_bound() const noexcept { return learner_.at_bound(); }
  void reset() noexcept { learner_.reset(); }
  /// For a reset of the estimator: the open window is of two frames.
  void interrupt() noexcept { learner_.motion().interrupt(); }

  /// The inverse's commands and Status, with the bias; `fell_back` where the reserve answers.
  Status operator()(const State<Scalar>& state, const Accelerations<Scalar>& wanted, std::uint64_t time_us,
                    Commands<Scalar>& commands) noexcept {
    Status cause = Status::ok;
    const auto own = [&](Commands<Scalar>& said) noexcept { return inverse_(state, wanted, time_us, said); };
    if constexpr (reserves) {
      return learner_.answer(commands, cause, own,
                             [&](Commands<Scalar>& said) noexcept { return reserve_(state, wanted, time_us, said); });
    } else {
      return learner_.answer(commands, cause, own);
    }
  }

  /// One tick, before the inverse is asked: the state, and the commands in force since the tick before, first for an
  /// inverse that learns too.
  void learn(std::uint64_t now_us, bool known, const State<Scalar>& state, const Commands<Scalar>& commands) noexcept {
    learner_.motion().velocity(now_us, state.velocity_m_s);
    learner_.motion().body_rates(now_us, state.body_rates_rad_s);
    typename Learner::Tick tick;
    tick.now_us = now_us;
    tick.known = known;
    const auto observed_by = [&](auto& inverse) noexcept {
      if constexpr (learns_in_flight<std::decay_t<decltype(inverse)>, Scalar>) {
        inverse.learn(now_us, known, state, commands);
      }
      return [&](const MotionInputs<Scalar>& motion, Commands<Scalar>& said, Vector3<Scalar>& across) noexcept {
        return answer_to(inverse, now_us, state.position_m, motion, said, across);
      };
    };
    if constexpr (reserves) {
      learner_.learn(tick, state, commands, observed_by(inverse_), observed_by(reserve_));
    } else {
      learner_.learn(tick, state, commands, observed_by(inverse_));
    }
  }

  /// The feedback of the tick, for an inverse that integrates it.
  void integrate([[maybe_unused]] const Accelerations<Scalar>& feedback) noexcept {
    if constexpr (integrates_feedback<FeedForward, Scalar>) inverse_.integrate(feedback);
    if constexpr (integrates_feedback<Reserve, Scalar>) reserve_.integrate(feedback);
  }
  /// d, beside what the inverse knows of.
  Vector3<Scalar> across_m_s2(const State<Scalar>& state) const noexcept {
    return learner_.across_m_s2() + across_of(inverse_, state);
  }
  /// The inverse's.
  FallbackCount count() const noexcept { return fallback_count(inverse_); }

 private:
  /// An inverse's own answer to a motion that was flown.
  template <class Inverse>
  Status answer_to(Inverse& inverse, std::uint64_t now_us, const Vector3<Scalar>& position_m,
                   const MotionInputs<Scalar>& motion, Commands<Scalar>& said, Vector3<Scalar>& across) noexcept {
    State<Scalar> state;
    state.position_m = position_m;
    state.attitude = motion.attitude;
    state.velocity_m_s = learner_.motion().velocity_m_s();
    state.body_rates_rad_s = motion.body_rates_rad_s;
    const Accelerations<Scalar> flown{motion.linear_acceleration_m_s2, motion.angular_acceleration_rad_s2};
    across = across_of(inverse, state);
    return observed_by(inverse, state, flown, now_us, said);
  }

  FeedForward inverse_;
  Reserve reserve_;
  Learner learner_;
};

}  // namespace pinnquad
