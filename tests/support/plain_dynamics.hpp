// SPDX-License-Identifier: MIT
// The dynamics a second time, written straight from the paper's Eqs. (1) and (2) and the simulator's constants:
// rotation matrices, plain doubles, nothing of the library. test_reference confirms it against the independent
// simulator.
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

/// The simulator's constants at 1.5 kg.
struct Constants {
  double mass = 1.5;
  double jx = 0.0146915832, jy = 0.0168569168, jz = 0.0309321666;
  double arm = 0.24395184;
  double c_t = 0.109918997, c_p = 0.0401640013;
  double diameter = 0.228599995;
  double n_max = 106.611117;
  double kx = 0.00538309224, ky = 0.00583809226, kz = 0.10993009;
  double slowest_drag = 0.1;
  double gravity = 9.80665;
  double home_altitude = 122.0;
  double ground_z = 0.877;
  double ground_radius = 0.228599995 / 2.0;  ///< R of Z/R
};

inline double clip(double u) { return u < 0.0 ? 0.0 : (u > 1.0 ? 1.0 : u); }

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

inline double drag(double k, double rho, double v, double slowest) {
  return std::fabs(v) > slowest ? -k * rho * std::fabs(v) * v : 0.0;
}

inline Result evaluate(const Point& s, const Constants& c = {}) {
  Result out{};

  // rotation matrix, body to world
  const double w = s.qw, x = s.qx, y = s.qy, z = s.qz;
  const double R[3][3] = {{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
                          {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
                          {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};

  // air
  out.rho = density(c.home_altitude - s.pz);
  const double rho_0 = 101325.0 / (287.053 * 288.15);
  const double thinning = out.rho / rho_0;

  // Eq. (2): thrust of each rotor, then the wrench
  const double pi = 3.14159265358979323846;
  const double t_max = c.c_t * 1.225 * c.n_max * c.n_max * std::pow(c.diameter, 4);
  const double q_max = c.c_p * 1.225 * c.n_max * c.n_max * std::pow(c.diameter, 5) / (2 * pi);
  const double t1 = clip(s.u1) * t_max * thinning, t2 = clip(s.u2) * t_max * thinning;
  const double t3 = clip(s.u3) * t_max * thinning, t4 = clip(s.u4) * t_max * thinning;
  const double thrust = t1 + t2 + t3 + t4;
  const double tau_x = c.arm * (-t1 + t2 + t3 - t4);
  const double tau_y = c.arm * (t1 - t2 + t3 - t4);
  const double tau_z = (t1 + t2 - t3 - t4) * q_max / t_max;
  for (int i = 0; i < 3; ++i) out.rotor_force[i] = -R[i][2] * thrust;
  out.rotor_torque[0] = tau_x;
  out.rotor_torque[1] = tau_y;
  out.rotor_torque[2] = tau_z;

  // drag per body axis
  const double air[3] = {s.vx - s.wind_x, s.vy - s.wind_y, s.vz - s.wind_z};
  double drag_body[3];
  const double k[3] = {c.kx, c.ky, c.kz};
  for (int i = 0; i < 3; ++i) {
    const double v = R[0][i] * air[0] + R[1][i] * air[1] + R[2][i] * air[2];
    drag_body[i] = drag(k[i], out.rho, v, c.slowest_drag);
  }
  for (int i = 0; i < 3; ++i) {
    out.drag_force[i] = R[i][0] * drag_body[0] + R[i][1] * drag_body[1] + R[i][2] * drag_body[2];
  }

  // ground effect along body -z
  const double radius = c.ground_radius;
  const double height = c.ground_z - s.pz;
  double ratio = 1.0;
  if (s.ground_effect == GroundEffect::cheeseman_bennett) ratio = cheeseman_bennett(height / radius);
  if (s.ground_effect == GroundEffect::conyers) {
    ratio = conyers(height / radius, 1000.0 * 2.0 * std::sqrt(2.0) * c.arm, 1000.0 * radius);
  }
  const double extra = (ratio - 1.0) * std::fabs(out.rotor_force[2] + out.drag_force[2]);
  for (int i = 0; i < 3; ++i) out.ground_force[i] = -R[i][2] * extra;

  // Eq. (1), linear: world first, then the derivative of the body-frame velocity
  for (int i = 0; i < 3; ++i) {
    out.acceleration[i] = (out.rotor_force[i] + out.drag_force[i] + out.ground_force[i]) / c.mass;
  }
  out.acceleration[2] += c.gravity;
  const double vb[3] = {R[0][0] * s.vx + R[1][0] * s.vy + R[2][0] * s.vz,
                        R[0][1] * s.vx + R[1][1] * s.vy + R[2][1] * s.vz,
                        R[0][2] * s.vx + R[1][2] * s.vy + R[2][2] * s.vz};
  const double transport[3] = {s.wy * vb[2] - s.wz * vb[1], s.wz * vb[0] - s.wx * vb[2], s.wx * vb[1] - s.wy * vb[0]};
  for (int i = 0; i < 3; ++i) {
    out.body_derivative[i] =
        R[0][i] * out.acceleration[0] + R[1][i] * out.acceleration[1] + R[2][i] * out.acceleration[2] - transport[i];
  }

  // Eq. (1), angular: Euler's equations component by component
  out.angular[0] = (tau_x + (c.jy - c.jz) * s.wy * s.wz) / c.jx;
  out.angular[1] = (tau_y + (c.jz - c.jx) * s.wz * s.wx) / c.jy;
  out.angular[2] = (tau_z + (c.jx - c.jy) * s.wx * s.wy) / c.jz;
  return out;
}

}  // namespace plain
