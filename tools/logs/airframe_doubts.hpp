// SPDX-License-Identifier: MIT
// Numbers of an airframe that no quadrotor has, or hardly one: a unit mistaken, most often.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/dynamics/actuator.hpp"
#include "pinnquad/dynamics/allocation.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/regression/plausible_vehicle.hpp"

namespace pinnquad::logs {

constexpr double speed_of_sound_m_s = 340.3;  ///< standard atmosphere, sea level

/// Of the blades' tips at command 1.
inline double tip_speed_m_s(const Airframe<double>& airframe) {
  return pi * airframe.propeller_diameter_m * airframe.max_rotor_speed_rev_s;
}

/// Between the two rotors that are nearest, m.
inline double rotor_distance_m(const Airframe<double>& airframe) {
  double least =
      std::hypot(airframe.rotors[0].x_m - airframe.rotors[1].x_m, airframe.rotors[0].y_m - airframe.rotors[1].y_m,
                 airframe.rotors[0].z_m - airframe.rotors[1].z_m);
  for (std::size_t i = 0; i < rotor_count; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const RotorMount<double>&a = airframe.rotors[i], &b = airframe.rotors[j];
      least = std::min(least, std::hypot(a.x_m - b.x_m, a.y_m - b.y_m, a.z_m - b.z_m));
    }
  }
  return least;
}

/// Greatest angular acceleration about each axis from rest, one way: the rotors that turn it that way at command 1, the
/// others at 0.
inline std::array<double, 3> greatest_turn_rad_s2(const Airframe<double>& airframe) {
  const AllocationMatrix<double> matrix = allocation(airframe);
  std::array<double, 3> greatest{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double one_way = 0, other_way = 0;
    for (std::size_t i = 0; i < rotor_count; ++i) {
      (matrix[axis + 1][i] > 0 ? one_way : other_way) += std::abs(matrix[axis + 1][i]);
    }
    greatest[axis] = std::min(one_way, other_way) / airframe.inertia_kg_m2[axis];
  }
  return greatest;
}

/// Of one rotor at command 1, mean over the rotors: specific force, m/s^2; angular acceleration about x, y, z, rad/s^2.
inline std::array<double, 4> rotor_effects(const Airframe<double>& airframe) {
  const AllocationMatrix<double> matrix = allocation(airframe);
  std::array<double, 4> effects{};
  for (std::size_t row = 0; row < 4; ++row) {
    const double of = row == 0 ? airframe.mass_kg : airframe.inertia_kg_m2[row - 1];
    for (const double entry : matrix[row]) effects[row] += std::abs(entry) / (rotor_count * of);
  }
  return effects;
}

/// The command of all rotors in hover at the rated density.
inline double hover_command(const Airframe<double>& airframe) {
  return command_of_fraction(airframe.rotors[0].thrust_curve, 1 / airframe.thrust_to_weight());
}

/// A line for each number that hardly a quadrotor has.
inline std::vector<std::string> airframe_doubts(const Airframe<double>& a) {
  std::vector<std::string> doubts;
  const auto outside = [&](const std::string& what, double value, double least, double most, const char* unit,
                           const char* look_at) {
    if (value >= least && value <= most) return;
    doubts.push_back(what + " " + number_text(std::round(value * 1e3) / 1e3) + unit + ", where quadrotors have " +
                     number_text(least) + " to " + number_text(most) + ": " + look_at);
  };
  outside("thrust-to-weight", a.thrust_to_weight(), 1.1, 16, "",
          "look at mass_kg, max_rotor_speed_rev_s (rev/s, not rev/min), thrust_coefficient");
  outside("propeller over the distance of the nearest rotors", a.propeller_diameter_m / rotor_distance_m(a), 0.1, 1, "",
          "look at propeller_diameter_m and the rotors' places, in m");
  const std::array<double, 3> turn = greatest_turn_rad_s2(a);
  const std::array<const char*, 3> names = {"roll", "pitch", "yaw"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto range = plausible::turn_rad_s2[axis];
    outside(std::string("greatest ") + names[axis] + " acceleration", turn[axis], range.least, range.most, " rad/s^2",
            "look at inertia_kg_m2, in kg m^2, and the rotors' places");
  }
  outside("thrust coefficient", a.thrust_coefficient, 0.03, 0.3, "",
          "C_T = thrust / (rho n^2 D^4) with n in rev/s and rho in kg/m^3");
  outside("rotor time constant", a.rotor_time_constant_s, plausible::rotor_lag_s.least, plausible::rotor_lag_s.most,
          " s", "look at rotor_time_constant_s, in s");
  return doubts;
}

}  // namespace pinnquad::logs
