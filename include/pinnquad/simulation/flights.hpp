// SPDX-License-Identifier: MIT
// The paper's three flights (Sec. 5.2) and a harder one as types: effects, pilot, duration. The pilots' styles are
// fitted to what a vehicle can do at a place, found through its own inverse. Contract of a flight: `name`, `summary`,
// `Vehicle`, `ground_effect` (the paper's), `plan()` and `pilot(vehicle, engine, max_speed_m_s)`.
#pragma once

#include <limits>
#include <optional>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/flapping.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/inflow.hpp"
#include "pinnquad/aero/wake.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/simulation/near_ground_pilot.hpp"
#include "pinnquad/simulation/random_pilot.hpp"
#include "pinnquad/simulation/simulator.hpp"
#include "pinnquad/simulation/switched_quadrotor.hpp"

namespace pinnquad {

namespace detail {
/// Thrust fraction of the rotor that gives most; of rotors that differ by rounding, the first one's.
inline double largest_fraction(const Rotors<double>& rotors, const Commands<double>& commands) noexcept {
  constexpr double rounding = 1e-9;
  const ThrustFractions<double> fractions = rotors.fractions(commands);
  double largest = fractions[0];
  for (const double fraction : fractions) {
    if (fraction > largest * (1 + rounding)) largest = fraction;
  }
  return largest;
}
}  // namespace detail

/// Share of its thrust that the rotor with most to do gives in hover at a place; NaN if the inverse gives no answer.
/// Above the share that the controller asks for at most (0.97, flight_limits) the airframe cannot stay up.
template <class... Effects>
double hover_command(const Quadrotor<double, Effects...>& quadrotor, const Vector3<double>& place_m) {
  Commands<double> hover{};
  const Status status = hover_trim(quadrotor, place_m, hover);
  return status == Status::ok ? detail::largest_fraction(quadrotor.rotors(), hover)
                              : std::numeric_limits<double>::quiet_NaN();
}

/// The default style, fitted to what the vehicle can do at a place, drag included. No climb takes more than 60 % of the
/// thrust above hover, no descent less than 35 % of the hover's; none is faster than 1.5 times the climb. Turns, sticks
/// and changes of velocity are calmed in proportion where hover leaves less than 35 % of the command.
template <class... Effects>
PilotStyle pilot_style(const Quadrotor<double, Effects...>& quadrotor, const Vector3<double>& place_m,
                       double max_speed_m_s = PilotStyle{}.max_speed_m_s) {
  constexpr double climb_share = 0.6, descent_share = 0.35, fall_per_climb = 1.5, calm_reserve = 0.35;
  constexpr int speeds = 80;
  PilotStyle style;
  style.max_speed_m_s = style.max_climb_m_s = style.max_descent_m_s = max_speed_m_s;
  Commands<double> hover{};
  if (hover_trim(quadrotor, place_m, hover) != Status::ok) return style;
  const double hover_command = detail::largest_fraction(quadrotor.rotors(), hover);
  const auto command_at = [&](double down_m_s) {
    State<double> state;
    state.position_m = place_m;
    state.velocity_m_s[2] = down_m_s;
    Commands<double> commands = hover;
    const Status status = inverse_commands(quadrotor, state, Accelerations<double>{}, 0.0, commands);
    return status == Status::ok ? detail::largest_fraction(quadrotor.rotors(), commands) : hover_command;
  };
  const double step_m_s = style.max_speed_m_s / speeds;
  const double most = hover_command + climb_share * (1 - hover_command);
  const double least = descent_share * hover_command;
  while (style.max_climb_m_s > step_m_s && command_at(-style.max_climb_m_s) > most) style.max_climb_m_s -= step_m_s;
  while (style.max_descent_m_s > step_m_s && command_at(style.max_descent_m_s) < least) {
    style.max_descent_m_s -= step_m_s;
  }
  const double most_descent_m_s = fall_per_climb * style.max_climb_m_s;  // a fall must be caught again
  if (style.max_descent_m_s > most_descent_m_s) style.max_descent_m_s = most_descent_m_s;
  const double calm = (1 - hover_command) / calm_reserve;
  if (calm < 1) {
    style.max_yaw_rate_rad_s *= calm;
    style.thumbs.yaw_deviation_rad_s *= calm;
    style.thumbs.roll_pitch_deviation_rad_s *= calm;
    style.velocity_lag_s /= calm;
  }
  return style;
}

/// The near-ground style, fitted to what the vehicle can do: no climb or descent, no stick and no turn beyond those of
/// pilot_style, traverses calmed as its changes of velocity are, heights changed with a third of the acceleration that
/// the thrust above hover gives.
template <class... Effects>
NearGroundStyle near_ground_style(const Quadrotor<double, Effects...>& quadrotor, const Vector3<double>& place_m,
                                  double max_speed_m_s = NearGroundStyle{}.max_speed_m_s) {
  const auto lower = [](double& value, double limit) {
    if (limit < value) value = limit;
  };
  const PilotStyle agile = pilot_style(quadrotor, place_m);
  NearGroundStyle style;
  lower(style.max_speed_m_s, max_speed_m_s);
  lower(style.hover_speed_m_s, max_speed_m_s);
  lower(style.max_climb_m_s, agile.max_climb_m_s);
  lower(style.max_descent_m_s, agile.max_descent_m_s);
  lower(style.max_yaw_rate_rad_s, agile.max_yaw_rate_rad_s);
  lower(style.thumbs.roll_pitch_deviation_rad_s, agile.thumbs.roll_pitch_deviation_rad_s);
  lower(style.thumbs.yaw_deviation_rad_s, agile.thumbs.yaw_deviation_rad_s);
  constexpr double reserve_share = 1.0 / 3;
  const double hover = hover_command(quadrotor, place_m);
  lower(style.max_vertical_acceleration_m_s2, reserve_share * (1 / hover - 1) * quadrotor.site().gravity_m_s2);
  style.velocity_lag_s *= agile.velocity_lag_s / PilotStyle{}.velocity_lag_s;
  return style;
}

/// D1: agile manoeuvres up to 8 m/s in all directions, drag and the standard atmosphere; 15,000 rows at 0.05 s.
struct AgileFlight {
  static constexpr const char* name = "d1";
  static constexpr const char* summary = "agile, up to 8 m/s, with drag";
  using Vehicle = Quadrotor<double, StandardAtmosphere, QuadraticDrag>;
  static constexpr GroundEffectModel ground_effect = GroundEffectModel::none;

