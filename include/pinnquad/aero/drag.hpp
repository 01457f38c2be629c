// SPDX-License-Identifier: MIT
// Drag: of the body, quadratic in the air-relative velocity; linear in the motion; of the rotors.
#pragma once

#include "pinnquad/aero/effect.hpp"

namespace pinnquad {

/// F_i = -k_i rho |v_i| v_i for |v_i| above the airframe's deadband, else 0; body axes, no torque.
/// v is relative to the air, k from Airframe::drag_area_m2. Source: the paper's simulator.
struct QuadraticDrag {
  static constexpr VariesWith varies_with = VariesWith::motion;

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> wrench(const AeroCondition<Scalar>& condition,
                                               const Airframe<Scalar>& airframe) const noexcept {
    Wrench<Scalar> result;
    for (int i = 0; i < 3; ++i) {
      const Scalar v = condition.air_relative_velocity_m_s[i];
      const Scalar speed = select(v < Scalar(0), Scalar(-v), v);
      const Scalar k = airframe.drag_area_m2[static_cast<std::size_t>(i)];
      // chosen, not branched: near the deadband a branch would be guessed wrong
      const Scalar drag = -(k * condition.air_density_kg_m3) * (speed * v);
      result.force_N[i] = select(speed <= airframe.drag_deadband_m_s, Scalar(0), drag);
    }
    return result;
  }
};

/// F = -k v, tau = -c omega: v the air-relative velocity, body axes, k the same along each of them. PX4's simulation in
/// hardware has both (SIH_KDV and SIH_KDW, whose values are the default here; it has no wind); near hover it stands for
/// a slow vehicle's drag.
struct LinearDamping {
  static constexpr VariesWith varies_with = VariesWith::motion;
  double drag_N_s_m{1.0};
  double rate_damping_N_m_s{0.025};

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> wrench(const AeroCondition<Scalar>& condition,
                                               const Airframe<Scalar>&) const noexcept {
    Wrench<Scalar> result;
    result.force_N = condition.air_relative_velocity_m_s * Scalar(-drag_N_s_m);
    result.torque_N_m = condition.body_rates_rad_s * Scalar(-rate_damping_N_m_s);
    return result;
  }

  /// `out_of_range` for a coefficient that is negative or no number.
  template <class Scalar>
  constexpr Status status(const Airframe<Scalar>&) const noexcept {
    return detail::plausible_or_zero(drag_N_s_m) && detail::plausible_or_zero(rate_damping_N_m_s)
               ? Status::ok
               : Status::out_of_range;
  }
};

/// F = -k sum_i T_i (v_i - a_i (a_i . v_i)), v_i = v + omega x r_i the hub's air-relative velocity, body axes, a_i the
/// rotor's axis: of an upright rotor -k T_i (v_i,x, v_i,y, 0). The force acts at the hub, so a turning vehicle feels a
/// torque r_i x F_i too.
/// k [s/m] is the H-force coefficient over thrust, about 0.01 to 0.05 for small propellers. Proportional to thrust, as
/// in Martin and Salaun, The true role of accelerometer feedback in quadrotor control (2010), near hover.
struct RotorDrag {
  static constexpr VariesWith varies_with = VariesWith::motion;
  double coefficient_s_m{0.02};

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> wrench(const RotorCondition<Scalar>& condition,
                                               const Airframe<Scalar>& airframe) const noexcept {
    const Vector3<Scalar>& v = condition.air_relative_velocity_m_s;
    const Vector3<Scalar>& rates = condition.body_rates_rad_s;
    const Scalar k = Scalar(coefficient_s_m);
    Wrench<Scalar> result;
    for (std::size_t i = 0; i < rotor_count; ++i) {
      const RotorMount<Scalar>& hub = airframe.rotors[i];
      const Scalar thrust = condition.rotor_thrust_N[i];
      const Mask<Scalar> plain = is_upright(hub) && detail::equal(hub.z_m, Scalar(0));
      const Wrench<Scalar> before = result;
      if (any_of(plain)) {
        const Scalar force_x = -k * thrust * (v[0] - rates[2] * hub.y_m);
        const Scalar force_y = -k * thrust * (v[1] + rates[2] * hub.x_m);
        result.force_N[0] += force_x;
        result.force_N[1] += force_y;
        result.torque_N_m[2] += hub.x_m * force_y - hub.y_m * force_x;
      }
      if (!all_of(plain)) result = select(plain, result, with_any(hub, v, rates, k * thrust, before));
    }
    return result;
  }

  /// `out_of_range` for a coefficient that is negative or no number.
  template <class Scalar>
  constexpr Status status(const Airframe<Scalar>&) const noexcept {
    return detail::plausible_or_zero(coefficient_s_m) ? Status::ok : Status::out_of_range;
  }

 private:
  /// One tilted rotor, or one above or below the centre of gravity.
  template <class Scalar>
  static PINNQUAD_NOINLINE Wrench<Scalar> with_any(const RotorMount<Scalar>& hub, const Vector3<Scalar>& v,
                                                   const Vector3<Scalar>& rates, Scalar drag_N_s_m,
                                                   Wrench<Scalar> sum) noexcept {
    const Vector3<Scalar> arm(hub.x_m, hub.y_m, hub.z_m), axis = to_vector(hub.axis);
    const Vector3<Scalar> moving = v + cross<Scalar>(rates, arm);
    const Vector3<Scalar> force = (axis * dot(axis, moving) - moving) * drag_N_s_m;
    sum.force_N += force;
    sum.torque_N_m += cross<Scalar>(arm, force);
    return sum;
  }
};

}  // namespace pinnquad
