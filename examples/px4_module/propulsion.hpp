// SPDX-License-Identifier: MIT
// Between the model's commands, thrust over the greatest at the rated air density, and PX4's motor controls. Pure
// C++17.
#pragma once

#include <algorithm>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/dynamics/airframe.hpp"

namespace pinnquad_px4 {

/// PX4 makes a motor's signal s of its control: control = k s^2 + (1 - k) s, k its THR_MDL_FAC. Where the propulsion is
/// another curve than that, or the air another than the rated, the control for a thrust is another too.
class Propulsion {
 public:
  Propulsion() = default;
  /// `curve` is the propulsion's own k, negative: as PX4 says. A density that is none counts as the rated one.
  Propulsion(float air_density_kg_m3, float curve, float px4_curve) noexcept
      : thrust_scale_(air_density_kg_m3 > 0 ? air_density_kg_m3 / pinnquad::rated_air_density_kg_m3<float> : 1.0f),
        px4_curve_(within(px4_curve)),
        curve_(curve < 0 ? px4_curve_ : within(curve)) {}

  /// PX4's control for a thrust over the greatest at the rated density.
  float control(float thrust) const noexcept {
    const float there = thrust / thrust_scale_;
    if (pinnquad::detail::equal(curve_, px4_curve_)) return there;
    return pinnquad::thrust_fraction(px4_curve_, pinnquad::command_of_fraction(curve_, there));
  }
  /// The controls of the rotors' thrusts: times the battery's scale, as PX4's rate controller has it; what does not fit
  /// below 1 gives way as thrust, the same for all, so that the torque stays.
  template <class Thrusts, std::size_t Count>
  void controls(const Thrusts& thrusts, float (&controls)[Count]) const noexcept {
    float most = 0;
    for (std::size_t i = 0; i < Count; ++i) {
      controls[i] = battery_scale_ * control(thrusts[i]);
      most = std::max(most, controls[i]);
    }
    if (!(battery_scale_ > 1 && most > 1)) return;
    for (float& u : controls) u = std::max(0.0f, u - (most - 1));
  }

  /// battery_status.scale: from 1 on; what is none (-1, NaN) or beyond what a battery that may fly has counts as 1.
  void battery_scale(float scale) noexcept {
    constexpr float most = 1.5f;
    battery_scale_ = pinnquad::is_finite(scale) && scale >= 1 && scale <= most ? scale : 1.0f;
  }

  /// The thrust that a control makes.
  float thrust(float control) const noexcept {
    if (pinnquad::detail::equal(curve_, px4_curve_)) return control * thrust_scale_;
    return thrust_scale_ * pinnquad::thrust_fraction(curve_, pinnquad::command_of_fraction(px4_curve_, control));
  }

 private:
  static float within(float curve) noexcept { return curve > 0 ? (curve < 1 ? curve : 1.0f) : 0.0f; }

  float thrust_scale_{1};
  float battery_scale_{1};
  float px4_curve_{0};
  float curve_{0};
};

}  // namespace pinnquad_px4
