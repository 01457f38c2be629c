// SPDX-License-Identifier: MIT
// Thrust-stand data to a rotor's curve and coefficients: least squares in closed form.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/dynamics/airframe.hpp"

namespace pinnquad {

/// One settled point of a stand: what the motor was told, and what was measured.
struct ThrustStandRow {
  double command = 0;     ///< 0..1
  double thrust_N = 0;    ///< along the axis
  double torque_N_m = 0;  ///< reaction torque, its magnitude
};

/// Thrust T(u) = T_1 ((1 - k) u + k u^2) and torque Q = q T, and how far the rows are from them.
struct ThrustStandFit {
  double max_thrust_N = 0;          ///< T_1, at command 1
  double thrust_curve = 0;          ///< k of thrust_fraction(), 0..1
  double torque_over_thrust_m = 0;  ///< q
  double thrust_error_N = 0;        ///< root of the mean square
  double torque_error_N_m = 0;
};

namespace detail {
/// The least-squares T_1 of a given curve: sum s T / sum s^2, s the thrust fraction.
inline double max_thrust_of_curve_N(const std::vector<ThrustStandRow>& rows, double curve) {
  double st = 0, ss = 0;
  for (const ThrustStandRow& row : rows) {
    const double s = thrust_fraction(curve, row.command);
    st += s * row.thrust_N;
    ss += s * s;
  }
  return st / ss;
}
inline double squared_thrust_error(const std::vector<ThrustStandRow>& rows, double curve, double max_thrust_N) {
  double sum = 0;
  for (const ThrustStandRow& row : rows) {
    const double error = row.thrust_N - max_thrust_N * thrust_fraction(curve, row.command);
    sum += error * error;
  }
  return sum;
}
}  // namespace detail

/// Fits thrust as a u + b u^2 by its normal equations, T_1 = a + b and k = b / (a + b); where k leaves 0..1, the better of the
/// two ends. Torque is proportional to thrust, through the origin. All rows should be taken at one density and voltage.
/// `not_finite`; `out_of_range` for a command out of 0..1 and a thrust or torque below 0 or above 1e9; `no_solution` for
/// rows at fewer than two commands above 0, or without thrust. `fit` is untouched unless ok.
inline Status fit_thrust_stand(const std::vector<ThrustStandRow>& rows, ThrustStandFit& fit) {
  double u2 = 0, u3 = 0, u4 = 0, ut = 0, u2t = 0, tt = 0, tq = 0;
  for (const ThrustStandRow& row : rows) {
    const double u = row.command, t = row.thrust_N, q = row.torque_N_m;
    if (!(is_finite(u) && is_finite(t) && is_finite(q))) return Status::not_finite;
    if (!(u >= 0 && u <= 1 && detail::plausible_or_zero(t) && detail::plausible_or_zero(q)))
      return Status::out_of_range;
    u2 += u * u;
    u3 += u * u * u;
    u4 += u * u * u * u;
    ut += u * t;
    u2t += u * u * t;
    tt += t * t;
    tq += t * q;
  }
  const double determinant = u2 * u4 - u3 * u3;
  constexpr double rounding = 1e-12;
  if (!(determinant > rounding * u2 * u4 && tt > 0)) return Status::no_solution;
  const double a = (u4 * ut - u3 * u2t) / determinant, b = (u2 * u2t - u3 * ut) / determinant;
  ThrustStandFit result;
  result.max_thrust_N = a + b;
  result.thrust_curve = b / (a + b);
  if (!(a + b > 0 && result.thrust_curve >= 0 && result.thrust_curve <= 1)) {
    const double straight = detail::max_thrust_of_curve_N(rows, 0), square = detail::max_thrust_of_curve_N(rows, 1);
    const bool is_straight =
        detail::squared_thrust_error(rows, 0, straight) <= detail::squared_thrust_error(rows, 1, square);
    result.thrust_curve = is_straight ? 0 : 1;
    result.max_thrust_N = is_straight ? straight : square;
  }
  result.torque_over_thrust_m = tq / tt;
  double torque_error = 0;
  for (const ThrustStandRow& row : rows) {
    const double error = row.torque_N_m - result.torque_over_thrust_m * row.thrust_N;
    torque_error += error * error;
  }
  const double count = static_cast<double>(rows.size());
  result.thrust_error_N =
      std::sqrt(detail::squared_thrust_error(rows, result.thrust_curve, result.max_thrust_N) / count);
  result.torque_error_N_m = std::sqrt(torque_error / count);
  fit = result;
  return Status::ok;
}

/// Puts a fit into an airframe: thrust and power coefficient, which with its propeller and greatest speed make T_1 and q T_1 at
/// the rated density, and the curve of all four rotors. `density_kg_m3` of the stand's air.
/// `out_of_range`, and nothing changed, for an airframe without propeller or speed, or a density that is none.
inline Status apply(const ThrustStandFit& fit, double density_kg_m3, Airframe<double>& airframe) noexcept {
  const double d = airframe.propeller_diameter_m, n = airframe.max_rotor_speed_rev_s;
  if (!(detail::plausible(d) && detail::plausible(n) && detail::plausible(density_kg_m3))) return Status::out_of_range;
  constexpr double two_pi = 6.283185307179586;
  const double unit_N = density_kg_m3 * n * n * d * d * d * d;
  airframe.thrust_coefficient = fit.max_thrust_N / unit_N;
  airframe.power_coefficient = two_pi * fit.torque_over_thrust_m * fit.max_thrust_N / (unit_N * d);
  for (RotorMount<double>& rotor : airframe.rotors) rotor.thrust_curve = fit.thrust_curve;
  return Status::ok;
}

}  // namespace pinnquad
