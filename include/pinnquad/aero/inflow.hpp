// SPDX-License-Identifier: MIT
// Inflow: a rotor at constant speed lifts less in a climb and more in a sideways wind (translational lift).
// Blade element and momentum theory, rotor by rotor, about hover's induced velocity.
#pragma once

#include <array>
#include <cstddef>

#include "pinnquad/aero/effect.hpp"
#include "pinnquad/core/scalar_math.hpp"

namespace pinnquad {

namespace detail {
/// v_h = sqrt(m g / (8 rho A)), A = pi D^2 / 4: the induced velocity of four equal rotors in hover at the rated
/// density, m/s (momentum theory: Leishman, Principles of Helicopter Aerodynamics, 2006, ch. 2).
template <class Scalar>
Scalar hover_induced_velocity_m_s(const Airframe<Scalar>& airframe) noexcept {
  const Scalar two_pi = Scalar(6.283185307179586);
  const Scalar weight_N = airframe.mass_kg * standard_gravity_m_s2<Scalar>;
  const Scalar d = airframe.propeller_diameter_m;
  return square_root(weight_N / (two_pi * rated_air_density_kg_m3<Scalar> * d * d));
}

/// The velocity of a hub through the air, taken apart.
template <class Scalar>
struct HubFlow {
  Vector3<Scalar> velocity_m_s;  ///< v + omega x r, FRD
  Scalar climb_m_s;              ///< along the thrust
  Scalar edgewise_m2_s2;         ///< square of what is left: in the rotor's plane
};

template <class Scalar>
PINNQUAD_ALWAYS_INLINE HubFlow<Scalar> hub_flow(const AeroCondition<Scalar>& condition,
                                                const RotorMount<Scalar>& hub) noexcept {
  const Vector3<Scalar>&v = condition.air_relative_velocity_m_s, &w = condition.body_rates_rad_s;
  const Scalar x = v[0] + w[1] * hub.z_m - w[2] * hub.y_m, y = v[1] + w[2] * hub.x_m - w[0] * hub.z_m,
               z = v[2] + w[0] * hub.y_m - w[1] * hub.x_m;
  const Scalar climb = x * hub.axis[0] + y * hub.axis[1] + z * hub.axis[2];
  const Scalar edge_x = x - climb * hub.axis[0], edge_y = y - climb * hub.axis[1], edge_z = z - climb * hub.axis[2];
  return {Vector3<Scalar>(x, y, z), climb, edge_x * edge_x + edge_y * edge_y + edge_z * edge_z};
}

/// Adds a force along a rotor's thrust at its hub, N.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE void add_at_hub(const RotorMount<Scalar>& hub, Scalar along_N, Wrench<Scalar>& sum) noexcept {
  const Scalar x = hub.axis[0] * along_N, y = hub.axis[1] * along_N, z = hub.axis[2] * along_N;
  sum.force_N += Vector3<Scalar>(x, y, z);
  sum.torque_N_m += Vector3<Scalar>(hub.y_m * z - hub.z_m * y, hub.z_m * x - hub.x_m * z, hub.x_m * y - hub.y_m * x);
}
}  // namespace detail

/// dT_i = (r(x, z) - 1) T_i along each rotor's axis, at its hub. r is the thrust over that in hover at the same rotor
/// speed; x and z are the hub's edgewise speed and its climb over the hover's induced velocity v_h. In these units,
/// with u = w + z the flow through the disc and w the induced velocity,
///   blade elements  r = (1 + k) (1 + 3/2 mu^2) - k u,  mu = lambda_h x,  k = sigma a / (8 lambda_h)
///   momentum        r = (u - z) sqrt(x^2 + u^2)                                  (Glauert)
/// lambda_h = sqrt(2 C_T / pi^3) is the hover's inflow ratio. About hover dr/dz = -k / (2 + k), and sideways
/// r - 1 = (k / 2 + 3 (1 + k) lambda_h^2) x^2 / (2 + k). Solved by five Newton steps from the root at x = 0.
/// v_h is the hover's, whatever the command: r does not depend on it, and the inverse stays exact. At another thrust
/// the true v_h goes with its root. The reaction torque stays that at rest: C_P falls by a third to a half of C_T's
/// fall (UIUC).
/// Range: z as it is from -0.5 to 0.65 z_0, z_0 = (1 + k) / k the climb without thrust; beyond, held smoothly above -1
/// and below 0.85 z_0. There is no vortex ring state and no windmill.
/// Source: Leishman (2006), ch. 2 and 3, uniform inflow; for quadrotors Huang, Hoffmann, Waslander and Tomlin,
/// Aerodynamics and control of autonomous quadrotor helicopters in aggressive maneuvering (ICRA 2009). The defaults are
/// within 0.02 of the UIUC propeller database's thrust ratios of the APC 10x4.7 in climb, J = 0.09 to 0.45.
struct Inflow {
  static constexpr VariesWith varies_with = VariesWith::motion;
  /// N c / (pi R), mean over the disc. Default: APC Slow Flyer 10x4.7, chords of the UIUC propeller database.
  double solidity{0.107};
  /// a: 5.7 per radian (Leishman, ch. 3) times 0.9 for tip loss, the square of B = 0.95.
  double lift_slope_1_rad{5.1};

