// SPDX-License-Identifier: MIT
// Wake: in fast flight the rotors behind work in the downwash of those before them and lift less.
#pragma once

#include <array>
#include <cstddef>

#include "pinnquad/aero/inflow.hpp"

namespace pinnquad {

/// dT_i = -depth B(V) g_i T_i along each rotor's axis, at its hub: the nose rises. V is the air-relative speed in the
/// body's x-y plane, V_p = peak_speed v_h, d the direction of flight, Delta = r_i - r_j in that plane:
///   B = 4 s^2 / (1 + s^2)^2,  s = V / V_p                      1 at V_p, none at rest, little in a thin wake
///   g_i = sum over j of b^2 / (R^2 + b^2) / (1 + c^2 / R^2)^2,  b = max(-Delta . d, 0), c^2 = Delta^2 - (Delta . d)^2
/// A rotor four radii right behind another has g = 0.94, the one before none. No rates, no climb: below its rotors a
/// climbing vehicle leaves its wake sooner. Smooth to the first derivative, also at rest.
/// The shape is ours. Its numbers follow momentum theory: a wake that sinks by w / x per length and pushes 2 w in its
/// middle, 2 w / (1 + (sink / R)^2) above it, takes at most 0.27 of the thrust four radii behind, at V = 3 to 4 v_h; at
/// 1 v_h it passes below. Real wakes diffuse: the default is about half of that. The effect: Luo, Zhu and Yan, Novel
/// quadrotor forward-flight model based on wake interference (AIAA Journal 2015); no number here is theirs.
struct Wake {
  static constexpr VariesWith varies_with = VariesWith::motion;
  double depth{0.15};      ///< share of thrust that a rotor right behind another loses at most
  double peak_speed{2.5};  ///< V_p over the hover's induced velocity

  /// The rotors of one airframe.
  template <class Scalar>
  struct Hover {
    static constexpr VariesWith varies_with = VariesWith::motion;
    Scalar depth{};
    Scalar peak_speed_m_s{};

    /// depth B g_i for a velocity in the body's x-y plane, m/s.
    PINNQUAD_ALWAYS_INLINE std::array<Scalar, rotor_count> lost_shares(
        Scalar forward_m_s, Scalar right_m_s, const Airframe<Scalar>& airframe) const noexcept {
      const Scalar slow = Scalar(1e-6);  // s^2 below which there is no direction
      const Scalar x = forward_m_s / peak_speed_m_s, y = right_m_s / peak_speed_m_s, s2 = x * x + y * y;
      const Scalar bell = Scalar(4) * depth * s2 / ((Scalar(1) + s2) * (Scalar(1) + s2));
      const Scalar per_length = Scalar(1) / detail::square_root(s2 + slow);
      const Scalar along_x = x * per_length, along_y = y * per_length;
      const Scalar per_radius = Scalar(2) / airframe.propeller_diameter_m;
      std::array<Scalar, rotor_count> lost{};
      for (std::size_t i = 0; i < rotor_count; ++i) {
        for (std::size_t j = 0; j < rotor_count; ++j) {
          const Scalar dx = (airframe.rotors[i].x_m - airframe.rotors[j].x_m) * per_radius;
          const Scalar dy = (airframe.rotors[i].y_m - airframe.rotors[j].y_m) * per_radius;
          const Scalar ahead = dx * along_x + dy * along_y, behind = detail::positive_part(-ahead);
          const Scalar beside = Scalar(1) + (dx * dx + dy * dy - ahead * ahead);
          lost[i] += bell * (behind * behind) / ((Scalar(1) + behind * behind) * (beside * beside));
        }
      }
      return lost;
    }

    /// `Same` is `Scalar`: the contract's functions are templates.
    template <class Same>
    PINNQUAD_ALWAYS_INLINE Wrench<Same> wrench(const RotorCondition<Same>& condition,
                                               const Airframe<Same>& airframe) const noexcept {
      const Vector3<Scalar>& v = condition.air_relative_velocity_m_s;
      const std::array<Scalar, rotor_count> lost = lost_shares(v[0], v[1], airframe);
      Wrench<Scalar> result;
      for (std::size_t i = 0; i < rotor_count; ++i) {
        detail::add_at_hub(airframe.rotors[i], -lost[i] * condition.rotor_thrust_N[i], result);
      }
      return result;
    }
  };

  template <class Scalar>
  Hover<Scalar> bound(const Airframe<Scalar>& airframe) const noexcept {
    return {Scalar(depth), Scalar(peak_speed) * detail::hover_induced_velocity_m_s(airframe)};
  }

  /// `out_of_range` for a depth outside 0 to 0.3, where three rotors could take all thrust, or a speed that isn't
  /// positive.
  template <class Scalar>
  constexpr Status status(const Airframe<Scalar>&) const noexcept {
    return depth >= 0 && depth <= 0.3 && detail::plausible(peak_speed) ? Status::ok : Status::out_of_range;
  }
};

}  // namespace pinnquad
