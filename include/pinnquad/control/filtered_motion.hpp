// SPDX-License-Identifier: MIT
// The flown motion of each tick, behind a low-pass: what incremental dynamic inversion compares with what is wanted.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "pinnquad/control/rotor_follower.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/features/features.hpp"

namespace pinnquad {

/// Velocity, body rates, attitude and commands through one Butterworth low-pass of second order,
///   x'' = w^2 (y - x) - sqrt(2) w x',
/// whose x' are the accelerations: all are late alike. The commands are behind the rotors' lag. Used as FlownMotion.
template <class Scalar>
class FilteredMotion {
 public:
  static constexpr Scalar usual_cutoff_rad_s = Scalar(75);  ///< 12 Hz

  /// w; the time constant of the rotors; by how much a state comes late beside the commands.
  explicit FilteredMotion(Scalar cutoff_rad_s = usual_cutoff_rad_s, Scalar rotor_lag_s = Scalar(0),
                          Scalar delay_s = Scalar(0)) noexcept
      : cutoff_rad_s_(cutoff_rad_s), rotors_(rotor_lag_s, delay_s) {}

  /// It is shown the state of each tick.
  void velocity(std::uint64_t /*time_us*/, const Vector3<Scalar>& /*m_s*/) noexcept {}
  void body_rates(std::uint64_t /*time_us*/, const Vector3<Scalar>& /*rad_s*/) noexcept {}
  void interrupt() noexcept { runs_ = false; }

  /// One tick, as FlownMotion's. True once the low-pass has settled: six of its time constants after the first of ticks
  /// that follow each other.
  bool tick(std::uint64_t now_us, bool known, const State<Scalar>& state, const Commands<Scalar>& commands) noexcept {
    const Scalar step_s = now_us > before_us_ ? Scalar(1e-6) * static_cast<Scalar>(now_us - before_us_) : Scalar(0);
    before_us_ = now_us;
    const bool follows = step_s > Scalar(0) && step_s * cutoff_rad_s_ <= Scalar(0.5);
    if (!(known && follows && all_finite(state) && all_finite(commands))) {
      interrupt();
      return false;
    }
    const Quaternion<Scalar>& q = state.attitude;
    const Scalar along = q.w * at_[6] + q.x * at_[7] + q.y * at_[8] + q.z * at_[9];
    const Scalar sign = along < Scalar(0) ? Scalar(-1) : Scalar(1);
    std::array<Scalar, channels> now{};
    for (int i = 0; i < 3; ++i) {
      now[static_cast<std::size_t>(i)] = state.velocity_m_s[i];
      now[static_cast<std::size_t>(3 + i)] = state.body_rates_rad_s[i];
    }
    now[6] = sign * q.w, now[7] = sign * q.x, now[8] = sign * q.y, now[9] = sign * q.z;
    if (!runs_) {
      rotors_.restart(commands);
      settled_s_ = Scalar(0);
    }
    const bool known_rotors = rotors_.follow(now_us, step_s, commands);
    for (std::size_t i = 0; i < rotor_count; ++i) now[10 + i] = rotors_.then()[i];
    const Scalar w = cutoff_rad_s_;
    for (std::size_t i = 0; i < channels; ++i) {
      if (!runs_) {
        at_[i] = now[i];
        rate_[i] = Scalar(0);
        continue;
      }
      rate_[i] += step_s * (w * w * (now[i] - at_[i]) - Scalar(1.4142135623730951) * w * rate_[i]);
      at_[i] += step_s * rate_[i];
    }
    runs_ = true;
    settled_s_ = known_rotors ? settled_s_ + step_s : Scalar(0);
    return settled_s_ * w >= Scalar(6) && finish();
  }

  /// There is a motion of each tick.
  static Scalar period_s(Scalar tick_s) noexcept { return tick_s; }
  const MotionInputs<Scalar>& motion() const noexcept { return motion_; }
  const Commands<Scalar>& flown() const noexcept { return flown_; }
  /// The motion's, NED.
  Vector3<Scalar> velocity_m_s() const noexcept { return {at_[0], at_[1], at_[2]}; }

 private:
  static constexpr std::size_t channels = 10 + rotor_count;

  bool finish() noexcept {
    State<Scalar> mean;
    mean.velocity_m_s = Vector3<Scalar>(at_[0], at_[1], at_[2]);
    mean.body_rates_rad_s = Vector3<Scalar>(at_[3], at_[4], at_[5]);
    mean.attitude = {at_[6], at_[7], at_[8], at_[9]};
    if (!(squared_norm(mean.attitude) > Scalar(0.25))) return false;
    mean.attitude = normalized(mean.attitude);
    const Accelerations<Scalar> measured{body_derivative<Scalar>(mean, Vector3<Scalar>(rate_[0], rate_[1], rate_[2])),
                                         Vector3<Scalar>(rate_[3], rate_[4], rate_[5])};
    if (!(all_finite(mean) && all_finite(measured.linear_m_s2) && all_finite(measured.angular_rad_s2))) return false;
    motion_ = motion_inputs(mean, measured);
    for (std::size_t i = 0; i < rotor_count; ++i) flown_[i] = at_[10 + i];
    return true;
  }

  Scalar cutoff_rad_s_;
  std::uint64_t before_us_ = 0;
  bool runs_ = false;
  Scalar settled_s_{0};  ///< since rotors and states are known together
  std::array<Scalar, channels> at_{}, rate_{};
  detail::RotorFollower<Scalar> rotors_;
  MotionInputs<Scalar> motion_{};
  Commands<Scalar> flown_{};
};

}  // namespace pinnquad
