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

namespace pinnquad {

namespace detail {
template <class Policy, class Scalar>
using ObservedCall = decltype(std::declval<Policy&>().observed(std::declval<const State<Scalar>&>(),
                                                               std::declval<const Accelerations<Scalar>&>(),
                                                               std::uint64_t{}, std::declval<Commands<Scalar>&>()));
template <class Policy, class Scalar>
using LearnCall = decltype(std::declval<Policy&>().learn(std::uint64_t{}, bool{}, std::declval<const State<Scalar>&>(),
                                                         std::declval<const Commands<Scalar>&>()));
}  // namespace detail

/// True for a feed-forward policy that learns from what was flown.
template <class Policy, class Scalar>
inline constexpr bool learns_in_flight = is_detected<detail::LearnCall, Policy, Scalar>;

/// A feed-forward policy around another one. `Motion`: what makes one instant of what was flown, FlownMotion or
/// FilteredMotion.
template <class Scalar, class FeedForward, class Motion = FlownMotion<Scalar>>
class AdaptiveInverse {
  static_assert(is_feed_forward<FeedForward, Scalar>,
                "pinnquad: AdaptiveInverse's second argument is no feed-forward policy (control/feed_forward.hpp)");

 public:
  AdaptiveInverse(const FeedForward& inverse, const Airframe<Scalar>& airframe,
                  const BiasSettings<Scalar>& settings = {}, const Motion& motion = Motion{}) noexcept
      : inverse_(inverse), bias_(airframe, settings), motion_(motion) {}

  const FeedForward& inverse() const noexcept { return inverse_; }
  const MotionBias<Scalar>& bias() const noexcept { return bias_; }
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

  /// One tick, before the inverse is asked: the state, and the commands in force since the tick before. `known`: these
  /// drove the motors, in flight, off their ends. The bias learns where a motion is complete and the inverse answers
  /// for it by itself; else it waits.
  void learn(std::uint64_t now_us, bool known, const State<Scalar>& state, const Commands<Scalar>& commands) noexcept {
    const Scalar step_s =
        before_us_ != 0 && now_us > before_us_ ? Scalar(1e-6) * static_cast<Scalar>(now_us - before_us_) : Scalar(0);
    before_us_ = now_us;
    if (motion_.tick(now_us, known, state, commands)) {
      compare(now_us, state.position_m, step_s);
    } else {
      bias_.wait(step_s);
    }
    motion_.velocity(now_us, state.velocity_m_s);
    motion_.body_rates(now_us, state.body_rates_rad_s);
  }

  /// d: to be taken from an acceleration (NED) before it is asked for.
  const Vector3<Scalar>& acceleration_bias_m_s2() const noexcept { return bias_.across_m_s2(); }

 private:
  PINNQUAD_NOINLINE void compare(std::uint64_t now_us, const Vector3<Scalar>& position_m, Scalar step_s) noexcept {
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
    if (status != Status::ok) return;
    static_cast<void>(bias_.learn(motion, motion_.flown(), said, motion_.period_s(step_s)));
  }

  FeedForward inverse_;
  MotionBias<Scalar> bias_;
  Motion motion_;
  std::uint64_t before_us_ = 0;
};

}  // namespace pinnquad
