// SPDX-License-Identifier: MIT
// An alarm of the bias: a model that needs a bias at its bound does not make the acceleration that it is asked for. The
// analytic inverse flies then, with a bias of its own, until hardly any of that is left.
#pragma once

#include <cmath>

#include "pinnquad/control/bias_estimate.hpp"

namespace pinnquad::autopilot::detail {

/// Only the bias along the thrust is the model's fault: across it rotors make no force, and drag and wind stay whoever
/// answers. Raised once the bias has stood at its bound for `raise_s` with half of the bound or more along the thrust;
/// cleared once that part has been below a quarter of the bound for `clear_s`. Time that says otherwise is taken off.
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

  /// One step of the estimate; `down`: the body's z axis, NED. A step above 0.1 s is a gap.
  void update(const BiasEstimate<float>& bias, const Vector3<float>& down, float step_s) noexcept {
    constexpr float half = 0.5f, quarter = 0.25f, longest_s = 0.1f;
    if (!(step_s > 0 && step_s <= longest_s)) return;
    const float along = std::abs(down.dot(bias.acceleration_m_s2())), bound = bias.settings().max_bias_m_s2;
    const bool turns = raised_ ? along < quarter * bound : bias.at_bound() && along >= half * bound;
    for_s_ = turns ? for_s_ + step_s : (for_s_ > step_s ? for_s_ - step_s : 0.0f);
    if (for_s_ >= (raised_ ? clear_s : raise_s)) resume(!raised_);
  }

 private:
  float for_s_ = 0;  ///< time that the bias has said otherwise
  bool raised_ = false;
};

}  // namespace pinnquad::autopilot::detail
