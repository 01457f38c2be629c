// SPDX-License-Identifier: MIT
// L1 adaptive control with the piecewise-constant law: Hovakimyan and Cao, L1 adaptive control theory (SIAM 2010),
// ch. 3; on a quadrotor's velocity and body rates as in Wu, Cheng, Ackerman, Gahlawat, Lakshmanan, Zhao and Hovakimyan,
// L1 adaptive augmentation for geometric tracking control of quadrotors (ICRA 2022).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "pinnquad/control/adaptive_inverse.hpp"
#include "pinnquad/control/rotor_follower.hpp"
#include "pinnquad/control/tick_clock.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace study {

using namespace pinnquad;

/// One state z with z' = known + d, d unknown: a predictor p with p' = known + s - a (p - z), the law
///   s = -a / (exp(a T) - 1) (p - z)
/// of each period T, and the low-pass c' = w (s - c), which alone goes into the control.
template <class Scalar>
class L1Observer {
 public:
  Scalar estimate() const noexcept { return filtered_; }
  void start(Scalar measured) noexcept {
    predicted_ = measured;
    estimate_ = Scalar(0);
  }
  void reset() noexcept { filtered_ = Scalar(0); }

  /// The state after a period with this known rate of change.
  void update(Scalar measured, Scalar known, Scalar period_s, Scalar predictor_1_s, Scalar cutoff_rad_s,
              Scalar most) noexcept {
    using std::exp;
    const Scalar kept = exp(-predictor_1_s * period_s), held = (Scalar(1) - kept) / predictor_1_s;
    predicted_ += period_s * known + (kept - Scalar(1)) * error_ + held * estimate_;
    error_ = predicted_ - measured;
    estimate_ = -kept / held * error_;
    const Scalar next = filtered_ + (Scalar(1) - exp(-cutoff_rad_s * period_s)) * (estimate_ - filtered_);
    filtered_ = next > most ? most : (next < -most ? -most : next);  // the estimate alone is mostly noise
  }

 private:
  Scalar predicted_{0}, error_{0}, estimate_{0}, filtered_{0};
};

/// Settings of an L1Adaptive.
template <class Scalar>
struct L1Settings {
  Scalar linear_predictor_1_s = Scalar(5), angular_predictor_1_s = Scalar(10);
  Scalar force_cutoff_rad_s = Scalar(12), torque_cutoff_rad_s = Scalar(12);
  Scalar most_m_s2 = Scalar(6), most_rad_s2 = Scalar(40);  ///< of each axis
};

/// A feed-forward policy around another one: what velocity and body rates do beyond the vehicle that is known, under
/// the commands that its rotors follow, is taken from the motion that the other is asked for.
template <class Scalar, class FeedForward, class Vehicle>
class L1Adaptive {
 public:
  L1Adaptive(const FeedForward& inverse, const Vehicle& vehicle, const L1Settings<Scalar>& settings = {},
             Scalar delay_s = Scalar(0)) noexcept
      : inverse_(inverse),
        vehicle_(vehicle),
        settings_(settings),
        rotors_(vehicle.airframe().rise_time_constant_s(0), delay_s) {}

  Vector3<Scalar> force_m_s2() const noexcept { return {of_[0].estimate(), of_[1].estimate(), of_[2].estimate()}; }
  Vector3<Scalar> torque_rad_s2() const noexcept { return {of_[3].estimate(), of_[4].estimate(), of_[5].estimate()}; }

  void learn(std::uint64_t now_us, bool known, const State<Scalar>& state, const Commands<Scalar>& commands) noexcept {
    const Scalar step_s = clock_.step_s(now_us);
    const bool follows = known && step_s > Scalar(0) && step_s <= Scalar(0.02);
    if (!(follows && all_finite(state) && all_finite(commands))) {
      runs_ = false;
      return;
    }
    if (!runs_) rotors_.restart(commands);
    const bool seen = rotors_.follow(now_us, step_s, commands);
    const std::array<Scalar, 6> measured = {state.velocity_m_s[0],     state.velocity_m_s[1],
                                            state.velocity_m_s[2],     state.body_rates_rad_s[0],
                                            state.body_rates_rad_s[1], state.body_rates_rad_s[2]};
    const Accelerations<Scalar> motion =
        vehicle_.evaluate(state, rotors_.then(), static_cast<Scalar>(seconds_of(now_us))).motion;
    const Vector3<Scalar> linear = world_acceleration(state, motion.linear_m_s2);
    const bool sound = all_finite(linear) && all_finite(motion.angular_rad_s2);
    for (int i = 0; i < 6 && sound; ++i) {
      L1Observer<Scalar>& observer = of_[static_cast<std::size_t>(i)];
      const Scalar now = measured[static_cast<std::size_t>(i)];
      const L1Settings<Scalar>& s = settings_;
      if (!runs_) {
        observer.start(now);
      } else if (i < 3) {
        observer.update(now, linear[i], step_s, s.linear_predictor_1_s, s.force_cutoff_rad_s, s.most_m_s2);
      } else {
        observer.update(now, motion.angular_rad_s2[i - 3], step_s, s.angular_predictor_1_s, s.torque_cutoff_rad_s,
                        s.most_rad_s2);
      }
    }
    runs_ = sound && seen;
  }

  /// Of force_m_s2() the part along the thrust; the attitude leans against the rest.
  Status operator()(const State<Scalar>& state, const Accelerations<Scalar>& wanted, std::uint64_t time_us,
                    Commands<Scalar>& commands) noexcept {
    Accelerations<Scalar> asked = wanted;
    asked.linear_m_s2[2] -= world_to_body<Scalar>(state.attitude, force_m_s2())[2];
    asked.angular_rad_s2 -= torque_rad_s2();
    return inverse_(state, asked, time_us, commands);
  }
  Vector3<Scalar> across_m_s2(const State<Scalar>& state) const noexcept {
    Vector3<Scalar> across = world_to_body<Scalar>(state.attitude, force_m_s2());
    across[2] = Scalar(0);
    return body_to_world<Scalar>(state.attitude, across) + across_of(inverse_, state);
  }
  FallbackCount count() const noexcept { return fallback_count(inverse_); }

 private:
  FeedForward inverse_;
  Vehicle vehicle_;
  L1Settings<Scalar> settings_;
  pinnquad::detail::RotorFollower<Scalar> rotors_;
  pinnquad::detail::TickClock<Scalar> clock_;
  std::array<L1Observer<Scalar>, 6> of_{};  ///< velocity NED, body rates FRD
  bool runs_ = false;
};

}  // namespace study
