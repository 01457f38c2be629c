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

/// Settings of an IntegralInverse.
template <class Scalar>
struct IntegralSettings {
  Scalar linear_1_s = Scalar(1);   ///< of the acceleration that position and velocity errors ask for
  Scalar angular_1_s = Scalar(2);  ///< of the angular acceleration that attitude and rate errors ask for
  Scalar most_m_s2 = Scalar(4);    ///< of each axis
  Scalar most_rad_s2 = Scalar(30);
};

/// Asks the other policy for the motion wanted plus k times the integral of the feedback, each axis bounded; the
/// integral stands still while a command is at its end.
template <class Scalar, class FeedForward>
class IntegralInverse {
  static_assert(detail::require_whole_policy<FeedForward, Scalar>());

 public:
  explicit IntegralInverse(const FeedForward& inverse, const IntegralSettings<Scalar>& settings = {}) noexcept
      : inverse_(inverse), settings_(settings) {}

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
      add(settings_.linear_1_s * linear[i], settings_.most_m_s2, linear_[i]);
      add(settings_.angular_1_s * feedback.angular_rad_s2[i], settings_.most_rad_s2, angular_[i]);
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
  IntegralSettings<Scalar> settings_;
  std::uint64_t before_us_ = 0;
  Scalar step_s_{0};
  Quaternion<Scalar> attitude_{};
  Vector3<Scalar> linear_ = Vector3<Scalar>::Zero(), angular_ = Vector3<Scalar>::Zero();
};

}  // namespace pinnquad
