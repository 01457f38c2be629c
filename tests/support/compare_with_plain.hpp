// SPDX-License-Identifier: MIT
// The library's dynamics in the words of the simulator's rows, so that they can be compared.
#pragma once

#include <array>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/vehicle/inverse.hpp"
#include "support/plain_dynamics.hpp"
#include "support/simulator_ground_effect.hpp"
#include "support/tolerances.hpp"

namespace pinnquad::test {

template <class Scalar>
State<Scalar> state_of(const plain::Point& p) {
  State<Scalar> state;
  state.position_m[2] = Scalar(p.pz);
  state.velocity_m_s = {Scalar(p.vx), Scalar(p.vy), Scalar(p.vz)};
  state.attitude = {Scalar(p.qw), Scalar(p.qx), Scalar(p.qy), Scalar(p.qz)};
  state.body_rates_rad_s = {Scalar(p.wx), Scalar(p.wy), Scalar(p.wz)};
  return state;
}

template <class Scalar>
Commands<Scalar> commands_of(const plain::Point& p) {
  return {Scalar(p.u1), Scalar(p.u2), Scalar(p.u3), Scalar(p.u4)};
}

/// The simulator's vehicle with one ground effect: density over altitude, a constant wind, drag.
template <class Scalar, class... Ground>
Quadrotor<Scalar, StandardAtmosphere, ConstantWind, QuadraticDrag, Ground...> reference_vehicle(
    const Airframe<Scalar>& airframe, const plain::Point& p) {
  return Quadrotor<Scalar, StandardAtmosphere, ConstantWind, QuadraticDrag, Ground...>(
      airframe, paper_site<Scalar>(), StandardAtmosphere{}, ConstantWind{{p.wind_x, p.wind_y, p.wind_z}},
      QuadraticDrag{}, Ground{}...);
}

template <class Scalar>
void assign(double (&out)[3], const Vector3<Scalar>& v) {
  for (int i = 0; i < 3; ++i) out[i] = static_cast<double>(v[i]);
}

template <class Scalar, class... Ground>
plain::Result evaluate_with(const Airframe<Scalar>& airframe, const plain::Point& p) {
  const auto vehicle = reference_vehicle<Scalar, Ground...>(airframe, p);
  const State<Scalar> state = state_of<Scalar>(p);
  const auto e = vehicle.evaluate(state, commands_of<Scalar>(p), Scalar(0));
  // drag alone: the same vehicle without ground effect
  const Wrench<Scalar> drag =
      reference_vehicle<Scalar>(airframe, p).aerodynamic_wrench(state, e.surroundings, ThrustFractions<Scalar>{});
  plain::Result out{};
  out.rho = static_cast<double>(e.surroundings.air_density_kg_m3);
  assign<Scalar>(out.rotor_force, body_to_world<Scalar>(state.attitude, e.rotors.force_N));
  assign<Scalar>(out.rotor_torque, e.rotors.torque_N_m);
  assign<Scalar>(out.drag_force, body_to_world<Scalar>(state.attitude, drag.force_N));
  assign<Scalar>(out.ground_force, body_to_world<Scalar>(state.attitude, e.aerodynamic.force_N - drag.force_N));
  assign<Scalar>(out.acceleration, world_acceleration<Scalar>(state, e.motion.linear_m_s2));
  assign<Scalar>(out.body_derivative, e.motion.linear_m_s2);
  assign<Scalar>(out.angular, e.motion.angular_rad_s2);
  return out;
}

/// The library at a point.
template <class Scalar>
plain::Result evaluate(const Airframe<Scalar>& airframe, const plain::Point& p) {
  switch (p.ground_effect) {
    case plain::GroundEffect::cheeseman_bennett: return evaluate_with<Scalar, SimulatorGroundEffect>(airframe, p);
    case plain::GroundEffect::conyers: return evaluate_with<Scalar, GroundEffect<Conyers>>(airframe, p);
    case plain::GroundEffect::none: break;
  }
  return evaluate_with<Scalar>(airframe, p);
}

/// |difference| / |reference| per vector; ground effect relative to the rotor force (it may be zero), as is drag below
/// 1 mN.
struct Differences {
  double density, rotor_force, rotor_torque, drag_force, ground_force, acceleration, body_derivative, angular;
};

inline Differences differences(const plain::Result& value, const plain::Result& reference) {
  const auto array = [](const double(&v)[3]) { return std::array<double, 3>{v[0], v[1], v[2]}; };
  const auto relative = [&](const double(&a)[3], const double(&b)[3], double floor = 0.0) {
    return relative_distance(array(a), array(b), floor);
  };
  const double thrust = norm(array(reference.rotor_force));
  return {std::fabs(value.rho - reference.rho) / reference.rho,
          relative(value.rotor_force, reference.rotor_force),
          relative(value.rotor_torque, reference.rotor_torque),
          relative(value.drag_force, reference.drag_force, 1e-3),
          distance(array(value.ground_force), array(reference.ground_force)) / thrust,
          relative(value.acceleration, reference.acceleration),
          relative(value.body_derivative, reference.body_derivative),
          relative(value.angular, reference.angular)};
}

}  // namespace pinnquad::test
