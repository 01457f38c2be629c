// SPDX-License-Identifier: MIT
// Data of a flight's pictures that its CSV does not hold: places, and the aerodynamic forces taken apart.
#pragma once

#include <cmath>

#include "pinnquad/simulation/simulator.hpp"

namespace programs {

/// One row of a flight. Forces in N, body FRD.
struct TraceRow {
  double time_s = 0;
  pinnquad::Vector3<double> position_m = pinnquad::Vector3<double>::Zero();  ///< NED
  double speed_m_s = 0;
  double height_m = 0;                                                   ///< above ground
  pinnquad::Vector3<double> drag_N = pinnquad::Vector3<double>::Zero();  ///< as in still air
  pinnquad::Vector3<double> wind_N = pinnquad::Vector3<double>::Zero();  ///< what the wind adds
  double wind_m_s = 0;                                                   ///< towards north
  double ground_effect_N = 0;                                            ///< up along the body's axis
  double thrust_ratio = 1;  ///< lift in over lift out of ground effect, world vertical
};

namespace detail {
struct TraceForces {
  pinnquad::Vector3<double> rotors, all, still;  ///< of the rotors; all effects; all effects without the wind
};
}  // namespace detail

/// The forces on a vehicle in a true state. `without` is the same vehicle without ground effect.
template <class Vehicle>
TraceRow trace_row(const Vehicle& vehicle, const Vehicle& without, const pinnquad::VehicleState<double>& state) {
  using namespace pinnquad;
  const State<double>& body = state.body;
  const auto forces = [&](const Vehicle& quadrotor) {
    const auto e = quadrotor.evaluate(state);
    Surroundings<double> still = e.surroundings;
    still.wind_m_s = Vector3<double>::Zero();
    return detail::TraceForces{
        e.rotors.force_N, e.aerodynamic.force_N,
        quadrotor.aerodynamic_wrench(body, still, quadrotor.rotors().fractions(clipped(state.rotors))).force_N};
  };
  const auto with = forces(vehicle), out_of = forces(without);
  TraceRow row;
  row.time_s = state.time_s;
  row.position_m = body.position_m;
  row.speed_m_s = body.velocity_m_s.norm();
  row.height_m = vehicle.site().ground_z_m - body.position_m[2];
  row.wind_m_s = vehicle.surroundings(state).wind_m_s[0];
  row.drag_N = out_of.still;
  row.wind_N = out_of.all - out_of.still;
  row.ground_effect_N = out_of.all[2] - with.all[2];
  const double lift_N = std::abs(body_to_world<double>(body.attitude, out_of.rotors + out_of.all)[2]);
  if (lift_N > 0) row.thrust_ratio = 1 + row.ground_effect_N / lift_N;
  return row;
}

}  // namespace programs
