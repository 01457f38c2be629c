// SPDX-License-Identifier: MIT
// An effect and an airframe of a user's own.
#pragma once

#include <pinnquad/aero/effect.hpp>
#include <pinnquad/dynamics/airframe.hpp>

namespace own {

/// Rotor drag, linear in the air-relative velocity and in thrust: F = -k T (v_x, v_y, 0).
struct RotorDrag {
  double coefficient_s_m = 0.02;

  template <class Scalar>
  pinnquad::Wrench<Scalar> wrench(const pinnquad::RotorCondition<Scalar>& condition,
                                  const pinnquad::Airframe<Scalar>&) const noexcept {
    const Scalar thrust_N = -condition.rotors.force_N[2];
    pinnquad::Wrench<Scalar> result;
    for (int i = 0; i < 2; ++i) {
      result.force_N[i] = -Scalar(coefficient_s_m) * thrust_N * condition.air_relative_velocity_m_s[i];
    }
    return result;
  }
};

/// A light racer whose motors are wired in another order than the paper's: 1 rear right, 2 front right, 3 rear left,
/// 4 front left; 1 and 4 turn clockwise.
struct Racer {
  static constexpr const char* name = "racer";

  template <class Scalar>
  static constexpr pinnquad::Airframe<Scalar> value() {
    pinnquad::Airframe<Scalar> a{};
    a.mass_kg = Scalar(0.6);
    a.inertia_kg_m2 = {Scalar(1.1e-3), Scalar(1.3e-3), Scalar(2.2e-3)};
    constexpr Scalar x = Scalar(0.07), y = Scalar(0.09);
    a.rotors[0] = {-x, y, pinnquad::Spin::clockwise};
    a.rotors[1] = {x, y, pinnquad::Spin::counter_clockwise};
    a.rotors[2] = {-x, -y, pinnquad::Spin::counter_clockwise};
    a.rotors[3] = {x, -y, pinnquad::Spin::clockwise};
    a.thrust_coefficient = Scalar(0.12);
    a.power_coefficient = Scalar(0.05);
    a.propeller_diameter_m = Scalar(0.127);
    a.max_rotor_speed_rev_s = Scalar(400);
    a.rotor_time_constant_s = Scalar(0.02);
    a.drag_area_m2 = {Scalar(2e-3), Scalar(2e-3), Scalar(1e-2)};
    a.drag_deadband_m_s = Scalar(0);
    return a;
  }
};

}  // namespace own
