// SPDX-License-Identifier: MIT
// The integral part of a cascaded PID controller, as a feed-forward policy around another one: what steady disturbances
// need is found from the tracking error, not from the model.
#pragma once

#include <cstddef>
#include <cstdint>

#include "pinnquad/control/desaturate.hpp"
#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/dynamics/rigid_body.hpp"

namespace pinnquad {

/// Asks the other policy for the motion wanted plus k times the integral of the feedback, each axis bounded; the
/// integral stands still while a command is at its end.
template <class Scalar, class FeedForward>
class IntegralInverse {
  static_assert(detail::require_whole_policy<FeedForward, Scalar>());

 public:
  /// k of the acceleration that position and velocity errors ask for, and of the angular acceleration that attitude and
  /// rate errors ask for; the bounds of each axis.
  static constexpr Scalar linear_1_s = Scalar(1), angular_1_s = Scalar(2);
  static constexpr Scalar most_m_s2 = Scalar(4), most_rad_s2 = Scalar(30);

  /// `gain`: factor of both k.
  explicit IntegralInverse(const FeedForward& inverse, Scalar gain = Scalar(1)) noexcept
      : inverse_(inverse), gain_(gain) {}

  /// Tells the time, and whether the commands of the tick before were off their ends.
  void learn(std::uint64_t now_us, bool known, const State<Scalar>& state, const Commands<Scalar>& commands) noexcept {
    const bool follows = known && !saturated(commands) && now_us > before_us_ && now_us - before_us_ <= 100'000;
    step_s_ = follows ? Scalar(1e-6) * static_cast<Scalar>(now_us - before_us_) : Scalar(0);
    before_us_ = now_us;
    attitude_ = state.attitude;
    if constexpr (learns_in_flight<FeedForward, Scalar>) inverse_.learn(now_us, known, state, commands);
  }
  void integrate(const Accelerations<Scalar>& feedback) noexcept {
    const Vector3<Scalar> linear = body_to_world<Scalar>(attitude_, feedback.linear_m_s2);
    for (int i = 0; i < 3; ++i) {
      add(linear_1_s * gain_ * linear[i], most_m_s2, linear_[i]);
      add(angular_1_s * gain_ * feedback.angular_rad_s2[i], most_rad_s2, angular_[i]);
    }
    if constexpr (integrates_feedback<FeedForward, Scalar>) inverse_.integrate(feedback);
  }
  /// The integral, which a motion that is asked for gets added.
  Vector3<Scalar> across_m_s2(const State<Scalar>& state) const noexcept {
    return across_of(inverse_, state) - linear_;
  }

  Status operator()(const State<Scalar>& state, const Accelerations<Scalar>& wanted, std::uint64_t time_us,
                    Commands<Scalar>& commands) noexcept {
    return inverse_(state, {wanted.linear_m_s2, wanted.angular_rad_s2 + angular_}, time_us, commands);
  }
  /// The other policy's.
  Status observed(const State<Scalar>& state, const Accelerations<Scalar>& flown, std::uint64_t time_us,
                  Commands<Scalar>& commands) noexcept {
    return observed_by(inverse_, state, flown, time_us, commands);
  }
  FallbackCount count() const noexcept { return fallback_count(inverse_); }

 private:
  void add(Scalar rate, Scalar most, Scalar& sum) const noexcept {
    const Scalar next = sum + step_s_ * rate;
    if (is_finite(next)) sum = next > most ? most : (next < -most ? -most : next);
  }

  FeedForward inverse_;
  Scalar gain_;
  std::uint64_t before_us_ = 0;
  Scalar step_s_{0};
  Quaternion<Scalar> attitude_{};
  Vector3<Scalar> linear_ = Vector3<Scalar>::Zero(), angular_ = Vector3<Scalar>::Zero();
};

}  // namespace pinnquad
