// SPDX-License-Identifier: MIT
// The rigid body's inverse of motion features (features/motion_parts.hpp) as a base, without the angular acceleration:
// the slope by it is the model's own (model/axis_aligned.hpp).
#pragma once

#include <limits>

#include "pinnquad/outputs/base.hpp"
#include "pinnquad/outputs/output_schema.hpp"
#include "pinnquad/outputs/rotor_map.hpp"

namespace pinnquad {

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Constants of an airframe.
template <class Scalar>
struct RigidBody {
  RotorMap<Scalar> map;  ///< of thrust along -z and torque
  Scalar mass_kg{};
  Scalar inertia_kg_m2[3][3]{};

  /// (thrust, torque) of a specific force along z and body rates: (-m s_z, w x J w).
  PINNQUAD_ALWAYS_INLINE void wrench(Scalar force_z, const Scalar* w, Scalar* wrench) const noexcept {
    Scalar momentum[3];
    times(w, momentum);
    wrench[0] = -mass_kg * force_z;
    wrench[1] = w[1] * momentum[2] - w[2] * momentum[1];
    wrench[2] = w[2] * momentum[0] - w[0] * momentum[2];
    wrench[3] = w[0] * momentum[1] - w[1] * momentum[0];
  }
  /// J w.
  PINNQUAD_ALWAYS_INLINE void times(const Scalar* w, Scalar* momentum) const noexcept {
    for (int i = 0; i < 3; ++i) {
      momentum[i] = inertia_kg_m2[i][0] * w[0] + inertia_kg_m2[i][1] * w[1] + inertia_kg_m2[i][2] * w[2];
    }
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

/// Thrust from the specific force along z, torque from w x J w; air of the rated density, no drag. For PhysicsFeatures
/// and feature sets that begin with specific force, angular acceleration, body rates.
struct RigidBodyBase {
  static constexpr const char* description = "pinnquad::RigidBodyInverse";
  static constexpr int force_z = 2;  ///< place among the features
  static constexpr int body_rates = 6;
  static constexpr std::array<ReadFeature, 4> reads = {{{force_z, "s_z", "m/s^2"},
                                                        {body_rates, "w_x", "rad/s"},
                                                        {body_rates + 1, "w_y", "rad/s"},
                                                        {body_rates + 2, "w_z", "rad/s"}}};

  template <class Scalar>
  static constexpr detail::RigidBody<Scalar> prepare(const Airframe<Scalar>& airframe) noexcept {
    detail::RigidBody<Scalar> body{detail::wrench_map(airframe), airframe.mass_kg, {}};
    const AllocationMatrix<Scalar> mass = detail::mass_matrix(airframe);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) body.inertia_kg_m2[i][k] = mass[1 + i][1 + k];
    }
    return body;
  }
  /// Least d(sum of the commands)/d(-s_z), s^2/m, while no command of its own leaves 0 to 1: each rotor's curve is
  /// steepest at command 1. Asked by a certificate.
  template <class Scalar>
  static constexpr double least_thrust_slope(const Airframe<Scalar>& airframe) noexcept {
    const detail::RotorMap<Scalar> map = detail::wrench_map(airframe);
    double slope = 0;
    for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
      const auto share = static_cast<double>(airframe.mass_kg * map.by[rotor][0]);
      const auto curve = static_cast<double>(map.curve[rotor]);
      if (share < 0 && !(curve < 1)) return -std::numeric_limits<double>::infinity();
      slope += share / (share < 0 ? 1 - curve : 1 + curve);
    }
    return slope;
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void commands(const Scalar* x, const detail::RigidBody<Scalar>& body,
                                              Scalar* u) noexcept {
    Scalar wrench[4];
    body.wrench(x[force_z], x + body_rates, wrench);
    body.map.commands(static_cast<const Scalar*>(wrench), u);
  }
  template <int FeatureCount, class Scalar>
  static PINNQUAD_ALWAYS_INLINE void slopes(const Scalar* x, const detail::RigidBody<Scalar>& body,
                                            Scalar* by_x) noexcept {
    static_assert(FeatureCount >= body_rates + 3,
                  "pinnquad: RigidBodyBase needs specific force, angular acceleration and body rates as the first nine "
                  "features");
    const Scalar* w = x + body_rates;
    Scalar wrench[4], momentum[3], by_wrench[rotor_count * 4];
    body.wrench(x[force_z], w, wrench);
    body.times(w, momentum);
    body.map.slopes(static_cast<const Scalar*>(wrench), by_wrench, 4);
    for (int k = 0; k < 3; ++k) {
      Scalar column[3], turn[3] = {};  // d(w x J w)/dw_k = e_k x J w + w x J e_k
      for (int i = 0; i < 3; ++i) column[i] = body.inertia_kg_m2[i][k];
      const int next = (k + 1) % 3, last = (k + 2) % 3;
      turn[next] = -momentum[last];
      turn[last] = momentum[next];
      turn[0] += w[1] * column[2] - w[2] * column[1];
      turn[1] += w[2] * column[0] - w[0] * column[2];
      turn[2] += w[0] * column[1] - w[1] * column[0];
      for (int rotor = 0; rotor < rotor_count; ++rotor) {
        const Scalar* by = by_wrench + rotor * 4;
        by_x[rotor * FeatureCount + body_rates + k] = by[1] * turn[0] + by[2] * turn[1] + by[3] * turn[2];
      }
    }
    for (int rotor = 0; rotor < rotor_count; ++rotor) {
      by_x[rotor * FeatureCount + force_z] = -body.mass_kg * by_wrench[rotor * 4];
    }
  }
};

}  // namespace pinnquad
