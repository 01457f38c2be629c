// SPDX-License-Identifier: MIT
// Linear rotor drag: blade flapping and induced drag tilt each rotor's thrust against the air that crosses its disc.
#pragma once

#include "pinnquad/aero/effect.hpp"

namespace pinnquad {

/// F = -k sum_i T_i (v_i,x, v_i,y, 0), v_i = v + omega x r_i the hub's air-relative velocity, body axes; the force acts at
/// the hub, so a turning vehicle feels a yaw torque r_i x F_i too.
/// k [s/m] is the H-force coefficient over thrust, about 0.01 to 0.05 for small propellers. Proportional to thrust, as in
/// Martin and Salaun, The true role of accelerometer feedback in quadrotor control (2010), near hover.
struct RotorDrag {
  static constexpr VariesWith varies_with = VariesWith::motion;
  double coefficient_s_m{0.02};

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> wrench(const RotorCondition<Scalar>& condition,
                                               const Airframe<Scalar>& airframe) const noexcept {
    const Vector3<Scalar>& v = condition.air_relative_velocity_m_s;
    const Scalar yaw_rate = condition.body_rates_rad_s[2];
    const Scalar k = Scalar(coefficient_s_m);
    Wrench<Scalar> result;
    for (std::size_t i = 0; i < rotor_count; ++i) {
      const RotorMount<Scalar>& hub = airframe.rotors[i];
      const Scalar thrust = condition.rotor_thrust_N[i];
      const Scalar force_x = -k * thrust * (v[0] - yaw_rate * hub.y_m);
      const Scalar force_y = -k * thrust * (v[1] + yaw_rate * hub.x_m);
      result.force_N[0] += force_x;
      result.force_N[1] += force_y;
      result.torque_N_m[2] += hub.x_m * force_y - hub.y_m * force_x;
    }
    return result;
  }

  /// `out_of_range` for a coefficient that is negative or no number.
  template <class Scalar>
  constexpr Status status(const Airframe<Scalar>&) const noexcept {
    return detail::plausible_or_zero(coefficient_s_m) ? Status::ok : Status::out_of_range;
  }
};

}  // namespace pinnquad
