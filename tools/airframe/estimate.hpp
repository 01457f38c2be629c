// SPDX-License-Identifier: MIT
// An airframe from what people know of a quadrotor: all-up weight, arm, propeller, and the motors' thrust or the
// battery that turns them. What is not known is taken from like vehicles.
#pragma once

#include <cmath>
#include <string>

#include "airframe/choice.hpp"
#include "airframe/toml_writer.hpp"

namespace programs {

struct KnownOfAirframe {
  std::string name = "my_quadrotor";
  double mass_kg = 0, arm_m = 0, propeller_in = 0;
  double thrust_g = 0;       ///< of one motor at full throttle; 0: by the next two
  double kv = 0, cells = 0;  ///< rev/min per V without load; cells of lithium polymer in series
};

/// X: arms at 45 degrees; motors in PX4's order, front right and rear left counter-clockwise. No drag.
inline NamedAirframe estimated_airframe(const KnownOfAirframe& known) {
  // ratios of vehicles and propellers whose numbers were measured
  constexpr double thrust_coefficient = 0.11, power_coefficient = 0.045;  // 5 to 10 inches, standing: UIUC's data
  constexpr double gyration_over_arm = 0.42;       // about roll and pitch: .29 to .56 of five vehicles
  constexpr double yaw_over_roll_inertia = 1.8;    // 1.55 to 2.1 of these
  constexpr double loaded_over_free_speed = 0.75;  // of a motor with its propeller at full throttle
  constexpr double cell_V = 3.7, usual_rotor_time_constant_s = 0.03;
  constexpr double m_per_inch = 0.0254, kg_per_g = 1e-3;
  NamedAirframe result{known.name, {}};
  pinnquad::Airframe<double>& a = result.value;
  a.mass_kg = known.mass_kg;
  const double about_roll = a.mass_kg * std::pow(gyration_over_arm * known.arm_m, 2);
  a.inertia_kg_m2 = {about_roll, about_roll, yaw_over_roll_inertia * about_roll};
  a.thrust_coefficient = thrust_coefficient;
  a.power_coefficient = power_coefficient;
  a.propeller_diameter_m = m_per_inch * known.propeller_in;
  a.max_rotor_speed_rev_s = known.thrust_g > 0
                                ? std::sqrt(kg_per_g * known.thrust_g * pinnquad::standard_gravity_m_s2<double> /
                                            a.dimensional_thrust_coefficient())
                                : loaded_over_free_speed * known.kv * known.cells * cell_V / 60;
  a.rotor_time_constant_s = usual_rotor_time_constant_s;
  const double side_m = known.arm_m / std::sqrt(2.0);
  a.rotors = pinnquad::x_rotors(side_m, side_m);
  return result;
}

/// The file, which says what is an estimate.
inline std::string estimated_toml(const NamedAirframe& airframe, bool by_thrust) {
  return std::string("# Estimated: thrust and power coefficients") + (by_thrust ? "" : ", rotor speed") +
         " of usual propellers, inertia within a factor of two by the\n"
         "# arm and the weight, a usual lag, no drag. pinnquad identify finds them in a log.\n" +
         airframe_toml(airframe);
}

}  // namespace programs
