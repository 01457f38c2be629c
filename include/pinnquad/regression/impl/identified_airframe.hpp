// SPDX-License-Identifier: MIT
// Bodies of identified_airframe.hpp.
#pragma once

#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/regression/identified_airframe.hpp"

namespace pinnquad {

PINNQUAD_BODY std::optional<IdentifiedAirframe> identified_airframe(const Identification& found,
                                                                    const Airframe<double>& like) {
  constexpr double little_1_m = 0.05;
  const auto positive = [](const Estimate& estimate) { return detail::is_taken(estimate); };
  if (!positive(found.thrust_m_s2) || !positive(found.effectiveness_rad_s2[0]) ||
      !positive(found.effectiveness_rad_s2[1]) || found.effectiveness_rad_s2[2].high() < 0 ||
      implausible_number(found, like)) {
    return {};
  }
  IdentifiedAirframe result;
  result.assumed = {"mass_kg", "rotor.x_m", "rotor.y_m", "propeller_diameter_m", "max_rotor_speed_rev_s"};
  Airframe<double>& made = result.value;
  made = like;
  made.inertia_products_kg_m2 = {};
  made.drag_deadband_m_s = 0;
  double arm_x_m = 0, arm_y_m = 0;
  for (RotorMount<double>& rotor : made.rotors) {
    arm_x_m += std::abs(rotor.x_m) / rotor_count;
    arm_y_m += std::abs(rotor.y_m) / rotor_count;
    rotor = {rotor.x_m, rotor.y_m, rotor.spin};
  }
  const double thrust_N = found.thrust_m_s2.value * like.mass_kg;
  const double x_kg_m2 = arm_y_m * thrust_N / found.effectiveness_rad_s2[0].value;
  const double y_kg_m2 = arm_x_m * thrust_N / found.effectiveness_rad_s2[1].value;
  // both gyroscopic terms say J_z; each counts by its interval
  const Estimate by_roll = {y_kg_m2 - found.gyroscopic[0].value * x_kg_m2, found.gyroscopic[0].half_width * x_kg_m2};
  const Estimate by_pitch = {x_kg_m2 + found.gyroscopic[1].value * y_kg_m2, found.gyroscopic[1].half_width * y_kg_m2};
  const double roll_counts = 1 / (by_roll.half_width * by_roll.half_width);
  const double pitch_counts = 1 / (by_pitch.half_width * by_pitch.half_width);
  const double counts = roll_counts + pitch_counts;
  Estimate z_kg_m2;
  if (counts > 0 && std::isfinite(counts)) {
    z_kg_m2 = {(roll_counts * by_roll.value + pitch_counts * by_pitch.value) / counts, 1 / std::sqrt(counts)};
  }
  const double flattest = x_kg_m2 + y_kg_m2, flat = 0.9 * flattest;  // as quadrotors are
  if (!positive(z_kg_m2) || z_kg_m2.value > flattest) {
    z_kg_m2.value = flat;
    result.assumed.emplace_back("inertia_kg_m2[2]");
  }
  made.inertia_kg_m2 = {x_kg_m2, y_kg_m2, z_kg_m2.value};
  const double rated = rated_air_density_kg_m3<double> * std::pow(like.max_rotor_speed_rev_s, 2) *
                       std::pow(like.propeller_diameter_m, 4);
  made.thrust_coefficient = thrust_N / rated;
  if (positive(found.effectiveness_rad_s2[2])) {
    made.power_coefficient =
        2 * pi * found.effectiveness_rad_s2[2].value * z_kg_m2.value / (rated * like.propeller_diameter_m);
  } else {
    made.power_coefficient = like.power_coefficient / like.thrust_coefficient * made.thrust_coefficient;
    result.assumed.emplace_back("power_coefficient");
  }
  if (positive(found.lag_s)) {
    made.rotor_time_constant_s = found.lag_s.value;
  } else {
    result.assumed.emplace_back("rotor_time_constant_s");
  }
  const Estimate& apart = found.fall_after_rise_s;
  const bool two_lags = std::abs(apart.value) > apart.half_width && positive(found.rise_s) && positive(found.fall_s);
  const auto offset = [](const Estimate& imbalance) {
    constexpr double fine = 0.05;  // arms: an interval no wider says more than that it lies in the middle
    return imbalance.half_width <= fine ? imbalance.value : 0;
  };
  const double offset_x_m = -arm_x_m * offset(found.imbalance[1]);
  const double offset_y_m = arm_y_m * offset(found.imbalance[0]);
  for (std::size_t i = 0; i < rotor_count; ++i) {
    RotorMount<double>& rotor = made.rotors[i];
    rotor.x_m -= offset_x_m;
    rotor.y_m -= offset_y_m;
    rotor.thrust_curve = told_curve(found.thrust_curve).value_or(like.rotors[i].thrust_curve);
    if (!two_lags) continue;
    rotor.rise_time_constant_s = found.rise_s.value;
    rotor.fall_time_constant_s = found.fall_s.value;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Estimate& drag = found.drag_1_m[axis];
    if (drag.half_width <= std::max(std::abs(drag.value), little_1_m)) {
      made.drag_area_m2[axis] = std::max(drag.value, 0.0) * like.mass_kg / rated_air_density_kg_m3<double>;
    } else {
      result.assumed.push_back("drag_area_m2[" + std::to_string(axis) + "]");
    }
  }
  if (check_airframe(made) != Status::ok || Rotors<double>(made).status() != Status::ok) return {};
  return result;
}

}  // namespace pinnquad
