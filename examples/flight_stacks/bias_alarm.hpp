// SPDX-License-Identifier: MIT
// Whether a model makes the accelerations that it is asked for: not if the bias has to ask for more than a bias may. The formula
// flies then, with a bias of its own, until hardly any of that is left.
#pragma once

#include "pinnquad/control/bias_estimate.hpp"

namespace flight_stacks {

/// Raised once the bias has stood at its bound for `raise_s`, cleared once it has been below a quarter of it for `clear_s`; time
/// that says otherwise is taken off. A model that makes more than a quarter of what is asked carries what the formula needs then.
class BiasAlarm {
 public:
  static constexpr float raise_s = 0.5f, clear_s = 2.0f;

  bool raised() const noexcept { return raised_; }
  /// Another model, or a vehicle that is not flown.
  void reset() noexcept { resume(false); }
  /// Goes on from what was written down.
  void resume(bool raised) noexcept {
    if (raised == raised_) return;
    raised_ = raised;
    for_s_ = 0;
  }

  /// One step of the estimate. Longer ones than a tenth of a second are gaps.
  void update(const pinnquad::BiasEstimate<float>& bias, float step_s) noexcept {
    constexpr float nearly_all = 0.99f, quarter = 0.25f, longest_s = 0.1f;
    if (!(step_s > 0 && step_s <= longest_s)) return;
    const bool turns = raised_ ? !bias.reaches(quarter) : bias.reaches(nearly_all);
    for_s_ = turns ? for_s_ + step_s : (for_s_ > step_s ? for_s_ - step_s : 0.0f);
    if (for_s_ >= (raised_ ? clear_s : raise_s)) resume(!raised_);
  }

 private:
  float for_s_ = 0;  ///< how long the bias has said otherwise
  bool raised_ = false;
};

}  // namespace flight_stacks
