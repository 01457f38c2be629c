// SPDX-License-Identifier: MIT
// A racing quadrotor on 5-inch propellers, thrust-to-weight 4.6.
// Source: [A] the 0.752 kg vehicle of the Robotics and Perception Group, University of Zurich, as published with their
// Flightmare simulator (Song et al., 2020; the Agilicious platform, Foehn et al., 2022).
#pragma once

#include "pinnquad/dynamics/airframe_value.hpp"

namespace pinnquad {

/// 0.752 kg; values and their sources at each line.
struct Racer5Inch {
  static constexpr const char* name = "racer_5_inch";

  template <class Scalar>
  static constexpr Airframe<Scalar> value() {
    constexpr double thrust_per_rev_s_squared = 1.562522e-6 * 4 * pi * pi;  // [A] 1.562522e-6 N s^2 / rad^2
    constexpr double torque_over_thrust_m = 0.022;                          // [A]
    constexpr double d = 0.127;                                             // 5 inches
    constexpr double rho = 1.225;
    Airframe<Scalar> a{};
    a.mass_kg = Scalar(0.752);                                           // [A]
    a.inertia_kg_m2 = {Scalar(2.5e-3), Scalar(2.1e-3), Scalar(4.3e-3)};  // [A]
    constexpr Scalar forward = Scalar(0.075), right = Scalar(0.10);      // [A]
    a.rotors = x_rotors(forward, right);
    a.thrust_coefficient = Scalar(thrust_per_rev_s_squared / (rho * d * d * d * d));
    a.power_coefficient = Scalar(2 * pi * torque_over_thrust_m * thrust_per_rev_s_squared / (rho * d * d * d * d * d));
    a.propeller_diameter_m = Scalar(d);
    a.max_rotor_speed_rev_s = Scalar(2333.0 / (2 * pi));  // [A] 2333 rad/s
    a.rotor_time_constant_s = Scalar(0.033);              // [A]
    // [A] linear drag 0.26, 0.28, 0.42 N s/m: the same force at 8 m/s
    a.drag_area_m2 = {Scalar(0.0265), Scalar(0.0286), Scalar(0.0429)};
    a.drag_deadband_m_s = Scalar(0);
    return a;
  }
};

}  // namespace pinnquad
