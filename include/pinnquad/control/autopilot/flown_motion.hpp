// SPDX-License-Identifier: MIT
// The flown motion of a window, as a model can be asked about it, and the mean commands that the rotors followed in it.
// The command residual (docs/trust.md) compares motion and commands of one instant.
#pragma once

#include <cmath>
#include <cstdint>

#include "pinnquad/control/bias_estimate.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/inference/command_residual.hpp"
#include "pinnquad/inference/joint_distance.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace pinnquad::autopilot::detail {

/// Means over windows of length T. An acceleration is the slope of velocity or body rates by least squares, which
/// weighs the acceleration at time t by t (T - t). State and commands have the same weights, so that all are of one
/// instant, however noisy or rare the samples are. The commands are behind the rotors' lag. Windows begin at whole
/// multiples of T on the samples' clock, so that a replay of a part of the ticks knows where.
class FlownMotion {
 public:
  static constexpr std::uint64_t window_us = 200'000;

  explicit FlownMotion(float rotor_lag_s) noexcept : lag_s_(rotor_lag_s) {}

  void velocity(std::uint64_t time_us, const Vector3<float>& m_s) noexcept { take(time_us, m_s, velocity_); }
  void body_rates(std::uint64_t time_us, const Vector3<float>& rad_s) noexcept { take(time_us, rad_s, rates_); }

  /// Drops the open window: other commands flew, or the estimator was reset.
  void interrupt() noexcept { whole_ = false; }

  /// One tick: the state, and the commands in force since the tick before. True if a window has ended: motion() and
  /// flown() are its. `known`: these commands drove the motors, and the state is fresh.
  bool tick(std::uint64_t now_us, bool known, const State<float>& state, const Commands<float>& commands) noexcept {
    const bool follows = now_us > before_us_ && now_us - before_us_ <= longest_tick_us;
    if (!(known && follows)) {
      whole_ = false;
      rotors_ = commands;
    }
    const std::uint64_t number = now_us / window_us;
    bool ended = false;
    if (number != number_) {
      ended = whole_ && number == number_ + 1 && finish();
      begin(number);
      whole_ = known && follows && now_us - number * window_us <= longest_tick_us;
    }
    if (known && follows) weigh(now_us, 1e-6f * static_cast<float>(now_us - before_us_), state, commands);
    before_us_ = now_us;
    return ended;
  }

  const MotionInputs<float>& motion() const noexcept { return motion_; }
  const Commands<float>& flown() const noexcept { return flown_; }

 private:
  static constexpr float window_s = 1e-6f * static_cast<float>(window_us);
  static constexpr std::uint64_t longest_tick_us = 20'000;

  /// Sums over samples (t, v), t from the middle of the window.
  struct Slope {
    float count = 0, t = 0, tt = 0;
    Vector3<float> v = Vector3<float>::Zero(), tv = Vector3<float>::Zero();

    /// False where the samples don't cover the window.
    bool solve(Vector3<float>& slope) const noexcept {
      constexpr float least = 0.7f * window_s * window_s / 12;  // of the variance of t
      const float spread = count * tt - t * t;
      if (!(count >= 4 && spread >= least * count * count)) return false;
      slope = (count * tv - t * v) / spread;
      return true;
    }
  };

  void take(std::uint64_t time_us, const Vector3<float>& value, Slope& slope) noexcept {
    if (time_us / window_us != number_) return;
    const float t = 1e-6f * static_cast<float>(time_us - number_ * window_us) - 0.5f * window_s;
    slope.count += 1;
    slope.t += t;
    slope.tt += t * t;
    slope.v += value;
    slope.tv += t * value;
  }

  void begin(std::uint64_t number) noexcept {
    number_ = number;
    velocity_ = rates_ = {};
    weight_ = 0;
    attitude_ = {0, 0, 0, 0};
    mean_velocity_.setZero();
    mean_rates_.setZero();
    mean_commands_ = {};
  }

  void weigh(std::uint64_t now_us, float step_s, const State<float>& state, const Commands<float>& commands) noexcept {
    const float t = 1e-6f * static_cast<float>(now_us - number_ * window_us);
    const float weight = t * (window_s - t) * step_s;
    const float share = step_s / (lag_s_ + step_s);
    weight_ += weight;
    mean_velocity_ += weight * state.velocity_m_s;
    mean_rates_ += weight * state.body_rates_rad_s;
    const Quaternion<float>& q = state.attitude;
    const float along = attitude_.w * q.w + attitude_.x * q.x + attitude_.y * q.y + attitude_.z * q.z;
    const float turn = along < 0 ? -weight : weight;  // q and -q are one attitude
    attitude_ = {attitude_.w + turn * q.w, attitude_.x + turn * q.x, attitude_.y + turn * q.y,
                 attitude_.z + turn * q.z};
    for (std::size_t i = 0; i < commands.size(); ++i) {
      rotors_[i] += share * (commands[i] - rotors_[i]);
      mean_commands_[i] += weight * rotors_[i];
    }
  }

