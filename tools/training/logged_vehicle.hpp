// SPDX-License-Identifier: MIT
// A vehicle that turns and climbs by its commands as the flights of a log do: what a model of these logs can be flown
// on. Its mass is 1 kg and its arms are as they are given, for the logs say nothing of them: thrust and drag per mass,
// torque per inertia are theirs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <vector>

#include "logs/specific_force.hpp"
#include "pinnquad/aero/effect.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/dynamics/rotor.hpp"
#include "pinnquad/regression/ridge.hpp"

namespace programs {

/// The effect of all four commands together, and of the air, by least squares.
struct LoggedEffects {
  double thrust_m_s2 = 0;              ///< specific force along -z per sum of the commands
  std::array<double, 3> drag_per_m{};  ///< specific force along x, y, z per -|v_i| v_i; 0 where that is no drag
  /// Angular acceleration about x, y, z: per signed command sum; per -w_i, 0 where that is no damping; without either.
  std::array<double, 3> turn_rad_s2{}, damping_1_s{}, trim_rad_s2{};
};

/// The trim of a crooked vehicle and the damping of its turns, as an effect.
struct LoggedTorque {
  static constexpr pinnquad::VariesWith varies_with = pinnquad::VariesWith::motion;
  std::array<double, 3> damping_1_s{}, trim_rad_s2{};

  template <class Scalar>
  pinnquad::Wrench<Scalar> wrench(const pinnquad::AeroCondition<Scalar>& condition,
                                  const pinnquad::Airframe<Scalar>& airframe) const noexcept {
    pinnquad::Wrench<Scalar> result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Scalar rate = condition.body_rates_rad_s[static_cast<int>(axis)];
      result.torque_N_m[static_cast<int>(axis)] =
          airframe.inertia_kg_m2[axis] * (Scalar(trim_rad_s2[axis]) - Scalar(damping_1_s[axis]) * rate);
    }
    return result;
  }
};

namespace detail {

/// angular acceleration = trim + turn S - damping w about an axis; without the rate where that would be no damping.
inline void fit_turn(const pinnquad::RowSet& rows, const std::array<double, pinnquad::rotor_count>& signs,
                     std::size_t axis, LoggedEffects& effects) {
  const auto i = static_cast<int>(axis);
  pinnquad::RegressionSums sums(2, 1);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const pinnquad::Sample& sample = rows[row];
    const std::array<double, 2> x = {pinnquad::signed_sum(signs, sample.commands), sample.body_rates_rad_s[i]};
    sums.add(x.data(), &sample.angular_acceleration_rad_s2[i]);
  }
  pinnquad::AffineMap map = pinnquad::fit_ridge(sums, 0);
  if (map.weights[1] > 0) map = pinnquad::fit_ridge(sums, 0, {true, false});
  effects.turn_rad_s2[axis] = map.weights[0];
  effects.damping_1_s[axis] = -map.weights[1];
  effects.trim_rad_s2[axis] = map.intercept[0];
}

}  // namespace detail

/// Thrust and drag through the origin, so that the hover is right; the turns with a trim.
inline LoggedEffects logged_effects(const pinnquad::RowSet& rows,
                                    const std::array<std::array<double, pinnquad::rotor_count>, 3>& signs) {
  LoggedEffects effects;
  std::array<std::vector<double>, 3> pushes, forces;
  std::vector<double> thrusts;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const pinnquad::Sample& sample = rows[row];
    const pinnquad::Vector3<double> force = pinnquad::logs::specific_force_m_s2(sample);
    double all = 0;
    for (const double u : sample.commands) all += u;
    thrusts.push_back(-all);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double v = sample.velocity_m_s[static_cast<int>(axis)];
      pushes[axis].push_back(-std::abs(v) * v);
      forces[axis].push_back(force[static_cast<int>(axis)]);
    }
  }
  const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
  };
  const auto share = [](double of, double in) { return in > 0 ? of / in : 0.0; };
  for (std::size_t axis = 0; axis < 3; ++axis) detail::fit_turn(rows, signs[axis], axis, effects);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    effects.drag_per_m[axis] = share(product(pushes[axis], forces[axis]), product(pushes[axis], pushes[axis]));
  }
  // along z both: the normal equations of two unknowns
  const double thrust = product(thrusts, thrusts), drag = product(pushes[2], pushes[2]);
  const double between = product(thrusts, pushes[2]), determinant = thrust * drag - between * between;
  const double by_thrust = product(thrusts, forces[2]), by_drag = product(pushes[2], forces[2]);
  effects.drag_per_m[2] = share(thrust * by_drag - between * by_thrust, determinant);
  for (double& found : effects.drag_per_m) found = std::max(found, 0.0);
  effects.thrust_m_s2 = share(by_thrust - effects.drag_per_m[2] * between, thrust);
  return effects;
}

/// The arms and the motor order of `like`, the effects of the rows. None where the rows show no vehicle: a command that
/// does not lift or turns the wrong way, or one that can't hover.
inline std::optional<pinnquad::Airframe<double>> logged_vehicle(const pinnquad::Airframe<double>& like,
                                                                const LoggedEffects& effects) {
  constexpr double propeller_m = 0.2, rev_s = 100, pi = 3.141592653589793;
  const double thrust_N = effects.thrust_m_s2;  // of one rotor of a vehicle of 1 kg
  if (!(thrust_N > 0)) return {};
  for (const double turn : effects.turn_rad_s2) {
    if (!(turn > 0)) return {};
  }
  pinnquad::Airframe<double> made{};
  made.mass_kg = 1;
  double arm_x_m = 0, arm_y_m = 0;
  for (std::size_t i = 0; i < pinnquad::rotor_count; ++i) {
    made.rotors[i].x_m = like.rotors[i].x_m;
    made.rotors[i].y_m = like.rotors[i].y_m;
    made.rotors[i].spin = like.rotors[i].spin;
    arm_x_m += std::abs(like.rotors[i].x_m) / pinnquad::rotor_count;
    arm_y_m += std::abs(like.rotors[i].y_m) / pinnquad::rotor_count;
  }
  const double rated = pinnquad::rated_air_density_kg_m3<double> * rev_s * rev_s * std::pow(propeller_m, 4);
  made.inertia_kg_m2 = {arm_y_m * thrust_N / effects.turn_rad_s2[0], arm_x_m * thrust_N / effects.turn_rad_s2[1], 0};
  made.inertia_kg_m2[2] = 0.9 * (made.inertia_kg_m2[0] + made.inertia_kg_m2[1]);  // flat, as quadrotors are
  made.propeller_diameter_m = propeller_m;
  made.max_rotor_speed_rev_s = rev_s;
  made.thrust_coefficient = thrust_N / rated;
  made.power_coefficient = 2 * pi * effects.turn_rad_s2[2] * made.inertia_kg_m2[2] / (rated * propeller_m);
  made.rotor_time_constant_s = like.rotor_time_constant_s;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    made.drag_area_m2[axis] = effects.drag_per_m[axis] / pinnquad::rated_air_density_kg_m3<double>;
  }
  if (pinnquad::check_airframe(made) != pinnquad::Status::ok) return {};
  if (pinnquad::Rotors<double>(made).status() != pinnquad::Status::ok) return {};
  return made;
}

}  // namespace programs
