// SPDX-License-Identifier: MIT
// Contact with the ground: four feet on springs, with damping and friction. A vehicle with it lands.
#pragma once

#include <cstddef>

#include "pinnquad/aero/effect.hpp"
#include "pinnquad/core/scalar_math.hpp"

namespace pinnquad {

/// Four feet, leg_length below the centre of gravity under the rotors' hubs; the ground is the plane at height 0.
/// A foot at depth d > 0, sinking at d', is pushed along the world's vertical and held back across it:
///   N = k d max(1 + b d', 0),  k = m g / (4 d_0),  b = 2 zeta / sqrt(g d_0)             (Hunt and Crossley 1975)
///   F_t = -mu N v_t / (sqrt(v_t^2 + v_s^2) + mu N / c),  c = m / (4 tau), tau = 5 ms    (Coulomb, regularised)
/// d_0 is the depth at which the vehicle stands, zeta the damping ratio about it. No force jumps, none pulls. Between
/// touch and lift-off a foot takes energy: no bounce lasts. Without a state there is no static friction: under a steady
/// push F a vehicle creeps at F / (mu m g) (v_s + mu g tau), 0.5 mm/s in 5 m/s of wind.
/// Stable in RK4 steps of 1 ms for touch-downs of up to 2 m/s. The legs' length is above the vehicle's site, whose
/// ground is the height 0 of its centre: a simulated flight does not end on its legs. Values are ours.
struct GroundContact {
  static constexpr VariesWith varies_with = VariesWith::height;
  double leg_length_m{0.18};     ///< no longer than the feet are apart, or it tips over
  double static_depth_m{0.002};  ///< d_0
  double damping_ratio{0.5};     ///< zeta
  double friction{0.6};          ///< mu, rubber on a dry floor
  double slip_m_s{0.005};        ///< v_s: friction is half of mu N and more above it

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> wrench(const AeroCondition<Scalar>& condition,
                                               const Airframe<Scalar>& airframe) const noexcept {
    const Vector3<Scalar> down = world_down_axis(condition.attitude);
    Wrench<Scalar> result;
    for (std::size_t i = 0; i < rotor_count; ++i) {
      const Vector3<Scalar> arm(airframe.rotors[i].x_m, airframe.rotors[i].y_m, Scalar(leg_length_m));
      const Scalar depth_m = dot(down, arm) - condition.height_above_ground_m;
      const Mask<Scalar> touches = !(depth_m <= Scalar(0));  // NaN goes through
      if (any_of(touches)) {
        result = select(touches, with_foot(condition, airframe, down, arm, depth_m, result), result);
      }
    }
    return result;
  }

  /// `out_of_range` for a length, depth or slip that isn't positive, or a ratio that is negative.
  template <class Scalar>
  constexpr Status status(const Airframe<Scalar>&) const noexcept {
    using detail::plausible;
    const bool holds = plausible(leg_length_m) && plausible(static_depth_m) && plausible(slip_m_s) &&
                       detail::plausible_or_zero(damping_ratio) && detail::plausible_or_zero(friction);
    return holds ? Status::ok : Status::out_of_range;
  }

 private:
  template <class Scalar>
  PINNQUAD_NOINLINE Wrench<Scalar> with_foot(const AeroCondition<Scalar>& condition, const Airframe<Scalar>& airframe,
                                             const Vector3<Scalar>& down, const Vector3<Scalar>& arm, Scalar depth_m,
                                             Wrench<Scalar> sum) const noexcept {
    const Scalar g = standard_gravity_m_s2<Scalar>, slowest_s = Scalar(0.005), four = Scalar(4);
    const Vector3<Scalar> v = condition.ground_velocity_m_s + cross<Scalar>(condition.body_rates_rad_s, arm);
    const Scalar sinking = dot(down, v);
    const Scalar stiffness_N_m = airframe.mass_kg * g / (four * Scalar(static_depth_m));
    const Scalar damping_s_m = Scalar(2 * damping_ratio) / detail::square_root(g * Scalar(static_depth_m));
    const Scalar normal_N = stiffness_N_m * depth_m * detail::positive_part(Scalar(1) + damping_s_m * sinking);
    const Vector3<Scalar> slip = v - down * sinking;
    const Scalar limit_N = Scalar(friction) * normal_N;
    const Scalar speed = detail::square_root(dot(slip, slip) + Scalar(slip_m_s * slip_m_s));
    const Vector3<Scalar> force =
        down * -normal_N - slip * (limit_N / (speed + limit_N * (four * slowest_s / airframe.mass_kg)));
    sum.force_N += force;
    sum.torque_N_m += cross<Scalar>(arm, force);
    return sum;
  }
};

}  // namespace pinnquad