  /// False where the window holds too little.
  PINNQUAD_NOINLINE bool finish() noexcept {
    Vector3<float> world_m_s2;
    Accelerations<float> measured;
    const float length = squared_norm(attitude_);
    if (!(weight_ > 0 && length > 0 && velocity_.solve(world_m_s2) && rates_.solve(measured.angular_rad_s2)))
      return false;
    const float scale = 1 / std::sqrt(length);
    State<float> mean;
    mean.velocity_m_s = mean_velocity_ / weight_;
    mean.body_rates_rad_s = mean_rates_ / weight_;
    mean.attitude = {scale * attitude_.w, scale * attitude_.x, scale * attitude_.y, scale * attitude_.z};
    measured.linear_m_s2 = body_derivative<float>(mean, world_m_s2);
    motion_ = motion_inputs(mean, measured);
    for (std::size_t i = 0; i < flown_.size(); ++i) flown_[i] = mean_commands_[i] / weight_;
    return true;
  }

  float lag_s_;
  std::uint64_t before_us_ = 0;
  std::uint64_t number_ = 0;  ///< of the window
  bool whole_ = false;        ///< so far, since it began
  Slope velocity_, rates_;
  float weight_ = 0;
  Vector3<float> mean_velocity_ = Vector3<float>::Zero();
  Vector3<float> mean_rates_ = Vector3<float>::Zero();
  Quaternion<float> attitude_{0, 0, 0, 0};
  Commands<float> rotors_{};  ///< behind their lag
  Commands<float> mean_commands_{};
  MotionInputs<float> motion_{};
  Commands<float> flown_{};
};

/// The command residual of the model that flies. `Trust`: the struct of trust.hpp; void: nothing is measured.
template <class Trust>
class FlownTrust {
 public:
  static constexpr bool known = true;

  explicit FlownTrust(float rotor_lag_s) noexcept : motion_(rotor_lag_s) {}

  bool trusted() const noexcept { return monitor_.trusted(); }
  float command_residual() const noexcept { return monitor_.mean(); }
  FlownMotion& motion() noexcept { return motion_; }
  void resume(float command_residual, bool trusted) noexcept { monitor_.resume(command_residual, trusted); }

  /// For another model, or on the ground.
  void reset() noexcept {
    monitor_.reset();
    motion_.interrupt();
  }

  /// One tick, as FlownMotion's. A motion outside the envelope changes nothing: the guard declines it, and the limits
  /// are of rows within.
  template <class Inverse>
  void tick(std::uint64_t now_us, bool known_commands, const State<float>& state, const Commands<float>& commands,
            const Inverse& inverse) noexcept {
    if (motion_.tick(now_us, known_commands, state, commands)) judge(inverse);
  }

 private:
  /// The limits hold for updates every Trust::update_period_s; a window is as many of them.
  static int periods() noexcept {
    const double count = 1e-6 * static_cast<double>(FlownMotion::window_us) / Trust::update_period_s;
    return count >= 1.5 ? static_cast<int>(count + 0.5) : 1;
  }

  template <class Inverse>
  PINNQUAD_NOINLINE void judge(const Inverse& inverse) noexcept {
    using Features = typename Inverse::Features;
    if (Features::check(motion_.motion()) != Status::ok) return;
    float x[Features::size];
    Features::extract(motion_.motion(), x);
    if (!inverse.inside_envelope(x)) return;
    Commands<float> predicted{};
    inverse.evaluate(x, predicted.data());
    static_cast<void>(monitor_.update(predicted, motion_.flown(), periods()));
  }

  FlownMotion motion_;
  CommandResidualMonitor<Trust> monitor_{};
};

/// Hash of the training data that the limits are of; null where they do not say.
template <class Trust>
const std::uint64_t* training_data() noexcept {
  if constexpr (is_detected<pinnquad::detail::StaticTrainingDataHash, Trust>) return &Trust::training_data_hash;
  return nullptr;
}

template <>
class FlownTrust<void> {
 public:
  static constexpr bool known = false;
  explicit FlownTrust(float /*rotor_lag_s*/) noexcept {}
  static constexpr bool trusted() noexcept { return true; }
  static constexpr float command_residual() noexcept { return 0; }
};

}  // namespace pinnquad::autopilot::detail
