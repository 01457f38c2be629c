// SPDX-License-Identifier: MIT
// Ground effect rotor by rotor: a tilted vehicle's low side lifts more than its high side and turns it level.
#pragma once

#include "pinnquad/aero/ground_effect.hpp"

namespace pinnquad {

/// dT_i = (r(Z_i / R) - 1) |R_zz| T_i along the axis of rotor i (body -z unless tilted), at its hub, with Z_i the height of the
/// hub above ground and |R_zz| the vertical share of its thrust: an alternative to GroundEffect, which applies one ratio at
/// the vehicle's centre and makes no torque. Level and without drag both give the same force. `ThrustRatio` as in
/// GroundEffect: a hub below its range, as one that a tilt brings under the ground, has the ratio that it states there.
template <class ThrustRatio>
struct RotorGroundEffect {
  static constexpr VariesWith varies_with = VariesWith::height;
  ThrustRatio ratio{};

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> wrench(const RotorCondition<Scalar>& condition,
                                               const Airframe<Scalar>& airframe) const noexcept {
    const Scalar per_radius_1_m = Scalar(2) / airframe.propeller_diameter_m;
    const Vector3<Scalar> down = world_down_axis(condition.attitude);
    const Scalar share = down[2] < Scalar(0) ? -down[2] : down[2];
    Wrench<Scalar> result;
    for (std::size_t i = 0; i < rotor_count; ++i) {
      const RotorMount<Scalar>& hub = airframe.rotors[i];
      if (!is_upright(hub) || !detail::equal(hub.z_m, Scalar(0))) {
        add_anywhere(hub, condition, airframe, condition.rotor_thrust_N[i], result);
        continue;
      }
      const Scalar height_m = condition.height_above_ground_m - (down[0] * hub.x_m + down[1] * hub.y_m);
      const Scalar r = ratio.thrust_ratio(height_m * per_radius_1_m, airframe);
      const Scalar lift = (r - Scalar(1)) * share * condition.rotor_thrust_N[i];
      result.force_N[2] -= lift;
      result.torque_N_m[0] -= hub.y_m * lift;
      result.torque_N_m[1] += hub.x_m * lift;
    }
    return result;
  }

  template <class Scalar>
  auto bound(const Airframe<Scalar>& airframe) const noexcept {
    if constexpr (is_bindable<ThrustRatio, Scalar>) {
      return RotorGroundEffect<decltype(ratio.bound(airframe))>{ratio.bound(airframe)};
    } else {
      return *this;
    }
  }

  template <class Scalar>
  constexpr Status status(const Airframe<Scalar>& airframe) const noexcept {
    return effect_status(ratio, airframe);
  }

 private:
  /// One tilted rotor, or one above or below the centre of gravity.
  template <class Scalar>
  void add_anywhere(const RotorMount<Scalar>& hub, const RotorCondition<Scalar>& condition,
                    const Airframe<Scalar>& airframe, Scalar thrust_N, Wrench<Scalar>& sum) const noexcept {
    const Vector3<Scalar> down = world_down_axis(condition.attitude);
    const Vector3<Scalar> arm(hub.x_m, hub.y_m, hub.z_m), axis = to_vector(hub.axis);
    const Scalar upright = down.dot(axis), share = upright < Scalar(0) ? -upright : upright;
    const Scalar height_m = condition.height_above_ground_m - down.dot(arm);
    const Scalar r = ratio.thrust_ratio(height_m * (Scalar(2) / airframe.propeller_diameter_m), airframe);
    const Vector3<Scalar> force = axis * ((r - Scalar(1)) * share * thrust_N);
    sum.force_N += force;
    sum.torque_N_m += cross<Scalar>(arm, force);
  }
};

using CheesemanBennettRotorGroundEffect = RotorGroundEffect<CheesemanBennett>;
using ConyersRotorGroundEffect = RotorGroundEffect<Conyers>;

}  // namespace pinnquad
