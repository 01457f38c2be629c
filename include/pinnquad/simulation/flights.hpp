// SPDX-License-Identifier: MIT
// The paper's three flights (Sec. 5.2) as types: which effects act, who flies, for how long.
// Contract of a flight: `name`, `summary`, `Vehicle` and `SwitchableVehicle` (the same effects, and a ground effect that a
// program may choose), `ground_effect` (of the flight as the paper has it), `plan()` and
// `pilot(vehicle, engine, max_speed_m_s)`.
#pragma once

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/simulation/fly.hpp"
#include "pinnquad/simulation/near_ground_pilot.hpp"
#include "pinnquad/simulation/random_pilot.hpp"
#include "pinnquad/simulation/switchable_quadrotor.hpp"

namespace pinnquad {

/// The agile pilot, fitted to a vehicle at the place where a flight starts (pilot_style).
template <class AnyVehicle, class Engine>
RandomPilot<Engine> agile_pilot(const AnyVehicle& vehicle, const Engine& engine, const Vector3<double>& start_m,
                                double max_speed_m_s) {
  return with_quadrotor(vehicle, [&](const auto& quadrotor) {
    return RandomPilot<Engine>(engine, pilot_style(quadrotor, start_m, max_speed_m_s), quadrotor.site().ground_z_m);
  });
}

/// D1: agile manoeuvres up to 8 m/s in all directions, drag and the standard atmosphere; 15,000 rows at 0.05 s.
struct AgileFlight {
  static constexpr const char* name = "d1";
  static constexpr const char* summary = "agile, up to 8 m/s, with drag";
  using Vehicle = Quadrotor<double, StandardAtmosphere, QuadraticDrag>;
  using SwitchableVehicle = SwitchableQuadrotor<StandardAtmosphere, QuadraticDrag>;
  static constexpr GroundEffectModel ground_effect = GroundEffectModel::none;

  static FlightPlan plan() { return {}; }

  template <class AnyVehicle, class Engine>
  static RandomPilot<Engine> pilot(const AnyVehicle& vehicle, const Engine& engine,
                                   double max_speed_m_s = PilotStyle{}.max_speed_m_s) {
    return agile_pilot(vehicle, engine, plan().start_m, max_speed_m_s);
  }
};

/// D2: take-offs, hovers, low traverses and landings with the centre 0.1 to 2 m above ground, drag and ground effect
/// (Conyers); 6,000 rows at 0.05 s. There is no contact with the ground: a landed vehicle hovers on its last centimetres.
struct NearGroundFlight {
  static constexpr const char* name = "d2";
  static constexpr const char* summary = "near the ground, 0.1 to 2 m, with drag and ground effect";
  using Vehicle = Quadrotor<double, StandardAtmosphere, QuadraticDrag, ConyersGroundEffect>;
  using SwitchableVehicle = SwitchableQuadrotor<StandardAtmosphere, QuadraticDrag>;
  static constexpr GroundEffectModel ground_effect = GroundEffectModel::conyers;

  static FlightPlan plan() {
    constexpr double start_height_m = 0.2;
    FlightPlan plan;
    plan.samples = 6000;
    plan.start_m = Vector3<double>(0, 0, paper_site<double>().ground_z_m - start_height_m);
    return plan;
  }

  template <class AnyVehicle, class Engine>
  static NearGroundPilot<Engine> pilot(const AnyVehicle& vehicle, const Engine& engine,
                                       double max_speed_m_s = NearGroundStyle{}.max_speed_m_s) {
    return with_quadrotor(vehicle, [&](const auto& quadrotor) {
      return NearGroundPilot<Engine>(engine, near_ground_style(quadrotor, plan().start_m, max_speed_m_s),
                                     quadrotor.site().ground_z_m);
    });
  }
};

/// D3: agile manoeuvres in a periodic wind, 2.5 sin(pi t / 5) + 2.5 m/s towards north, with drag; 5,000 rows at 0.05 s.
/// Speeds are over ground.
struct WindyFlight {
  static constexpr const char* name = "d3";
  static constexpr const char* summary = "agile, up to 8 m/s, with drag and periodic wind";
  using Vehicle = Quadrotor<double, StandardAtmosphere, PeriodicWind, QuadraticDrag>;
  using SwitchableVehicle = SwitchableQuadrotor<StandardAtmosphere, PeriodicWind, QuadraticDrag>;
  static constexpr GroundEffectModel ground_effect = GroundEffectModel::none;

  static FlightPlan plan() {
    FlightPlan plan;
    plan.samples = 5000;
    return plan;
  }

  template <class AnyVehicle, class Engine>
  static RandomPilot<Engine> pilot(const AnyVehicle& vehicle, const Engine& engine,
                                   double max_speed_m_s = PilotStyle{}.max_speed_m_s) {
    return agile_pilot(vehicle, engine, plan().start_m, max_speed_m_s);
  }
};

/// A flight's vehicle at the paper's site, with the effects as the paper has them.
template <class PaperFlight>
typename PaperFlight::Vehicle flight_vehicle(const Airframe<double>& airframe) {
  return typename PaperFlight::Vehicle(airframe, paper_site<double>());
}

/// The same with a ground effect of one's choice.
template <class PaperFlight>
typename PaperFlight::SwitchableVehicle flight_vehicle(const Airframe<double>& airframe, GroundEffectModel model) {
  typename PaperFlight::SwitchableVehicle vehicle(airframe, paper_site<double>());
  vehicle.set_ground_effect(model);
  return vehicle;
}

/// One of the paper's flights, flown by its own pilot; `engine` is the pilot's.
template <class PaperFlight, class Engine>
RecordedFlight fly(const Airframe<double>& airframe, const Engine& engine) {
  const typename PaperFlight::Vehicle vehicle = flight_vehicle<PaperFlight>(airframe);
  return fly(vehicle, PaperFlight::pilot(vehicle, engine), PaperFlight::plan());
}

}  // namespace pinnquad