  static FlightPlan plan() { return {}; }

  /// Fitted to the vehicle at the place where the flight starts (pilot_style).
  template <class AnyVehicle, class Engine>
  static RandomPilot<Engine> pilot(const AnyVehicle& vehicle, const Engine& engine,
                                   double max_speed_m_s = PilotStyle{}.max_speed_m_s) {
    return RandomPilot<Engine>(engine, pilot_style(vehicle, plan().start_m, max_speed_m_s), vehicle.site().ground_z_m);
  }
};

/// D2: take-offs, hovers, low traverses and landings with the centre 0.1 to 2 m above ground, drag and ground effect
/// (Conyers); 6,000 rows at 0.05 s. There is no contact with the ground: a landed vehicle hovers on its last
/// centimetres.
struct NearGroundFlight {
  static constexpr const char* name = "d2";
  static constexpr const char* summary = "near the ground, 0.1 to 2 m, with drag and ground effect";
  using Vehicle = Quadrotor<double, StandardAtmosphere, QuadraticDrag, GroundEffect<Conyers>>;
  static constexpr GroundEffectModel ground_effect = GroundEffectModel::conyers;

  /// Conyers' where his fit holds for the airframe, else Cheeseman and Bennett's, which hold for every one.
  static GroundEffectModel ground_effect_of(const Airframe<double>& airframe) noexcept {
    const bool holds = Conyers{}.status(airframe) == Status::ok;
    return holds ? GroundEffectModel::conyers : GroundEffectModel::cheeseman_bennett;
  }

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
    return NearGroundPilot<Engine>(engine, near_ground_style(vehicle, plan().start_m, max_speed_m_s),
                                   vehicle.site().ground_z_m);
  }
};

/// D3: start, pilot and drag of D1 in a periodic wind, 2.5 sin(pi t / 5) + 2.5 m/s towards north; 5,000 rows at 0.05 s.
/// Speeds are over ground.
struct WindyFlight : AgileFlight {
  static constexpr const char* name = "d3";
  static constexpr const char* summary = "agile, up to 8 m/s, with drag and periodic wind";
  using Vehicle = Quadrotor<double, StandardAtmosphere, PeriodicWind, QuadraticDrag>;

  static FlightPlan plan() {
    FlightPlan plan = AgileFlight::plan();
    plan.samples = 5000;
    return plan;
  }
};

/// D1's pilot on a vehicle whose rotors feel the air and each other (docs/simulator.md), in calm air; 15,000 rows at
/// 0.05 s. None of the paper's.
struct HarderFlight : AgileFlight {
  static constexpr const char* name = "harder";
  static constexpr const char* summary = "as d1, with drag, inflow, flapping and wake of the rotors (light_quadrotor)";
  using Vehicle = Quadrotor<double, StandardAtmosphere, QuadraticDrag, RotorDrag, Inflow, BladeFlapping, Wake>;
};

/// A flight's vehicle at the paper's site, with the effects as the paper has them.
template <class PaperFlight>
typename PaperFlight::Vehicle flight_vehicle(const Airframe<double>& airframe) {
  return typename PaperFlight::Vehicle(airframe, paper_site<double>());
}

/// The same with a ground effect of one's choice, and a battery where one is given, as one type for all flights.
template <class PaperFlight>
SwitchedQuadrotor flight_vehicle(const Airframe<double>& airframe, GroundEffectModel model,
                                 const std::optional<Battery>& battery = {}) {
  SwitchedEffects effects = switched_effects<typename PaperFlight::Vehicle>();
  set_ground_effect(effects, model);
  if (battery) switch_effect(effects, *battery);
  return quadrotor_with(effects, airframe, paper_site<double>());
}

/// One of the paper's flights, flown by its own pilot; `engine` is the pilot's.
template <class PaperFlight, class Engine>
RecordedFlight fly(const Airframe<double>& airframe, const Engine& engine) {
  const typename PaperFlight::Vehicle vehicle = flight_vehicle<PaperFlight>(airframe);
  return fly(vehicle, PaperFlight::pilot(vehicle, engine), PaperFlight::plan());
}

}  // namespace pinnquad
