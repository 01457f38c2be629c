// SPDX-License-Identifier: MIT
// An alarm of the network's bias: at its bound it no longer carries what the network lacks. The analytic inverse flies
// then, with a bias of its own, until the network needs little of its bias.
#pragma once

namespace pinnquad::autopilot::detail {

/// Raised once the network's bias has stood at its bound for `raise_s` while the analytic inverse's did not. Cleared
/// once it has been below half of its bound for `clear_s`. Time that says otherwise is taken off. Forces across the
/// thrust are no model's fault, and raise nothing.
class BiasAlarm {
 public:
  static constexpr float raise_s = 0.5f, clear_s = 2.0f;

  bool raised() const noexcept { return raised_; }
  /// For another model, or out of flight.
  void reset() noexcept { *this = BiasAlarm(); }
  /// Goes on from what was logged.
  void resume(bool raised) noexcept {
    if (raised == raised_) return;
    raised_ = raised;
    for_s_ = 0;
  }

  /// One step in flight; of both MotionBias::share_of_bound(). A step above 0.1 s is a gap.
  void update(float share, float analytic_share, float step_s) noexcept {
    constexpr float at_bound = 0.99f, half = 0.5f, longest_s = 0.1f;
    if (!(step_s > 0 && step_s <= longest_s)) return;
    const bool turns = raised_ ? share < half : share >= at_bound && analytic_share < at_bound;
    for_s_ = turns ? for_s_ + step_s : (for_s_ > step_s ? for_s_ - step_s : 0.0f);
    if (for_s_ >= (raised_ ? clear_s : raise_s)) resume(!raised_);
  }

 private:
  float for_s_ = 0;  ///< time that the bias has said otherwise
  bool raised_ = false;
};

}  // namespace pinnquad::autopilot::detail
