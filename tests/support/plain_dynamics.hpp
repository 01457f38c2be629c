// SPDX-License-Identifier: MIT
// A row of the independent simulator, and formulas of air and ground a second time: plain doubles, nothing of the
// library. test_reference confirms them against the simulator.
#pragma once

#include <cmath>

namespace plain {

enum class GroundEffect { none, cheeseman_bennett, conyers };

/// One state, one set of commands. World NED, body FRD, SI.
struct Point {
  GroundEffect ground_effect;
  double pz;
  double qw, qx, qy, qz;
  double vx, vy, vz;
  double wx, wy, wz;
  double u1, u2, u3, u4;
  double wind_x, wind_y, wind_z;
};

/// Forces and torques, and the motion that follows.
struct Result {
  double rho;
  double rotor_force[3];      ///< NED, N
  double rotor_torque[3];     ///< FRD, N m
  double drag_force[3];       ///< NED, N
  double ground_force[3];     ///< NED, N
  double acceleration[3];     ///< NED, gravity included, m/s^2
  double body_derivative[3];  ///< v_dot of Eq. (1), FRD, m/s^2
  double angular[3];          ///< FRD, rad/s^2
};

inline double density(double altitude_m) {
  const double h = altitude_m / 1000.0;
  const double geopotential = 6378.137 * h / (6378.137 + h);
  const double temperature = 288.15 - 6.5 * geopotential;
  const double pressure = 101325.0 * std::pow(288.15 / temperature, -5.255877);
  return pressure / (287.053 * temperature);
}

inline double cheeseman_bennett(double x) {
  if (x <= 0.25) return 1.0;
  return 1.0 / (1.0 - std::pow(1.0 / (4.0 * x), 2.0));
}

inline double conyers(double x, double L, double R) {
  if (x < 0.25 || x > 10.0) return 1.0;
  const double L2 = L * L, R2 = R * R;
  const double p1 = -2.794e-7 * L2 + 3.761e-4 * L + 3.197e-5 * R2 - 7.5479e-3 * R + 0.3357119;
  const double p2 = 5.3178e-6 * L2 - 7.1388e-3 * L - 6.703e-4 * R2 + 0.1643906 * R - 7.0388236;
  const double p3 = -2.2529e-5 * L2 + 2.19849e-2 * L + 1.04943e-2 * R2 - 2.6402066 * R + 163.3198037;
  const double p4 = 3.2426e-5 * L2 - 2.89233e-2 * L - 1.56903e-2 * R2 + 3.9426111 * R - 248.2897537;
  const double p5 = -1.8056e-4 * L2 + 0.2518899 * L + 4.58834e-2 * R2 - 11.4527617 * R + 636.8788317;
  const double q1 = 1.0736e-5 * L2 - 2.31523e-2 * L + 5.3983e-3 * R2 - 1.3630188 * R + 96.3637597;
  const double q2 = -4.4379e-5 * L2 + 7.80762e-2 * L - 2.4483e-3 * R2 + 0.6141837 * R - 71.9829075;
  const double q3 = -1.3482e-4 * L2 + 0.1883013 * L + 3.59764e-2 * R2 - 8.9660684 * R + 500.2544495;
  return (p1 * std::pow(x, 4) + p2 * std::pow(x, 3) + p3 * x * x + p4 * x + p5) /
         (std::pow(x, 3) + q1 * x * x + q2 * x + q3);
}

}  // namespace plain
