// SPDX-License-Identifier: MIT
// Crazyflie 2.1, the 27 g nano quadrotor, bare.
// Sources: [B] Bitcraze, Crazyflie 2.1 data sheet; [P] Bitcraze blog, Measuring propeller RPM part 3 (2015); [L]
// Landry, Planning and control for quadrotor flight through cluttered environments (MIT, 2015); [U] Luis and Le Ny,
// Design of a trajectory tracking controller for a nanoquadcopter (2016); [F] Foerster, System identification of the
// Crazyflie 2.0 nano quadrocopter (ETH Zurich, 2015), drag as used by Panerati et al., Learning to fly (2021), with its
// thrust-to-weight ratio.
#pragma once

#include "pinnquad/dynamics/airframe_value.hpp"

namespace pinnquad {

/// 27 g, X frame; values and their sources at each line.
struct Crazyflie {
  static constexpr const char* name = "crazyflie_2_1";

  template <class Scalar>
  static constexpr Airframe<Scalar> value() {
    constexpr double thrust_per_rev_s_squared = 3.16e-10 * 3600;  // [U] 3.16e-10 N / rpm^2
    constexpr double torque_per_rev_s_squared = 7.94e-12 * 3600;  // [U] 7.94e-12 N m / rpm^2
    constexpr double d = 0.0462696;                               // propeller radius 23.1348 mm, Panerati
    constexpr double rho = 1.225;
    Airframe<Scalar> a{};
    a.mass_kg = Scalar(0.027);                                            // [B]
    a.inertia_kg_m2 = {Scalar(1.4e-5), Scalar(1.4e-5), Scalar(2.17e-5)};  // [L]
    constexpr Scalar arm = Scalar(0.046 / 1.4142135623730951);            // [B] 92 mm from motor to motor, diagonal
    a.rotors = x_rotors(arm, arm);
    a.thrust_coefficient = Scalar(thrust_per_rev_s_squared / (rho * d * d * d * d));
    a.power_coefficient = Scalar(2 * pi * torque_per_rev_s_squared / (rho * d * d * d * d * d));
    a.propeller_diameter_m = Scalar(d);
    a.max_rotor_speed_rev_s = Scalar(21709.0 / 60.0);  // thrust-to-weight 2.25 (Panerati)
    a.rotor_time_constant_s = Scalar(0.06);            // [P] 0 to 25,000 rpm in about 180 ms: three time constants
    // [F] 9.1785e-7 and 10.311e-7 N per (m/s)(rad/s) and rotor: at hover speed the same force at 3 m/s
    a.drag_area_m2 = {Scalar(1.51e-3), Scalar(1.51e-3), Scalar(1.70e-3)};
    a.drag_deadband_m_s = Scalar(0);
    return a;
  }
};

}  // namespace pinnquad
