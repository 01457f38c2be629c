// SPDX-License-Identifier: MIT
// Whether a model makes the acceleration that it is asked for: not if the bias has to ask for more than a bias may. The formula
// flies then, with a bias of its own, until hardly any of that is left.
#pragma once

#include <cmath>

#include "pinnquad/control/bias_estimate.hpp"

namespace pinnquad::autopilot {

/// Of the bias only the part along the thrust is the model's: across it rotors make nothing, and drag and wind that are there stay,
/// whoever answers. Raised once the bias has stood at its bound for `raise_s`, with half of the bound or more along the thrust;
/// cleared once that part has been below a quarter of the bound for `clear_s`. Time that says otherwise is taken off.
class BiasAlarm {
 public:
  static constexpr float raise_s = 0.5f, clear_s = 2.0f;

  bool raised() const noexcept { return raised_; }
  /// Another model, or a vehicle that is not flown.
  void reset() noexcept { *this = BiasAlarm(); }
  /// Goes on from what was written down.
  void resume(bool raised) noexcept {
    if (raised == raised_) return;
    raised_ = raised;
    for_s_ = 0;
  }

  /// One step of the estimate; `down`: the body's z axis, NED. Longer steps than a tenth of a second are gaps.
  void update(const BiasEstimate<float>& bias, const Vector3<float>& down, float step_s) noexcept {
    constexpr float half = 0.5f, quarter = 0.25f, longest_s = 0.1f;
    if (!(step_s > 0 && step_s <= longest_s)) return;
    const float along = std::abs(down.dot(bias.acceleration_m_s2())), bound = bias.settings().max_bias_m_s2;
    const bool turns = raised_ ? along < quarter * bound : bias.at_bound() && along >= half * bound;
    for_s_ = turns ? for_s_ + step_s : (for_s_ > step_s ? for_s_ - step_s : 0.0f);
    if (for_s_ >= (raised_ ? clear_s : raise_s)) resume(!raised_);
  }

 private:
  float for_s_ = 0;  ///< how long the bias has said otherwise
  bool raised_ = false;
};

}  // namespace pinnquad::autopilot
