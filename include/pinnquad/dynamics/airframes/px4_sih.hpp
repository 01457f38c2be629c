// SPDX-License-Identifier: MIT
// The quadrotor of PX4's simulation in hardware (SIH, airframe 10040) with its default parameters. Its drag is the
// effect LinearDamping (aero/drag.hpp): Quadrotor<double, LinearDamping>::of<Px4Sih>().
// Source: [P] PX4 v1.16.0, parameters SIH_* as a flight's log has them; thrust is linear in the command.
#pragma once

#include "pinnquad/dynamics/airframe_value.hpp"

namespace pinnquad {

/// PX4's simulated vehicle; values and their sources at each line.
struct Px4Sih {
  static constexpr const char* name = "px4_sih";

  template <class Scalar>
  static constexpr Airframe<Scalar> value() {
    constexpr double thrust_N = 5.0;    // [P] SIH_T_MAX
    constexpr double torque_N_m = 0.1;  // [P] SIH_Q_MAX
    constexpr double arm_m = 0.2;       // [P] SIH_L_ROLL, SIH_L_PITCH
    // SIH has no propellers: any diameter and speed do that make this thrust and torque
    constexpr double d = 0.25, n = 100.0, rho = 1.225;
    Airframe<Scalar> a{};
    a.mass_kg = Scalar(1.0);                                          // [P] SIH_MASS
    a.inertia_kg_m2 = {Scalar(0.025), Scalar(0.025), Scalar(0.030)};  // [P] SIH_IXX, SIH_IYY, SIH_IZZ
    a.rotors = x_rotors(Scalar(arm_m), Scalar(arm_m));
    a.thrust_coefficient = Scalar(thrust_N / (rho * n * n * d * d * d * d));
    a.power_coefficient = Scalar(2 * pi * torque_N_m / (rho * n * n * d * d * d * d * d));
    a.propeller_diameter_m = Scalar(d);
    a.max_rotor_speed_rev_s = Scalar(n);
    a.rotor_time_constant_s = Scalar(0.05);  // [P] SIH_T_TAU
    a.drag_area_m2 = {Scalar(0), Scalar(0), Scalar(0)};
    a.drag_deadband_m_s = Scalar(0);
    return a;
  }
};

}  // namespace pinnquad
