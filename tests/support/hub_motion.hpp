// SPDX-License-Identifier: MIT
// The motion of a rotor's hub through the air, by vectors and in double.
#pragma once

#include "pinnquad/aero/effect.hpp"

namespace pinnquad::test {

struct HubMotion {
  Vector3<double> arm, axis, velocity;  ///< FRD; relative to the air
};

template <class Scalar>
HubMotion hub_motion(const AeroCondition<Scalar>& condition, const RotorMount<Scalar>& hub) {
  const Vector3<double> arm = Vector3<Scalar>(hub.x_m, hub.y_m, hub.z_m).template cast<double>();
  const Vector3<double> rates = condition.body_rates_rad_s.template cast<double>();
  return {arm, to_vector(hub.axis).template cast<double>(),
          condition.air_relative_velocity_m_s.template cast<double>() + cross<double>(rates, arm)};
}

}  // namespace pinnquad::test