  /// The rotors of one airframe.
  template <class Scalar>
  struct Hover {
    static constexpr VariesWith varies_with = VariesWith::motion;
    Scalar induced_velocity_m_s{};  ///< v_h at the rated density
    Scalar inflow_ratio{};          ///< lambda_h
    Scalar gain{};                  ///< k

    /// r at a square of the edgewise speed and a climb, both in v_h.
    PINNQUAD_ALWAYS_INLINE Scalar thrust_ratio(Scalar edgewise_square, Scalar climb) const noexcept {
      return thrust_ratios<1>({edgewise_square}, {climb})[0];
    }

    template <std::size_t Count>
    PINNQUAD_ALWAYS_INLINE std::array<Scalar, Count> thrust_ratios(
        const std::array<Scalar, Count>& edgewise_square, const std::array<Scalar, Count>& climb) const noexcept {
      constexpr int newton_steps = 5;
      const Scalar k = gain, still = Scalar(1) + k;
      std::array<Scalar, Count> z{}, lift{}, u{};
      for (std::size_t i = 0; i < Count; ++i) {
        z[i] = held(climb[i], still / k);
        lift[i] = still * (Scalar(1) + Scalar(1.5) * inflow_ratio * inflow_ratio * edgewise_square[i]);
        const Scalar half = (z[i] - k) / Scalar(2);
        u[i] = half + detail::square_root(half * half + still);
      }
      for (int step = 0; step < newton_steps; ++step) {
        for (std::size_t i = 0; i < Count; ++i) {
          const Scalar speed = detail::square_root(edgewise_square[i] + u[i] * u[i]), induced = u[i] - z[i];
          const Scalar excess = induced * speed - (lift[i] - k * u[i]);
          u[i] -= excess / (speed + induced * u[i] / speed + k);
        }
      }
      std::array<Scalar, Count> ratio{};
      for (std::size_t i = 0; i < Count; ++i) ratio[i] = lift[i] - k * u[i];
      return ratio;
    }

    /// `Same` is `Scalar`: the contract's functions are templates.
    template <class Same>
    PINNQUAD_ALWAYS_INLINE Wrench<Same> wrench(const RotorCondition<Same>& condition,
                                               const Airframe<Same>& airframe) const noexcept {
      // thin air is moved faster: v_h goes with the inverse root of its density
      const Scalar scale = detail::square_root(condition.air_density_kg_m3 / rated_air_density_kg_m3<Scalar>);
      const Scalar per_v = scale / induced_velocity_m_s;
      std::array<Scalar, rotor_count> edgewise_square{}, climb{};
      for (std::size_t i = 0; i < rotor_count; ++i) {
        const detail::HubFlow<Scalar> flow = detail::hub_flow(condition, airframe.rotors[i]);
        edgewise_square[i] = flow.edgewise_m2_s2 * (per_v * per_v);
        climb[i] = flow.climb_m_s * per_v;
      }
      const std::array<Scalar, rotor_count> ratio = thrust_ratios(edgewise_square, climb);
      Wrench<Scalar> result;
      for (std::size_t i = 0; i < rotor_count; ++i) {
        detail::add_at_hub(airframe.rotors[i], (ratio[i] - Scalar(1)) * condition.rotor_thrust_N[i], result);
      }
      return result;
    }

   private:
    /// z up to `straight`, then bent towards `straight + span`, with a slope that has no step.
    static PINNQUAD_ALWAYS_INLINE Scalar held(Scalar z, Scalar without_thrust) noexcept {
      const Mask<Scalar> down = z < Scalar(0);
      const Scalar straight = select(down, Scalar(0.5), Scalar(Scalar(0.65) * without_thrust));
      const Scalar span = select(down, Scalar(0.5), Scalar(Scalar(0.2) * without_thrust));
      const Scalar magnitude = select(down, Scalar(-z), z), beyond = magnitude - straight;
      const Mask<Scalar> bends = beyond > Scalar(0);
      if (!any_of(bends)) return z;  // NaN stays NaN
      const Scalar bent = straight + span * (beyond / (span + beyond));
      return select(bends, select(down, Scalar(-bent), bent), z);
    }
  };

  template <class Scalar>
  Hover<Scalar> bound(const Airframe<Scalar>& airframe) const noexcept {
    const Scalar pi_cubed = Scalar(31.006276680299816);
    Hover<Scalar> hover;
    hover.induced_velocity_m_s = detail::hover_induced_velocity_m_s(airframe);
    hover.inflow_ratio = detail::square_root(Scalar(2) * airframe.thrust_coefficient / pi_cubed);
    hover.gain = Scalar(solidity * lift_slope_1_rad) / (Scalar(8) * hover.inflow_ratio);
    return hover;
  }

  /// `out_of_range` for a solidity above 1, a lift slope above 4 pi, or one of them that isn't positive.
  template <class Scalar>
  constexpr Status status(const Airframe<Scalar>&) const noexcept {
    constexpr double four_pi = 12.566370614359172;
    const bool holds = solidity > 0 && solidity <= 1 && lift_slope_1_rad > 0 && lift_slope_1_rad <= four_pi;
    return holds ? Status::ok : Status::out_of_range;
  }
};

}  // namespace pinnquad
