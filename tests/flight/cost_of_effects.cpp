// SPDX-License-Identifier: MIT
// Compiled, never run: count_instructions.cmake compiles one CASE at a time and counts. An effect that is not named
// must cost nothing.
#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

using namespace pinnquad;

#if defined(EQUATIONS_ALONE)
/// Eqs. (1) and (2), written without the vehicle and its effects; the same result, so that the same is stored.
Quadrotor<double>::Evaluation evaluation_of(const Airframe<double>& airframe, const Rotors<double>& rotors,
                                            const Site<double>& site, const State<double>& state,
                                            const Commands<double>& commands) {
  Quadrotor<double>::Evaluation result;
  result.surroundings.position_m = state.position_m;
  result.surroundings.altitude_m = site.elevation_m - state.position_m[2];
  result.rotors = rotors.wrench(clipped(commands), 1.0);
  result.motion = accelerations(airframe, state, result.rotors, site.gravity_m_s2);
  return result;
}
#else
#if defined(WITHOUT_EFFECTS)
using Vehicle = Quadrotor<double>;
#elif defined(WITH_DRAG)
using Vehicle = Quadrotor<double, QuadraticDrag>;
#elif defined(WITH_DRAG_AND_DENSITY)
using Vehicle = Quadrotor<double, StandardAtmosphere, QuadraticDrag>;
#endif
Vehicle::Evaluation evaluation_of(const Vehicle& vehicle, const State<double>& state,
                                  const Commands<double>& commands) {
  return vehicle.evaluate(state, commands, 0.0);
}
#endif
