// SPDX-License-Identifier: MIT
// Outputs that are added to what another inverse says: the network learns what that one leaves.
// Contract of a Base, static and noexcept, Scalar deduced: `prepare(airframe)`, constexpr; commands(x, prepared, u) of features
// in physical units; `slopes<FeatureCount>(x, prepared, by_x)` = du/dx, rotor_count x FeatureCount, row-major, into zeros.
#pragma once

#include "pinnquad/dynamics/linearized.hpp"
#include "pinnquad/inference/features.hpp"
#include "pinnquad/inference/output_schema.hpp"

namespace pinnquad {

/// Eq. (3) inverted ("Model 1" of Table 2), of PaperFeatures and what begins as they do, in air of the rated density: thrust
/// from v_dot_z, torques from omega_dot, nothing else.
struct LinearizedInverse {
  static constexpr const char* description = "pinnquad::LinearizedInverse";

  template <class Scalar>
  struct Body {
    Rotors<Scalar> rotors;
    Airframe<Scalar> airframe;
  };
  template <class Scalar>
  static constexpr Body<Scalar> prepare(const Airframe<Scalar>& airframe) noexcept {
    return {Rotors<Scalar>(airframe), airframe};
  }
  template <class Scalar>
  static void commands(const Scalar* x, const Body<Scalar>& body, Scalar* u) noexcept {
    const Accelerations<Scalar> motion{{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
    const Commands<Scalar> made =
        linearized_commands(body.airframe, body.rotors, motion, standard_gravity_m_s2<Scalar>, Scalar(1));
    for (std::size_t i = 0; i < rotor_count; ++i) u[i] = made[i];
  }
  template <int FeatureCount, class Scalar>
  static void slopes(const Scalar* x, const Body<Scalar>& body, Scalar* by_x) noexcept {
    static_assert(FeatureCount >= 6, "pinnquad: LinearizedInverse needs the accelerations as the first six features");
    const Accelerations<Scalar> motion{{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
    const AllocationMatrix<Scalar> by_wrench = body.rotors.command_slopes(
        linearized_commands(body.airframe, body.rotors, motion, standard_gravity_m_s2<Scalar>, Scalar(1)), Scalar(1));
    for (int k = 2; k < 6; ++k) {
      Accelerations<Scalar> unit{};
      if (k == 2) {
        unit.linear_m_s2[2] = Scalar(1);
      } else {
        unit.angular_rad_s2[k - 3] = Scalar(1);
      }
      const Wrench<Scalar> column = linearized_wrench(body.airframe, unit, Scalar(0));  // it is linear without gravity
      for (std::size_t i = 0; i < rotor_count; ++i) {
        by_x[static_cast<int>(i) * FeatureCount + k] =
            -by_wrench[i][0] * column.force_N[2] + by_wrench[i][1] * column.torque_N_m[0] +
            by_wrench[i][2] * column.torque_N_m[1] + by_wrench[i][3] * column.torque_N_m[2];
      }
    }
  }
};

/// commands = base(x) + outputs.
template <class BaseInverse>
struct ResidualOutputs {
  using Base = BaseInverse;  ///< what the outputs add to; a header and a block name it by its description
  static constexpr int size = rotor_count;
  static constexpr std::array<const char*, size> names = {"du1", "du2", "du3", "du4"};
  static constexpr std::array<const char*, size> units = {"1", "1", "1", "1"};
  static constexpr bool linear = true;

  template <class Scalar>
  static constexpr auto prepare(const Airframe<Scalar>& airframe) noexcept {
    return Base::prepare(airframe);
  }
  template <class Scalar, class Setting>
  static void commands(const Scalar* x, const Scalar* y, const Setting& setting, Scalar* u) noexcept {
    Base::commands(x, setting, u);
    for (int i = 0; i < size; ++i) u[i] += y[i];
  }
  template <class Scalar, class Setting>
  static void from_commands(const Scalar* x, const Scalar* u, const Setting& setting, Scalar* y) noexcept {
    Scalar base[rotor_count];
    Base::commands(x, setting, static_cast<Scalar*>(base));
    for (int i = 0; i < size; ++i) y[i] = u[i] - base[i];
  }
  template <int FeatureCount, class Scalar, class Setting>
  static void feature_slopes(const Scalar* x, const Scalar*, const Setting& setting, Scalar* by_x) noexcept {
    Base::template slopes<FeatureCount>(x, setting, by_x);
  }
};

}  // namespace pinnquad
