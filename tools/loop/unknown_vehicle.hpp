// SPDX-License-Identifier: MIT
// Vehicles that nobody knows: drawn around archetypes of 30 g to 5 kg, with what a controller is told of them at the
// start. The same seed draws the same vehicles with every compiler.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include "airframe/estimate.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/simulation/switched_quadrotor.hpp"

namespace programs {

/// The numbers around which a vehicle is drawn, SI units.
struct Archetype {
  const char* name;
  double mass_kg, forward_m, right_m;  ///< arms: of a rotor's place
  std::array<double, 3> inertia_kg_m2;
  double thrust_to_weight, torque_over_thrust_m, lag_s, propeller_m;
  double thrust_curve;  ///< k of thrust_fraction()
  double drag_area_m2;  ///< along x and y; half as much again along z
};

inline constexpr std::array<Archetype, 4> archetypes = {{
    {"crazyflie", 0.030, 0.0325, 0.0325, {1.4e-5, 1.4e-5, 2.17e-5}, 2.1, 0.008, 0.050, 0.0463, 0.3, 1.5e-3},
    {"racer", 0.250, 0.050, 0.055, {2.2e-4, 1.9e-4, 3.6e-4}, 6.0, 0.012, 0.025, 0.0762, 0.6, 5e-3},
    {"paper", 1.5, 0.244, 0.244, {1.469e-2, 1.686e-2, 3.093e-2}, 2.3, 0.0133, 0.020, 0.2286, 0.0, 1.5e-2},
    {"slow", 5.0, 0.30, 0.30, {0.20, 0.22, 0.38}, 2.0, 0.018, 0.060, 0.40, 0.5, 6e-2},
}};

/// An X of the archetype's numbers.
inline pinnquad::Airframe<double> airframe_of(const Archetype& type) {
  constexpr double two_pi = 6.283185307179586;
  pinnquad::Airframe<double> a{};
  a.mass_kg = type.mass_kg;
  a.inertia_kg_m2 = type.inertia_kg_m2;
  a.rotors = pinnquad::x_rotors(type.forward_m, type.right_m);
  for (auto& rotor : a.rotors) rotor.thrust_curve = type.thrust_curve;
  a.propeller_diameter_m = type.propeller_m;
  a.max_rotor_speed_rev_s = 200;  // only its products with the coefficients count
  a.thrust_coefficient = 1;
  const double each_N = type.thrust_to_weight * type.mass_kg * pinnquad::standard_gravity_m_s2<double> / 4;
  a.thrust_coefficient = each_N / a.max_rotor_thrust_N();
  a.power_coefficient = type.torque_over_thrust_m * a.thrust_coefficient * two_pi / a.propeller_diameter_m;
  a.rotor_time_constant_s = type.lag_s;
  a.drag_area_m2 = {type.drag_area_m2, type.drag_area_m2, 1.5 * type.drag_area_m2};
  return a;
}

/// A vehicle, its effects, and what controllers are told of neither.
struct UnknownVehicle {
  const char* archetype = "";
  pinnquad::Airframe<double> airframe{};
  pinnquad::SwitchedEffects effects =
      pinnquad::switched_effects<pinnquad::Quadrotor<double, pinnquad::StandardAtmosphere, pinnquad::QuadraticDrag>>();
  double delay_s = 0;  ///< by which its states come late
};

/// Number `number` of a seed, around archetype number % 4: each number of it 40 % either way, the centre of gravity off
/// by 15 % of the arms, rotors by 5 % of their thrust; linear drag of 0.05 to 0.35 / s, damping of body rates, a
/// pitching moment in flight; states that come 2 to 8 ms late. Its thrust is 1.6 of its weight at least.
inline UnknownVehicle drawn_vehicle(std::uint64_t seed, std::size_t number) {
  using pinnquad::uniform;
  std::mt19937_64 engine(0x766568696373u + 1'000'003 * seed + number);
  const Archetype& around = archetypes[number % archetypes.size()];
  for (;;) {
    Archetype type = around;
    const auto spread = [&engine](double& value) { value *= uniform(engine, 0.6, 1.4); };
    for (double* value : {&type.mass_kg, &type.forward_m, &type.right_m, type.inertia_kg_m2.data(),
                          type.inertia_kg_m2.data() + 1, &type.torque_over_thrust_m, &type.lag_s, &type.drag_area_m2}) {
      spread(*value);
    }
    double thrust = around.thrust_to_weight * around.mass_kg;
    spread(thrust);
    type.thrust_to_weight = thrust / type.mass_kg;
    auto& inertia = type.inertia_kg_m2;
    inertia[2] = (inertia[0] + inertia[1]) * uniform(engine, 0.75, 0.99);
    type.thrust_curve = std::clamp(around.thrust_curve + uniform(engine, -0.25, 0.25), 0.0, 0.95);
    UnknownVehicle vehicle;
    vehicle.archetype = around.name;
    vehicle.airframe = airframe_of(type);
    const double off_x_m = type.forward_m * uniform(engine, -0.15, 0.15);
    const double off_y_m = type.right_m * uniform(engine, -0.15, 0.15);
    for (auto& rotor : vehicle.airframe.rotors) {
      rotor.x_m += off_x_m;
      rotor.y_m += off_y_m;
      rotor.thrust_scale = uniform(engine, 0.95, 1.05);
    }
    const double tilting = (inertia[0] + inertia[1]) / 2;
    const double drag_1_s = uniform(engine, 0.05, 0.35), damping_1_s = uniform(engine, 0.0, 1.2);
    const double pitching_1_m_s = uniform(engine, 0.0, 1.0);
    switch_effect(vehicle.effects, pinnquad::LinearDamping{drag_1_s * type.mass_kg, damping_1_s * tilting});
    switch_effect(vehicle.effects, pinnquad::BladeFlapping{pitching_1_m_s * tilting / type.mass_kg /
                                                           pinnquad::standard_gravity_m_s2<double>});
    vehicle.delay_s = 0.002 * static_cast<double>(1 + pinnquad::uniform_index(engine, 4));
    if (type.thrust_to_weight >= 1.6 && check_airframe(vehicle.airframe) == pinnquad::Status::ok) return vehicle;
  }
}

/// The start: the archetype, of which each number is wrong by up to 40 %.
inline pinnquad::Airframe<double> archetype_start(std::size_t number) {
  return airframe_of(archetypes[number % archetypes.size()]);
}

/// The start from weighed mass and propeller diameter alone, as of `pinnquad airframe estimate`: arms of 1.09
/// diameters, thrust 2.5 of the weight, a lag that grows with the propeller.
inline pinnquad::Airframe<double> start_by_laws(const pinnquad::Airframe<double>& truth) {
  constexpr double kg_per_g = 1e-3, m_per_inch = 0.0254, thrust_to_weight = 2.5;
  const double diameter_m = truth.propeller_diameter_m;
  KnownOfAirframe known;
  known.mass_kg = truth.mass_kg;
  known.arm_m = 0.77 * std::sqrt(2.0) * diameter_m;
  known.propeller_in = diameter_m / m_per_inch;
  known.thrust_g = thrust_to_weight * truth.mass_kg / kg_per_g / pinnquad::rotor_count;
  pinnquad::Airframe<double> start = estimated_airframe(known).value;
  for (auto& rotor : start.rotors) rotor.thrust_curve = 0.4;
  start.rotor_time_constant_s = 0.02 + 0.1 * diameter_m;
  const double area_m2 = 0.6 * diameter_m * diameter_m;
  start.drag_area_m2 = {area_m2, area_m2, 1.5 * area_m2};
  return start;
}

}  // namespace programs
