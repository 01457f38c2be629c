// SPDX-License-Identifier: MIT
// A harder vehicle than the paper's: rotors that feel the air, gusts, a tired battery, a weak rotor, a payload, legs.
// Every number has its source here or in the effect's header (docs/simulator.md lists them).
#pragma once

#include <array>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/battery.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/dryden.hpp"
#include "pinnquad/aero/flapping.hpp"
#include "pinnquad/aero/ground_contact.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/inflow.hpp"
#include "pinnquad/aero/payload.hpp"
#include "pinnquad/aero/rotor_fault.hpp"
#include "pinnquad/aero/wake.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/dynamics/airframes/light_quadrotor.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace pinnquad {

/// In the order of the contract: the air first, then forces, the payload last, as it scales those before it.
using HarderQuadrotor =
    Quadrotor<double, StandardAtmosphere, ConstantWind, DrydenTurbulence<>, Battery, QuadraticDrag, RotorDrag, Inflow,
              BladeFlapping, Wake, RotorGroundEffect<CheesemanBennett>, RotorFault, GroundContact, Payload>;

/// The conditions of one flight; by default a breeze with its gusts, a full battery, nothing broken or picked
/// up.
struct HarderConditions {
  double wind_m_s{4};                         ///< mean, at the flight's height
  std::array<double, 2> direction{1.0, 0.0};  ///< where it blows to: NED, horizontal, unit length
  double gust_height_m{35};                   ///< above ground, for the gusts' length and strength: FlightPlan's start
  Battery battery{};
  RotorFault fault{};
  Payload payload{};
};

/// The harder vehicle at a site, its gusts drawn from the engine: the same engine state gives the same air. The gusts'
/// wind at 20 ft is taken as the mean wind.
template <class Engine>
HarderQuadrotor harder_vehicle(Engine& engine, const HarderConditions& conditions = {},
                               const Airframe<double>& airframe = airframe_value<LightQuadrotor, double>(),
                               const Site<double>& site = paper_site<double>()) {
  const DrydenTurbulence<> gusts(engine, DrydenParameters::low_altitude(conditions.wind_m_s, conditions.gust_height_m),
                                 conditions.wind_m_s, conditions.direction);
  const ConstantWind wind{
      {conditions.wind_m_s * conditions.direction[0], conditions.wind_m_s * conditions.direction[1], 0.0}};
  return HarderQuadrotor(airframe, site, {}, wind, gusts, conditions.battery, {}, {}, {}, {}, {}, {}, conditions.fault,
                         {}, conditions.payload);
}

}  // namespace pinnquad
