// SPDX-License-Identifier: MIT
// The command residual of the model that an autopilot's core flies (docs/trust.md).
#pragma once

#include <cstdint>

#include "pinnquad/control/flown_motion.hpp"
#include "pinnquad/inference/command_residual.hpp"
#include "pinnquad/inference/joint_distance.hpp"

namespace pinnquad::autopilot::detail {

/// The command residual is of two periods of this length.
inline constexpr std::uint32_t residual_period_us = 100'000;

/// The command residual of the model that flies. `Trust`: the struct of trust.hpp; void: nothing is measured.
template <class Trust>
class FlownTrust {
 public:
  static constexpr bool known = true;

  explicit FlownTrust(float rotor_lag_s) noexcept : motion_({residual_period_us, rotor_lag_s, 0}) {}

  bool trusted() const noexcept { return monitor_.trusted(); }
  float command_residual() const noexcept { return monitor_.mean(); }
  FlownMotion<float>& motion() noexcept { return motion_; }
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
  /// The limits hold for updates every Trust::update_period_s; a period is as many of them.
  static int periods() noexcept {
    const double count = 1e-6 * static_cast<double>(residual_period_us) / Trust::update_period_s;
    return count >= 1.5 ? static_cast<int>(count + 0.5) : 1;
  }

  template <class Inverse>
  PINNQUAD_NOINLINE void judge(const Inverse& inverse) noexcept {
    Commands<float> predicted{};
    if (inverse.observed(motion_.motion(), predicted) != Status::ok) return;
    static_cast<void>(monitor_.update(predicted, motion_.flown(), periods()));
  }

  FlownMotion<float> motion_;
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
