// SPDX-License-Identifier: MIT
// The command residual of the model that flies (docs/trust.md).
#pragma once

#include <cstdint>

#include "pinnquad/core/types.hpp"
#include "pinnquad/inference/command_residual.hpp"
#include "pinnquad/inference/joint_distance.hpp"

namespace pinnquad::detail {

/// The command residual is of two windows of so many motions, each window's mean over residuals with their signs:
/// the noise of a motion's border cancels in the next one.
inline constexpr std::uint32_t motions_of_window = 4;

/// The command residual of the model that flies. `Trust`: the struct of trust.hpp; void: nothing is measured.
template <class Trust>
class FlownTrust {
 public:
  static constexpr bool known = true;

  /// Two windows of flown motions.
  static constexpr std::uint64_t window_us(std::uint32_t period_us) noexcept {
    return std::uint64_t{2 * motions_of_window} * period_us;
  }

  bool trusted() const noexcept { return monitor_.trusted(); }
  float command_residual() const noexcept { return monitor_.mean(); }
  void resume(float command_residual, bool trusted) noexcept { monitor_.resume(command_residual, trusted); }

  /// For another model, or on the ground.
  void reset() noexcept { *this = FlownTrust(); }

  /// The motion of a period of `period_us` and the one before, which has ended by now; the commands that the rotors
  /// followed in it, and those of the model for it with its bias: the residual is of what the bias cannot explain.
  /// Windows begin at whole multiples of their length on the clock. One that lacks a motion says nothing.
  PINNQUAD_NOINLINE void judge(std::uint64_t now_us, std::uint32_t period_us, const Commands<float>& said,
                               const Commands<float>& flown) noexcept {
    const std::uint64_t window = (now_us / period_us - 1) / motions_of_window;
    if (window != now_.number) {
      if (now_.motions == motions_of_window) before_ = now_;
      now_ = {};
      now_.number = window;
    }
    for (std::size_t i = 0; i < said.size(); ++i) now_.sum[i] += flown[i] - said[i];
    if (++now_.motions != motions_of_window || before_.number + 1 != window) return;
    Commands<float> residual{};
    for (std::size_t i = 0; i < residual.size(); ++i) {
      residual[i] = (before_.sum[i] + now_.sum[i]) / static_cast<float>(2 * motions_of_window);
    }
    static_cast<void>(monitor_.update(Commands<float>{}, residual, updates(period_us)));
  }

 private:
  struct Window {
    std::uint64_t number = 0;
    std::uint32_t motions = 0;
    Commands<float> sum{};
  };

  /// The limits hold for updates every Trust::update_period_s; a window is as many of them.
  static int updates(std::uint32_t period_us) noexcept {
    const double count = 1e-6 * static_cast<double>(motions_of_window * period_us) / Trust::update_period_s;
    return count >= 1.5 ? static_cast<int>(count + 0.5) : 1;
  }

  Window before_, now_;
  CommandResidualMonitor<Trust> monitor_{};
};

/// Hash of the training data that the limits are of; null where they do not say.
template <class Trust>
const std::uint64_t* training_data() noexcept {
  if constexpr (is_detected<StaticTrainingDataHash, Trust>) return &Trust::training_data_hash;
  return nullptr;
}

template <>
class FlownTrust<void> {
 public:
  static constexpr bool known = false;
  static constexpr bool trusted() noexcept { return true; }
  static constexpr float command_residual() noexcept { return 0; }
  static constexpr std::uint64_t window_us(std::uint32_t) noexcept { return 0; }
  static void resume(float, bool) noexcept {}
  static void reset() noexcept {}
};

}  // namespace pinnquad::detail
